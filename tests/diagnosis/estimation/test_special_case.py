"""A coupled motor of another ratio than plus or minus one stands only where these leave noticeably more."""

from __future__ import annotations

import pytest
from tests.diagnosis.estimation.rubbing import DRY, JOINT, NAME, rubbing
from tests.diagnosis.posed import pose

from lagnet.diagnosis.estimation.refit import refit
from lagnet.diagnosis.estimation.special_case import with_special_cases
from lagnet.models.corrected.named_effects import NamedEffect

NEAR = 0.03  # of ratio and friction: their sign turns over another width of speed than the plant's
START = {"Fv": 0.1, "Fc": 3.0, "Ia": 0.0}


@pytest.fixture(scope="module")
def fitted(plant, arm):
    """The problem of a motor of one ratio, and its refit from another with all values free."""

    def make(truth: float, start: float):
        real = plant(rubbing(truth))
        posed = pose(arm, real.record(71), real.record(72))
        effect = NamedEffect(NAME, JOINT, START | {"ratio": start})
        return posed, refit(posed.problem, [effect], posed.noise, choices_stay=False)

    return make


@pytest.mark.parametrize(("truth", "start"), [(2.2, 2.0), (-0.6, -0.7), (1.2, 1.0), (-0.9, -1.0)])
def test_a_ratio_that_explains_more_is_free_and_has_an_interval(fitted, truth: float, start: float) -> None:
    posed, free = fitted(truth, start)
    stands = with_special_cases(posed.problem, free, posed.noise)
    (effect,), (interval,) = stands.effects, stands.intervals
    assert (effect.values["ratio"], effect.values["Fc"]) == pytest.approx((truth, DRY), rel=NEAR)
    assert interval["ratio"][0] < effect.values["ratio"] < interval["ratio"][1]


@pytest.mark.parametrize("truth", [1.0, -1.0])
def test_a_ratio_of_one_is_a_choice_without_an_interval(fitted, truth: float) -> None:
    posed, free = fitted(truth, 1.1 * truth)
    assert free.effects[0].values["ratio"] != truth
    stands = with_special_cases(posed.problem, free, posed.noise)
    (effect,), (interval,) = stands.effects, stands.intervals
    assert (effect.values["ratio"], interval["ratio"]) == (truth, (truth, truth))
    assert effect.values["Fc"] == pytest.approx(DRY, rel=NEAR)
    assert with_special_cases(posed.problem, stands, posed.noise) is stands


def test_what_has_no_special_case_is_left_as_it_is(fitted) -> None:
    posed, _ = fitted(1.0, 1.1)
    plain = refit(posed.problem, [NamedEffect("viscous_friction", JOINT, {"Fv": 1.0})], posed.noise)
    assert with_special_cases(posed.problem, plain, posed.noise) is plain
