"""The forward motion of a corrected model against its own torques, and against an independent integrator."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from lagnet.effects.catalogue import CATALOGUE
from lagnet.models.corrected.model import CorrectedModel, NamedEffect
from lagnet.rigid_body.random_arm import random_arm
from lagnet.simulators.corrected_arm.arm_physics import ADDED, IN_BODIES, arm_physics
from lagnet.simulators.corrected_arm.drive import Drive
from lagnet.simulators.corrected_arm.forward_motion import ForwardMotion, dry_friction, joint_torque
from lagnet.simulators.round_trips.reference_cases import case_values

ARM = random_arm(3, seed=5, kinds=("revolute",), fixed=False)
SHARP = 1e-4  # [rad/s], blur of s(v) in the reference: far below the speeds at hand


MOTOR_SIDE = {"K": 0.2, "side": 1.0}


def corrected(*effects: tuple[str, int | None], slow: float = SHARP) -> CorrectedModel:
    named = tuple(NamedEffect(name, joint, case_values(name)) for name, joint in effects)
    return CorrectedModel(ARM, named, np.full(3, slow))


def test_every_effect_that_lasts_has_a_forward_law() -> None:
    lasting = {name for name, law in CATALOGUE.items() if not law.is_transient}
    assert lasting == set(ADDED) | set(IN_BODIES)


@pytest.mark.parametrize(
    "name",
    [n for n, law in CATALOGUE.items() if law.instantaneous and not law.is_transient and n != "saturation"],
)
def test_the_forward_law_gives_the_torque_of_the_catalogue(name: str) -> None:
    joint = None if CATALOGUE[name].whole_arm else 1
    gives_the_same_torque(corrected((name, joint)))


def test_the_forward_law_knows_friction_per_torque_of_the_motor() -> None:
    gives_the_same_torque(corrected().with_effects([NamedEffect("load_dependent_friction", 1, MOTOR_SIDE)]))


def gives_the_same_torque(model: CorrectedModel) -> None:
    arm = arm_physics(model)
    rng = np.random.default_rng(3)
    q, a = rng.uniform(-1, 1, (20, 3)), rng.uniform(-2, 2, (20, 3))
    v = rng.uniform(0.2, 1.0, (20, 3)) * rng.choice([-1.0, 1.0], (20, 3))
    for k in range(20):
        load = arm.robot.inverse_dynamics(q[[k]] + arm.shift, v[[k]], a[[k]])[0] + arm.rotor * a[k]
        dry = dry_friction(arm, v[k], load)
        torque = load + (arm.rotor_matrix() - np.diag(arm.rotor)) @ a[k] + joint_torque(arm, q[k], v[k])
        torque = torque + dry * np.sign(v[k])
        for term in arm.couplings:
            row = arm.coupling_row(term)
            torque = torque + term.dry * row * np.sign(row @ v[k])
        torque = np.array([d.logged(t) for d, t in zip(arm.drives, torque, strict=True)])
        expected = model.inverse_dynamics(q[[k]], v[[k]], a[[k]])[0]
        np.testing.assert_allclose(torque, expected, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("name", ["viscous_friction", "rotor_inertia", "joint_spring", "payload", "quadratic_drag"])
def test_smooth_motion_is_that_of_the_corrected_forward_dynamics(name: str) -> None:
    joint = None if CATALOGUE[name].whole_arm else 1
    model = corrected((name, joint))
    torque = model.gravity_torque(np.zeros((1, 3)))[0] + np.array([1.0, -0.5, 0.2])

    def rate(_t: float, s: np.ndarray) -> np.ndarray:
        return np.concatenate([s[3:], model.forward_dynamics(s[None, :3], s[None, 3:], torque[None])[0]])

    exact = solve_ivp(rate, (0.0, 0.3), np.zeros(6), rtol=1e-10, atol=1e-12).y[:3, -1]
    coarse, fine = (
        ForwardMotion(arm_physics(model), 0.3 / n, np.zeros(3), np.zeros(3)).advance(torque, n).q for n in (75, 150)
    )
    assert np.max(np.abs(fine - exact)) < 2e-4 * np.max(np.abs(exact))
    assert np.linalg.norm(fine - exact) < 0.3 * np.linalg.norm(coarse - exact)  # second order


def test_dry_friction_slides_as_its_sharp_limit_and_then_sticks() -> None:
    model = corrected(("coulomb_friction", 1), slow=1e-3)
    start = model.gravity_torque(np.zeros((1, 3)))[0]

    def rate(_t: float, s: np.ndarray) -> np.ndarray:
        return np.concatenate([s[3:], model.forward_dynamics(s[None, :3], s[None, 3:], start[None])[0]])

    v = np.array([0.0, 0.4, 0.0])
    exact = solve_ivp(rate, (0.0, 0.1), np.concatenate([np.zeros(3), v]), method="Radau", rtol=1e-7, atol=1e-9).y[
        :3, -1
    ]
    found = ForwardMotion(arm_physics(model), 2e-4, np.zeros(3), v).advance(start, 500).q
    assert np.max(np.abs(found - exact)) < 0.01 * np.max(np.abs(exact))
    still = ForwardMotion(arm_physics(model), 1e-3, np.zeros(3), np.zeros(3))
    pushed = start + np.array([0.0, 0.3 * case_values("coulomb_friction")["Fc"], 0.0])
    moved = abs(still.advance(pushed, 100).v[1])
    free = abs(ForwardMotion(arm_physics(ARM), 1e-3, np.zeros(3), np.zeros(3)).advance(pushed, 100).v[1])
    assert moved < 1e-9 < free


def test_a_drive_turns_a_logged_torque_into_the_one_behind_it() -> None:
    drive = Drive().scaled(1.2).moved(0.5).clipped(3.0).later(-0.01)
    torque = np.array([-1.0, 0.0, 1.5])
    np.testing.assert_allclose(drive.at_joint(drive.logged(torque)), torque, atol=1e-12)
    assert drive.logged(10.0) == 3.0
    assert drive.hold == 0.01
    assert drive.late == 0.0
