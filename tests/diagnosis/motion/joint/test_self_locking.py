"""K ≥ 1 per load is refuted where the load moved the joint against its motor, and nowhere else."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from lagnet.diagnosis.motion.joint.joint_case import JointCase
from lagnet.diagnosis.motion.joint.selection import refuted_by_load
from lagnet.diagnosis.motion.joint.self_locking import HOLDS, SELF_LOCKING, holds_every_load, moved_by_load
from lagnet.rollout.one_joint import JointSeries, Windows, roll_out
from lagnet.servos.command_delay import command_integral
from lagnet.servos.parameters import law_vector

LOAD = 1.0  # [N m] that has to be held
KP = 5.0


def _lowered(per_load: float) -> tuple[JointSeries, np.ndarray, np.ndarray]:
    """A weight on a drum, lowered by two commands that fall ever faster: series, speed and the mask of its motion."""
    time = np.arange(0.0, 4.0, 0.01)
    command = LOAD / KP - 0.3 * time**2
    ones, first = np.ones_like(time), np.zeros(1, dtype=int)
    integral = command_integral(time, command)
    given = (time, command, integral, 0.0 * ones, 0.01 * ones, LOAD * ones, 0.0 * ones, ones, ones, ones)
    law = law_vector(kp=KP, load_driving=per_load, load_driven=per_load, viscous=0.2)
    windows = Windows(first, first + len(time) - 1, first, np.zeros(1))
    q = roll_out(law, JointSeries(*given), windows)[0]
    series = JointSeries(*given[:3], q, *given[4:])
    speed = np.gradient(q, time)
    return series, speed, np.abs(speed) > 1e-3


@pytest.mark.parametrize(("per_load", "moved"), [(0.3, True), (0.7, True), (1.0, False), (1.4, False)])
def test_a_load_moves_what_does_not_hold_it_by_itself(per_load, moved):
    series, speed, moving = _lowered(per_load)
    assert moving.any()
    assert moved_by_load(series, speed, moving, law_vector(kp=KP)) == moved


def test_a_load_whose_side_is_not_sure_tells_nothing():
    series, speed, moving = _lowered(0.3)
    heavy = JointSeries(*(np.append(x, x[-1:]) for x in series.arrays()))
    heavy.load[-1] = 10.0 * LOAD
    law = law_vector(kp=KP)
    assert not moved_by_load(heavy, np.append(speed, 0.0), np.append(moving, False), law)


@pytest.mark.parametrize("effect", ["load_dependent_friction", "directional_load_friction"])
def test_friction_that_holds_every_load_is_rejected_where_the_load_moved_the_joint(effect):
    law = law_vector(load_driving=0.4, load_driven=1.2)
    case, other = (cast(JointCase, _case(moved)) for moved in (True, False))
    rejected = refuted_by_load(case, law, effect)
    assert rejected is not None
    assert (rejected.rule, rejected.value, rejected.limit) == (SELF_LOCKING, 1.2, HOLDS)
    assert refuted_by_load(other, law, effect) is None
    assert refuted_by_load(case, law_vector(load_driven=0.9), effect) is None
    assert refuted_by_load(case, law, "coulomb_friction") is None


def test_a_gear_holds_every_load_by_friction_per_load_alone():
    law = law_vector(load_driving=1.2, load_driven=1.2, coulomb=5.0)
    assert holds_every_load("load_dependent_friction", law)
    assert not holds_every_load("coulomb_friction", law)
    assert not holds_every_load("load_dependent_friction", law_vector(load_driving=0.9, load_driven=0.9))


def _case(moved: bool) -> Any:
    return SimpleNamespace(moved_by_load=moved)
