"""An arm that lacks several effects at once, and its physics."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.models.corrected.model import CorrectedModel, NamedEffect
from lagnet.rigid_body.random_arm import random_arm
from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics, arm_physics
from lagnet.simulators.round_trips.reference_cases import case_values

ARM = random_arm(3, seed=5, kinds=("revolute",), fixed=False)
LACKED = (
    ("viscous_friction", 0),
    ("coulomb_friction", 1),
    ("stribeck_friction", 2),
    ("rotor_inertia", 0),
    ("joint_spring", 2),
    ("payload", None),
    ("gravity_tilt", None),
    ("encoder_offset", 1),
    ("saturation", 1),
)


@pytest.fixture(scope="session")
def corrected() -> CorrectedModel:
    """Nine effects of the reference cases."""
    return CorrectedModel(ARM, tuple(NamedEffect(n, j, case_values(n)) for n, j in LACKED), np.full(3, 1e-3))


@pytest.fixture(scope="session")
def physics(corrected: CorrectedModel) -> ArmPhysics:
    """What they come to."""
    return arm_physics(corrected)
