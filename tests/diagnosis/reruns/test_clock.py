"""A shift of the clock is paid for by the delays that it brings or saves."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from lagnet.diagnosis.reruns.clock import on_one_clock
from lagnet.diagnosis.settings import DecisionLimits
from lagnet.models.corrected.named_effects import NamedEffect


def judged(delays: dict[int, float], power: float) -> Any:
    """What the choice of a clock reads of a run: its delays, and the held-out errors of six joints."""
    return SimpleNamespace(
        effects=[NamedEffect("time_delay", joint, {"T": t}) for joint, t in delays.items()],
        fit=SimpleNamespace(rate=100.0),
        problem=SimpleNamespace(n_dof=6, limits=DecisionLimits()),
        holdout_equations=SimpleNamespace(samples=np.full(6, 500.0)),
        selection=SimpleNamespace(scales=SimpleNamespace(inefficiency=np.ones(6))),
        sizes=[SimpleNamespace(power=power)] * 6,
        noise=np.full(6, 0.1),
    )


GAINED = 0.992  # of the error, over five joints: 10 nats


def test_a_shift_that_brings_delays_is_charged_for_them() -> None:
    one = judged({5: -0.0054}, 1.0)
    freed, moved = judged({}, GAINED), judged(dict.fromkeys(range(5), 0.0054), GAINED)
    assert on_one_clock(one, lambda shift: freed) is freed
    assert on_one_clock(one, lambda shift: moved) is one


def test_a_shift_in_the_place_of_many_delays_needs_no_gain_of_the_rest() -> None:
    many = judged(dict.fromkeys(range(5), 0.0054), 1.0)
    assert on_one_clock(many, lambda shift: judged({}, 1.0)) is not many
