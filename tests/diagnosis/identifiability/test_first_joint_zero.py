"""On a wall, a base tilted about the first joint and an offset of its encoder are one; on a floor they are not."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.conftest import Plant
from tests.diagnosis.posed import pose

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.identifiability.first_joint_zero import TILT, ZERO, tie_tilt_and_first_zero
from lagnet.diagnosis.identifiability.rivals import Comparison
from lagnet.rigid_body.random_arm import random_arm

ARM = random_arm(3, seed=12, kinds=("revolute",), fixed=False)
AXIS = ARM.joint_axes(np.zeros(3))[0]
ANGLE = 0.05  # [rad]


def level(axis: np.ndarray) -> np.ndarray:
    """A direction at right angles to an axis."""
    across = np.cross(axis, [1.0, 0.0, 0.0] if abs(axis[0]) < 0.9 else [0.0, 1.0, 0.0])
    return across / np.linalg.norm(across)


def turned(axis: np.ndarray, gravity: np.ndarray, angle: float) -> np.ndarray:
    """Gravity as an arm sees it that is turned about an axis at right angles to it."""
    return np.cos(angle) * gravity - np.sin(angle) * np.cross(axis, gravity)


def tied(nominal, real) -> tuple[str, ...]:
    """What a tilt is tied with on recordings of an arm."""
    plant = Plant(real)
    posed = pose(nominal, plant.record(1), plant.record(2))
    candidate = posed.candidate(posed.select({}, [TILT]))
    found = Comparison(posed.index(TILT, None), (), ())
    return tie_tilt_and_first_zero(posed.problem, posed.library, [found], candidate.effects)[0].tied


@pytest.mark.parametrize(("about_the_joint", "expected"), [(True, (ZERO,)), (False, ())])
def test_on_a_wall_a_tilt_about_the_first_joint_is_tied_with_its_zero(about_the_joint, expected) -> None:
    down = 9.81 * level(AXIS)
    axis = AXIS if about_the_joint else np.cross(AXIS, down) / 9.81
    assert tied(ARM.with_gravity(down), ARM.with_gravity(turned(axis, down, ANGLE))) == expected


def test_an_upright_first_joint_has_no_tilt_for_its_zero() -> None:
    down = -9.81 * AXIS
    assert tied(ARM.with_gravity(down), ARM.with_gravity(turned(level(AXIS), down, ANGLE))) == ()


def test_an_encoder_offset_on_a_wall_is_told_alone_or_tied_with_a_tilt() -> None:
    arm = ARM.with_gravity(9.81 * level(AXIS))

    def elsewhere(q, v, a, body):
        return arm.inverse_dynamics(q - ANGLE * (np.arange(3) == 0), v, a) - body

    plant = Plant(arm, [elsewhere])
    names = [
        {e.effect, *e.tied_with} for e in diagnose([plant.record(1), plant.record(3)], arm, [plant.record(2)]).effects
    ]
    assert len(names) == 1
    assert ZERO in names[0]
