"""The staircase asks only what does not follow from another answer, and curves find the limit that made them."""

from __future__ import annotations

import numpy as np
from validation.detection_limits.curves import limits
from validation.detection_limits.plants import Condition
from validation.detection_limits.staircase import CONDITIONS, MIDDLE, Trial, is_middle, next_size, try_plant

HALF, WIDTH, BY_NOISE = 0.012, 0.3, 1.0


def answers(seed: int, plants: int) -> list[Trial]:
    """Trials of an effect that is found at a size that grows with the noise, each plant with a limit of its own."""
    rng = np.random.default_rng(seed)
    trials: list[Trial] = []
    for number in range(plants):
        size = next_size([t for t in trials if is_middle(t)])
        own = rng.logistic(0.0, WIDTH)

        def found(c: Condition, size=size, own=own) -> bool:
            return bool(np.log(size / HALF) - BY_NOISE * np.log(c.noise / MIDDLE.noise) > own)

        trials += try_plant(found, number, size, shorter=True)
    return trials


def test_what_follows_from_the_middle_condition_is_not_asked() -> None:
    asked: list[Condition] = []

    def found(c: Condition) -> bool:
        asked.append(c)
        return c.noise < 0.015

    trials = try_plant(found, 0, 0.02, shorter=True)
    assert {(t.noise, t.duration): t.found for t in trials} == {(c.noise, c.duration): found(c) for c in CONDITIONS}
    assert sum(t.asked for t in trials) == 3


def test_sizes_are_halved_when_found_and_doubled_when_missed() -> None:
    def middle(*pairs: tuple[float, bool]) -> list[Trial]:
        return [Trial(n, MIDDLE.noise, MIDDLE.duration, size, hit) for n, (size, hit) in enumerate(pairs)]

    assert next_size(middle((0.02, True))) == 0.005
    assert next_size(middle((0.02, True), (0.005, False))) == 0.01
    assert next_size(middle((0.3, False))) == 0.4


def test_the_interval_holds_the_limit_about_as_often_as_it_says() -> None:
    inside = 0
    for seed in range(30):
        middle = limits(answers(seed, 8), [MIDDLE])[0]
        low, high = middle["half_between"]
        inside += low is None or low <= HALF <= high
    assert inside >= 24  # of 27 expected; fewer than 24 happen by chance once in forty


def test_many_plants_give_the_limit_and_its_growth_with_noise() -> None:
    by_noise = {(x["noise"], x["duration"]): x for x in limits(answers(1, 200), CONDITIONS)}
    quiet, middle, loud = (by_noise[noise, 20.0]["half"] for noise in (0.005, 0.01, 0.02))
    np.testing.assert_allclose(middle, HALF, rtol=0.2)
    np.testing.assert_allclose([quiet / middle, loud / middle], [0.5, 2.0], rtol=0.3)
    np.testing.assert_allclose(by_noise[0.01, 20.0]["most"], HALF * 19.0**WIDTH, rtol=0.4)


def test_an_effect_that_is_always_found_has_no_limit() -> None:
    trials = try_plant(lambda c: True, 0, 0.02, shorter=False)
    assert limits(trials, [MIDDLE])[0]["half"] is None
