"""A run on a shifted clock: a shift that all joints share says how a log was made, not what an arm lacks.

A torque that is held between samples acts, on average, half a sample later than its stamp, and a log may stamp the
torque of one control cycle beside the motion of the next. A shift that other joints deny stays what it is: a delay.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from lagnet.diagnosis.state import DiagnosisState
from lagnet.effects.catalogue import effect_named

HELD = 0.6  # of a sample: delays up to this may come from torques that are held, or stamped half a cycle off
ALIKE = 0.25  # of the shift by which delays of single joints may differ from it


def on_one_clock(first: DiagnosisState, shifted: Callable[[float], DiagnosisState]) -> DiagnosisState:
    """The first run, or the one with torques read at shifted times where all joints share a shift within a sample.

    Args:
        shifted: a run on the same recordings, torques read that much later [s].
    """
    delays = _delays(first)
    small = [t for t in delays.values() if abs(t) <= HELD / first.fit.rate]
    if not small:
        return first
    shift = float(np.median(small))
    if any(abs(t - shift) > ALIKE * abs(shift) for t in small):
        return first
    second = shifted(shift)
    others = [j for j in range(first.problem.n_dof) if j not in delays]
    saved = len(delays) - len(_delays(second))  # one shift in the place of many delays is worth what each of them cost
    asked = first.problem.limits.complexity_penalty * (2 - saved)
    return second if not others or _clock_gain(first, second, others) > asked else first


def _delays(state: DiagnosisState) -> dict[int, float]:
    """Delay of each joint that has one by name [s]."""
    found = (e for e in state.effects if effect_named(e.effect).is_delay)
    return {e.joint: e.values["T"] for e in found if e.joint is not None}


def _clock_gain(first: DiagnosisState, second: DiagnosisState, joints: list[int]) -> float:
    """½ Σ_j n_j / g_j ln(E_first / E_second) [nats] on held-out motion, over joints without a delay."""
    samples = first.holdout_equations.samples / first.selection.scales.inefficiency
    before, after = (
        np.maximum([left.power for left in one.sizes], np.maximum(first.noise, 1e-12) ** 2 / 4)
        for one in (first, second)
    )
    return float(0.5 * np.sum((samples * np.log(before / after))[joints]))
