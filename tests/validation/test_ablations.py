"""All that the study of ablations takes out is there, comes back, and matters on a plant made for it."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import fields, replace

import numpy as np
import pytest
from scipy.signal import lfilter
from tests.diagnosis.posed import pose
from validation.ablations.answers import without_limits
from validation.ablations.limit_table import LIMITS_OF_RULES, SHARED_LIMITS
from validation.ablations.patience import patience
from validation.ablations.remembered import Memory, remembered
from validation.ablations.table import ABLATIONS, WITHOUT_RULE, ablation_named, names_of
from validation.ablations.taken_out import import_all, taken_out, what_stands_at
from validation.ablations.watched import WATCHED, Effects, watched_places, watched_rules

from lagnet.diagnosis.diagnose import Diagnosis, diagnose
from lagnet.diagnosis.rules.apply import apply_rules
from lagnet.diagnosis.rules.catalogue import RULES
from lagnet.diagnosis.settings import DecisionLimits

pytestmark = pytest.mark.slow

PLACES = [(a.name, place) for a in ABLATIONS for place in a.instead]
SLUGGISH = 0.5  # [s] after which a disturbance has forgotten itself


def test_every_rule_of_the_catalogue_is_taken_out_by_leaving_it_out() -> None:
    assert names_of(WITHOUT_RULE) == tuple(r.name for r in RULES)
    for ablation in WITHOUT_RULE:
        assert ablation.rules == tuple(r for r in RULES if r.name != ablation.name)
        assert not ablation.instead
    assert ablation_named("nothing").rules == RULES
    assert ablation_named("all rules").rules == ()


@pytest.mark.parametrize(("rule", "place"), PLACES)
def test_every_place_is_there_and_holds_its_own_again_afterwards(rule: str, place: str) -> None:
    import_all()
    before = what_stands_at(place)
    with taken_out(ablation_named(rule).instead):
        assert what_stands_at(place) is not before
    assert what_stands_at(place) is before


def test_a_function_is_replaced_wherever_it_was_imported() -> None:
    import lagnet.diagnosis.diagnose as entrance
    import lagnet.diagnosis.reruns.band as band

    own = entrance.best_band
    with taken_out(ablation_named("narrower band").instead):
        assert entrance.best_band is band.best_band is not own
    assert entrance.best_band is own


def test_a_place_that_is_not_there_is_an_error() -> None:
    with pytest.raises(AttributeError), taken_out({"lagnet.diagnosis.reruns.band:no_such_step": lambda old: old}):
        pass


@pytest.fixture(scope="module")
def both(arm) -> Callable[..., tuple[Diagnosis, Diagnosis]]:
    """The diagnosis of two recordings with and without a rule or step."""
    known: dict[bytes, Diagnosis] = {}

    def diagnosed(rule: str, fit, held) -> tuple[Diagnosis, Diagnosis]:
        ablation, key = ablation_named(rule), fit.tau.tobytes() + held.tau.tobytes()
        if key not in known:
            known[key] = diagnose([fit], arm, [held])
        with taken_out(ablation.instead):
            return known[key], diagnose([fit], arm, [held], rules=ablation.rules)

    return diagnosed


def friction(v: np.ndarray) -> np.ndarray:
    return 0.2 * np.tanh(v / 0.02) + 0.07  # friction and an offset, or friction that differs by direction


def sluggish(recording, seed: int, size: float):
    """The recording with a disturbance that hangs together over time."""
    keep = math.exp(-0.01 / SLUGGISH)
    white = np.random.default_rng(seed).standard_normal(recording.tau.shape)
    slow = np.asarray(lfilter([math.sqrt(1 - keep**2)], [1, -keep], white, axis=0))
    return replace(recording, tau=recording.tau + size * slow)


def test_without_a_noise_floor_noise_is_a_mismatch(both, plant) -> None:
    whole, without = both("noise floor", plant().record(0), plant().record(1))
    assert not whole.verdict.found
    assert without.verdict.found


def test_without_lack_of_fit_a_law_of_the_wrong_form_keeps_its_name(both, plant, at, names) -> None:
    real = plant(at(1, lambda q, v, a, t: 0.4 * v * (1.0 + np.sin(3.0 * q))))
    whole, without = both("lack_of_fit", real.record(1), real.record(51))
    assert names(whole) < names(without)


def test_without_rivals_the_first_explanation_stays(both, plant, at, names) -> None:
    real = plant(at(1, lambda q, v, a, t: friction(v)))
    whole, without = both("rivals", real.record(0), real.record(1))
    assert {name for name, _ in names(whole)} == {"coulomb_friction", "torque_offset"}
    assert not names(without)
    assert [cause.effect for cause in without.state.ambiguous] == ["asymmetric_friction"]


def test_without_unseen_blocks_the_odds_are_others(both, plant, at) -> None:
    real = plant(at(1, lambda q, v, a, t: 0.14 * v))
    whole, without = both("unseen blocks", real.record(0), real.record(1))
    first, second = (d.effects[0].evidence.log10_odds_over_best_rival for d in (whole, without))
    assert first != pytest.approx(second, rel=1e-3)


def test_without_blocks_of_time_a_sluggish_disturbance_narrows_intervals(both, plant, at) -> None:
    real = plant(at(1, lambda q, v, a, t: 0.14 * v))
    fit, held = (sluggish(real.record(s), s + 7, 0.04) for s in (0, 50))
    whole, without = both("blocks of time", fit, held)
    wide, narrow = (np.ptp(d.effects[0].parameters[0].ci95) for d in (whole, without))
    assert narrow < 0.6 * wide


def test_without_ties_equal_names_stand_alone(both, plant, at) -> None:
    real = plant(at(1, lambda q, v, a, t: friction(v)))
    whole, without = both("ties", real.record(0), real.record(1))
    assert any(e.tied_with for e in whole.effects)
    assert without.effects
    assert not any(e.tied_with for e in without.effects)


def test_without_the_joint_refit_a_parameter_stays_on_the_grid(both, plant, at) -> None:
    def stribeck(v):
        return (0.14 + 0.14 * np.exp(-((v / 0.15) ** 2))) * np.tanh(v / 0.005)

    real = plant(at(1, lambda q, v, a, t: stribeck(v)))
    whole, without = both("joint refit", real.record(0), real.record(1))
    errors = [abs(d.effects[0].value("vs") - 0.15) for d in (whole, without)]
    assert errors[0] < 0.5 * errors[1]


def test_without_the_held_out_gain_what_does_not_help_stays(arm, plant, at) -> None:
    real = plant(at(1, lambda q, v, a, t: 0.4 * v))
    posed = pose(arm, real.record(0), plant().record(1))
    first = posed.candidate(posed.search())
    assert first.indices

    def left(rules) -> tuple[int, ...]:
        return apply_rules([r for r in rules if not r.after_refit], first).candidate.indices

    assert left(RULES) == ()
    assert left(ablation_named("no_holdout_gain").rules) == first.indices


def test_what_is_remembered_changes_no_word(arm, plant, at) -> None:
    real = plant(at(1, lambda q, v, a, t: 0.4 * v))
    fit, held = real.record(0), real.record(1)
    plain = diagnose([fit], arm, [held]).to_json()
    with remembered(Memory()):
        assert [diagnose([fit], arm, [held]).to_json() for _ in range(2)] == [plain, plain]
        other = diagnose([held], arm, [fit]).to_json()
    assert other == diagnose([held], arm, [fit]).to_json()


def test_what_is_remembered_hangs_on_no_limit(arm, plant, at) -> None:
    real = plant(at(1, lambda q, v, a, t: friction(v)))
    fit, held = real.record(0), real.record(1)
    limits = DecisionLimits(tie_odds=0.0, same_error=0.0)
    apart = diagnose([fit], arm, [held], limits=limits).to_json()
    with remembered(Memory()):
        assert diagnose([fit], arm, [held]).to_json() != apart
        assert diagnose([fit], arm, [held], limits=limits).to_json() == apart


def test_every_limit_is_halved_and_doubled() -> None:
    assert len(SHARED_LIMITS) == 2 * len(fields(DecisionLimits))
    for half, twice in zip(SHARED_LIMITS[::2], SHARED_LIMITS[1::2], strict=True):
        name = half.name.removesuffix(" at half")
        values = [getattr(x, name) for x in (half.limits, DecisionLimits(), twice.limits)]
        assert values == sorted(values)
        assert len(set(values)) == 3
    for ablation in LIMITS_OF_RULES:
        (changed,) = ablation.changed
        assert [r.name for r in ablation.rules] == [r.name for r in RULES]
        assert changed in ablation.rules
        assert changed not in RULES


def test_what_has_no_effect_is_told_from_what_has(arm, plant, at) -> None:
    real = plant(at(1, lambda q, v, a, t: 0.4 * v * (1.0 + np.sin(3.0 * q))))
    fit, held = real.record(1), real.record(51)
    watched, seen = (*ABLATIONS, *LIMITS_OF_RULES), Effects()
    with taken_out(watched_places(watched, seen)):
        whole = diagnose([fit], arm, [held], rules=watched_rules(RULES, watched, seen))
    assert whole.to_json() == diagnose([fit], arm, [held]).to_json()
    assert "lack_of_fit" in seen.rules
    idle = [a for a in (*WITHOUT_RULE, *LIMITS_OF_RULES) if not seen.of(a)]
    assert idle
    for ablation in idle[::6]:
        again = diagnose([fit], arm, [held], rules=ablation.rules).verdict.to_dict()
        assert without_limits(again) == without_limits(whole.verdict.to_dict())
    assert seen.of(ablation_named("lack_of_fit"))


def test_every_watched_place_is_one_of_a_step() -> None:
    assert {place for a in ABLATIONS for place in a.instead} >= WATCHED


def test_what_comes_to_no_end_is_ended() -> None:
    def busy(seconds: float) -> None:
        end = time.process_time() + seconds
        while time.process_time() < end:
            math.sqrt(2.0)

    with pytest.raises(TimeoutError, match="no end"), patience(0.05):
        busy(5.0)
    with patience(0.05):
        pass
    busy(0.2)  # the limit is gone with its context
