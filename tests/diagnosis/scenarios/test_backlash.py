"""A gap with springy flanks, off which the link bounces, is named; a joint without a gap is not said to have one."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from lagnet.diagnosis.diagnose import diagnose

RATE, FINER = 100.0, 40  # [Hz], steps of the plant in one sample
FLANK, DAMPING = 2.0 * np.pi * 80.0, 0.25  # [rad/s] of the link on a flank, share of the critical damping
SENSOR = 0.004  # [s] over which sensors average
HALF_GAP = 0.015  # [rad]
JOINT = 2


def bouncing(push: np.ndarray, half_gap: float) -> np.ndarray:
    """Angle in the gap, shape (n FINER,) [rad], for load over inertia (n,) [rad/s²]; flanks push and never hold."""
    fine = np.interp(np.arange(push.size * FINER) / FINER, np.arange(push.size), push)
    step = 1.0 / RATE / FINER
    x, w = half_gap * np.sign(fine[0]), 0.0
    out = np.empty(fine.size)
    for k, now in enumerate(fine):
        deep = abs(x) - half_gap
        side = 1.0 if x > 0 else -1.0
        flank = max(FLANK**2 * deep + 2.0 * DAMPING * FLANK * w * side, 0.0) if deep > 0 else 0.0
        w += step * (now - flank * side)
        x += step * w
        out[k] = x
    return out


def gap(robot, half_gap: float):
    """A law of the arm: the link of one joint trails its motor by where it is in the gap."""

    def law(q, v, a, body):
        push = body[:, JOINT] / robot.mass_matrix(q)[:, JOINT, JOINT]
        x = gaussian_filter1d(bouncing(push, half_gap), SENSOR * RATE * FINER)
        w = np.gradient(x, 1.0 / RATE / FINER)
        moved = [signal.copy() for signal in (q, v, a)]
        for signal, change in zip(moved, (x, w, np.gradient(w, 1.0 / RATE / FINER)), strict=True):
            signal[:, JOINT] -= change[::FINER]
        return robot.inverse_dynamics(*moved) - body

    return law


@pytest.mark.parametrize("seed", [1, 11])
def test_backlash_is_named_with_its_gap(plant, arm, names, seed: int) -> None:
    real = plant(gap(arm, HALF_GAP))
    result = diagnose([real.record(seed), real.record(seed + 1)], arm, [real.record(seed + 2)])
    assert names(result) == {("backlash", arm.joints[JOINT])}
    assert result.effects[0].value("h") == pytest.approx(HALF_GAP, rel=0.25)


def test_backlash_is_named_beside_friction(plant, arm, at, names) -> None:
    real = plant(gap(arm, HALF_GAP), at(JOINT, lambda q, v, a, t: 4.0 * v))
    result = diagnose([real.record(4), real.record(5)], arm, [real.record(6)])
    assert names(result) == {("backlash", arm.joints[JOINT]), ("viscous_friction", arm.joints[JOINT])}


@pytest.mark.parametrize(
    "law",
    [
        pytest.param(lambda q, v, a, t: 2.0 * np.tanh(v / 1e-3), id="friction"),
        pytest.param(lambda q, v, a, t: 3.0 * a, id="rotor"),
        pytest.param(lambda q, v, a, t: 0.0 * q, id="nothing"),
    ],
)
def test_no_gap_is_claimed_where_there_is_none(plant, arm, at, names, law) -> None:
    real = plant(at(JOINT, law))
    result = diagnose([real.record(7)], arm, [real.record(8)])
    assert "backlash" not in {name for name, _ in names(result)}
    assert not any("backlash" in effect.tied_with for effect in result.effects)
