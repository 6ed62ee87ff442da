"""The limit of a torque signal is read off the level where its largest values gather."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lagnet.effects.catalogue import CATALOGUE

JOINT, LIMIT = 1, 0.8  # of the largest torque
LAW = CATALOGUE["saturation"]


@pytest.fixture
def recorded(ur5, sweep):
    """A motion whose recorded torque stops at a limit, with noise and some samples that overshoot."""

    def of(seed: int, limit: float):
        motion, rng = sweep(ur5, seed).motion, np.random.default_rng(seed)
        most = limit * float(np.abs(motion.load[:, JOINT]).max())
        tau = motion.load.copy()
        tau[:, JOINT] = np.clip(tau[:, JOINT], -most, most) * (1.0 + 0.003 * rng.standard_normal(len(tau)))
        edges = np.flatnonzero(np.diff((np.abs(motion.load[:, JOINT]) > most).astype(int)))[:2]
        tau[edges, JOINT] *= 1.06
        return replace(motion, recorded=tau), most

    return of


@pytest.mark.parametrize("seed", range(4))
def test_the_limit_is_the_level_where_the_largest_torques_gather(recorded, seed: int) -> None:
    motion, most = recorded(seed, LIMIT)
    (shape,) = LAW.shapes(motion, JOINT)
    assert shape["tau_max"] == pytest.approx(most, rel=0.01)


def test_a_limit_above_what_the_motion_asks_for_is_none(recorded) -> None:
    motion, _ = recorded(1, 1.2)
    calmer = motion.with_load(0.7 * motion.load)
    assert LAW.shapes(calmer, JOINT) == ()


def test_a_recording_at_rest_has_no_limit(ur5, sweep) -> None:
    motion = sweep(ur5, 1).motion
    assert LAW.shapes(replace(motion, recorded=np.zeros_like(motion.load)), JOINT) == ()
