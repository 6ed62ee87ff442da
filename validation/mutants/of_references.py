"""Sabotages that show only beside a recording or a reference."""

from __future__ import annotations

import numpy as np

from validation.mutants.bench import Assembled, Case, added_inertia, recording_of, sound
from validation.mutants.registry import mutant

# ---- recordings ----------------------------------------------------------------------------------------------------


@mutant("recording_within_positions")
def recording_in_degrees() -> Case:
    """The recorded positions are in degrees."""
    arm = sound()
    return Case(arm, recordings=(recording_of(arm, scale_q=180 / np.pi),))


@mutant("recording_within_velocities")
def faster_than_allowed() -> Case:
    """The recorded speeds exceed the limits of the file."""
    arm = sound()
    return Case(arm, recordings=(recording_of(arm, scale_v=6.0),))


@mutant("recording_within_efforts")
def stronger_than_allowed() -> Case:
    """The recorded torques exceed the limits of the file."""
    arm = sound()
    return Case(arm, recordings=(recording_of(arm, scale_tau=400.0),))


# ---- reference -----------------------------------------------------------------------------------------------------


@mutant("reference_bodies")
def mass_wrong_by_a_thousandth() -> Case:
    """One mass is 0.1 % too large."""
    arm = sound()
    rows = arm.inertial_parameters().copy()
    rows[-1, 0] *= 1.001
    return Case(arm.with_inertial_parameters(rows), reference=arm)


@mutant("reference_bodies")
def inertia_that_no_torque_shows() -> Case:
    """The first link's inertia differs across its axis, where no motion can feel it."""
    arm = sound()
    rows = arm.inertial_parameters().copy()
    axis = arm.joint_axes(np.zeros(3))[0] if arm.n_dof else np.zeros(3)
    # The axis in the joint's own frame: that direction about which the torque feels the inertia.
    own = _own_axis(arm, axis)
    across = np.linalg.svd(own[None])[2][1]
    second = 0.01 * np.outer(own, own)  # mass spread along the axis alone turns without effort
    tensor = np.trace(second) * np.eye(3) - second
    assert abs(own @ tensor @ own) < 1e-12
    assert across @ tensor @ across > 0
    rows[0, 4:] += tensor[np.tril_indices(3)]
    return Case(arm.with_inertial_parameters(rows), reference=arm)


def _own_axis(arm, axis: np.ndarray) -> np.ndarray:
    """Axis of the first joint in its own frame, from what unit inertias weigh in the torque of a unit acceleration."""
    rest = np.zeros((1, 3))
    weights = arm.link_regressor(0, rest, rest, np.eye(3)[:1])[0, 0, 4:]
    outer = np.zeros((3, 3))
    outer[np.tril_indices(3)] = weights
    outer = np.where(np.eye(3) > 0, outer, (outer + outer.T) / 2)
    _values, vectors = np.linalg.eigh(outer)
    return vectors[:, -1]


@mutant("reference_inertial")
def rotor_hidden_by_the_residual() -> Case:
    """H holds a rotor that the residual takes off again: the whole torque is right."""
    arm = sound()
    rotor = 0.5 * np.mean(np.diagonal(arm.mass_matrix(np.zeros((1, 3))), axis1=1, axis2=2)) * np.ones(3)
    return Case(
        Assembled(
            arm,
            mass_matrix=lambda q: arm.mass_matrix(q) + np.diag(rotor),
            residual_torque=lambda q, v, a: -rotor * a,
        ),
        reference=arm,
    )


@mutant("reference_inertial")
def swapped_joints() -> Case:
    """The model counts its first two joints in another order than the reference."""
    arm = sound()
    order = [1, 0, 2]

    def swapped(call):
        return lambda *motion: call(*(x[:, order] for x in motion))[:, order]

    def mass(q):
        return arm.mass_matrix(q[:, order])[:, order][:, :, order]

    return Case(
        Assembled(
            arm,
            mass_matrix=mass,
            coriolis_torque=swapped(arm.coriolis_torque),
            gravity_torque=swapped(arm.gravity_torque),
        ),
        reference=arm,
    )


@mutant("reference_coriolis")
def rippled_inertia() -> Case:
    """A fine ripple in the inertia of the last joint: hardly seen in H, plainly in c."""
    arm = sound()
    size, waves = 0.1 * float(np.mean(arm.mass_matrix(np.zeros((1, 3)))[:, -1, -1])), 12

    def slope(q):
        gradient = np.zeros_like(q)
        gradient[:, -1] = size * waves * np.cos(waves * q[:, -1])
        return gradient

    return Case(Assembled(arm, **added_inertia(arm, lambda q: size * np.sin(waves * q[:, -1]), slope)), reference=arm)


@mutant("reference_gravity")
def weak_gravity_of_a_balanced_arm() -> Case:
    """Gravity is too weak by half on an arm that is almost balanced, so that inertia makes most of the torque."""
    arm = sound().with_gravity(np.array([0.0, 0.0, -0.5]))
    return Case(Assembled(arm, gravity_torque=lambda q: 0.5 * arm.gravity_torque(q)), reference=arm)


@mutant("reference_residual")
def half_the_friction() -> Case:
    """The model has half the friction of the reference."""
    arm = sound()
    friction = Assembled(arm, residual_torque=lambda q, v, a: 0.05 * v)
    return Case(Assembled(arm, residual_torque=lambda q, v, a: 0.025 * v), reference=friction)


@mutant("reference_total")
def scaled_arm() -> Case:
    """All masses are a third too large: every term is wrong, and so is the sum."""
    arm = sound()
    return Case(arm.with_inertial_parameters(4 / 3 * arm.inertial_parameters()), reference=arm)
