"""Sabotaged calls: each breaks one statement about H, c, g, ε or the whole torque."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.settings import CheckSettings
from lagnet.rigid_body.robot import load_description
from validation.mutants.bench import SKEW, Assembled, Case, added_inertia, sound
from validation.mutants.registry import mutant

# ---- calls ---------------------------------------------------------------------------------------------------------


@mutant("finite_output")
def nan_at_one_limit() -> Case:
    """Torque is not a number where the last joint is within 2 % of its upper limit."""
    arm = sound()

    def torque(q, v, a):
        tau = arm.inverse_dynamics(q, v, a)
        far = q[:, -1] > arm.position_upper[-1] - 0.02 * (arm.position_upper[-1] - arm.position_lower[-1])
        return np.where(far[:, None], np.nan, tau)

    return Case(Assembled(arm, inverse_dynamics=torque))


@mutant("independent_samples")
def normalised_by_the_batch() -> Case:
    """Torque is shifted by a thousandth of the batch's mean, as a forgotten batch normalisation does."""
    arm = sound()

    def torque(q, v, a):
        tau = arm.inverse_dynamics(q, v, a)
        return tau + 1e-3 * tau.mean(axis=0)

    return Case(Assembled(arm, inverse_dynamics=torque))


@mutant("independent_samples")
def noisy() -> Case:
    """Torque carries noise of a thousandth of its size, as a forgotten dropout does."""
    arm, rng = sound(), np.random.default_rng(0)

    def torque(q, v, a):
        tau = arm.inverse_dynamics(q, v, a)
        return tau * (1 + 1e-3 * rng.standard_normal(tau.shape))

    return Case(Assembled(arm, inverse_dynamics=torque))


# ---- inertia -------------------------------------------------------------------------------------------------------


@mutant("mass_matrix_symmetric")
def asymmetric_mass_matrix() -> Case:
    """An antisymmetric constant is added to H, and to the torque with it."""
    arm = sound()
    return Case(Assembled(arm, mass_matrix=lambda q: arm.mass_matrix(q) + 1e-3 * SKEW))


@mutant("mass_matrix_symmetric")
def swapped_rows() -> Case:
    """Torques of the first two joints are swapped on output, accelerations are not."""
    arm = sound()
    order = [1, 0, 2]
    return Case(
        Assembled(
            arm,
            mass_matrix=lambda q: arm.mass_matrix(q)[:, order],
            coriolis_torque=lambda q, v: arm.coriolis_torque(q, v)[:, order],
            gravity_torque=lambda q: arm.gravity_torque(q)[:, order],
        )
    )


@mutant("mass_matrix_positive_definite")
def indefinite_in_one_corner() -> Case:
    """The last joint loses inertia in one corner of the box of positions, with the right Coriolis torque."""
    arm = sound()
    corner, sharpness = arm.position_upper, 11.0
    most = 1.05 * float(arm.mass_matrix(corner[None])[0, -1, -1])

    def bump(q):
        return -most * np.exp(sharpness * np.sum(np.cos(q - corner) - 1, axis=1))

    def slope(q):
        return bump(q)[:, None] * -sharpness * np.sin(q - corner)

    return Case(Assembled(arm, **added_inertia(arm, bump, slope)))


# ---- Coriolis ------------------------------------------------------------------------------------------------------


@mutant("coriolis_from_mass_matrix")
def halved_coriolis() -> Case:
    """c is half of what H asks for."""
    arm = sound()
    return Case(Assembled(arm, coriolis_torque=lambda q, v: 0.5 * arm.coriolis_torque(q, v)))


@mutant("coriolis_from_mass_matrix")
def coriolis_of_another_configuration() -> Case:
    """c is that of a place 0.05 rad away."""
    arm = sound()
    return Case(Assembled(arm, coriolis_torque=lambda q, v: arm.coriolis_torque(q + 0.05, v)))


@mutant("coriolis_from_mass_matrix")
def workless_coriolis() -> Case:
    """c gains a part that is quadratic in v and does no work, but does not come from H."""
    arm = sound()

    def coriolis(q, v):
        return arm.coriolis_torque(q, v) + 1e-3 * v.sum(axis=1, keepdims=True) * (v @ SKEW.T)

    return Case(Assembled(arm, coriolis_torque=coriolis))


@mutant("coriolis_from_mass_matrix")
def degrees_for_radians() -> Case:
    """The model takes positions in degrees."""
    arm = sound()
    scale = 180 / np.pi
    return Case(
        Assembled(
            arm,
            mass_matrix=lambda q: arm.mass_matrix(scale * q),
            coriolis_torque=lambda q, v: arm.coriolis_torque(scale * q, v),
            gravity_torque=lambda q: arm.gravity_torque(scale * q),
        )
    )


@mutant("coriolis_skew_symmetric")
def coriolis_matrix_not_christoffel() -> Case:
    """C v is right, but the matrix C is not that of the Christoffel symbols."""
    arm = sound()

    def matrix(q, v):
        return arm.coriolis_matrix(q, v) + 1e-3 * np.einsum("i,nj->nij", np.ones(3), v @ SKEW.T)

    return Case(Assembled(arm, coriolis_matrix=matrix))


@mutant("coriolis_quadratic")
def friction_in_coriolis() -> Case:
    """Viscous friction was learned into c."""
    arm = sound()
    return Case(Assembled(arm, coriolis_torque=lambda q, v: arm.coriolis_torque(q, v) + 0.05 * v))


@mutant("coriolis_quadratic")
def offset_in_coriolis() -> Case:
    """c is not zero at rest."""
    arm = sound()
    return Case(Assembled(arm, coriolis_torque=lambda q, v: arm.coriolis_torque(q, v) + 0.01))


# ---- gravity -------------------------------------------------------------------------------------------------------


@mutant("gravity_is_gradient")
def non_gradient_gravity() -> Case:
    """The first joint's gravity torque depends on the second joint, but not the other way round."""
    arm = sound()

    def gravity(q):
        g = arm.gravity_torque(q).copy()
        g[:, 0] += 0.02 * np.sin(q[:, 0]) * np.sin(q[:, 1])
        return g

    return Case(Assembled(arm, gravity_torque=gravity))


@mutant("energy_along_motion")
def sign_of_gravity() -> Case:
    """Gravity torque has the wrong sign against the model's own potential energy."""
    arm = sound()
    return Case(Assembled(arm, gravity_torque=lambda q: -arm.gravity_torque(q), potential_energy=arm.potential_energy))


@mutant("energy_along_motion")
def doubled_kinetic_energy() -> Case:
    """The model's kinetic energy is v'Hv, without the half."""
    arm = sound()
    return Case(Assembled(arm, kinetic_energy=lambda q, v: 2 * arm.kinetic_energy(q, v)))


@mutant("periodic_joints")
def spring_in_gravity() -> Case:
    """A spring was learned into g: a potential, but not that of a turning joint."""
    arm = sound()
    return Case(Assembled(arm, gravity_torque=lambda q: arm.gravity_torque(q) + 0.01 * q))


@mutant("periodic_joints")
def motor_in_gravity() -> Case:
    """A constant was learned into g: a full turn would do work."""
    arm = sound()
    return Case(Assembled(arm, gravity_torque=lambda q: arm.gravity_torque(q) + np.array([0.02, 0.0, 0.0])))


@mutant("base_angle_independence")
def tilted_base() -> Case:
    """The arm of a user who says that its first axis is vertical stands two degrees off."""
    tilt = np.deg2rad(2.0)
    arm = load_description("ur5").with_gravity(9.81 * np.array([np.sin(tilt), 0.0, -np.cos(tilt)]))
    return Case(arm, settings=CheckSettings(vertical_base=True))


# ---- torque --------------------------------------------------------------------------------------------------------


@mutant("torque_affine_in_acceleration")
def squared_acceleration() -> Case:
    """Torque holds a part with a²."""
    arm = sound()
    return Case(Assembled(arm, inverse_dynamics=lambda q, v, a: arm.inverse_dynamics(q, v, a) + 1e-4 * a * a))


@mutant("torque_affine_in_acceleration")
def workless_acceleration() -> Case:
    """Torque holds a part that depends on a without being linear in it, and does no work."""
    arm = sound()

    def torque(q, v, a):
        size = np.sum(a * a, axis=1, keepdims=True)
        return arm.inverse_dynamics(q, v, a) + 1e-3 * size / (1 + size) * (v @ SKEW.T)

    return Case(Assembled(arm, inverse_dynamics=torque))


@mutant("torque_without_acceleration")
def hidden_gyroscope() -> Case:
    """Torque holds a part linear in v that does no work and is in no term."""
    arm = sound()
    return Case(Assembled(arm, inverse_dynamics=lambda q, v, a: arm.inverse_dynamics(q, v, a) + 1e-3 * v @ SKEW.T))


@mutant("forward_inverts_inverse")
def forward_dynamics_of_another_model() -> Case:
    """Forward dynamics are those of an arm whose last link is a tenth heavier."""
    arm = sound()
    rows = arm.inertial_parameters().copy()
    rows[-1] *= 1.1
    return Case(Assembled(arm, forward_dynamics=arm.with_inertial_parameters(rows).forward_dynamics))


@mutant("forward_inverts_inverse")
def forward_dynamics_with_gain() -> Case:
    """Forward dynamics take every torque for one per cent more than it is."""
    arm = sound()

    def forward(q, v, tau):
        return arm.forward_dynamics(q, v, 1.01 * tau)

    return Case(Assembled(arm, forward_dynamics=forward))


@mutant("energy_along_rollout")
def clipped_acceleration() -> Case:
    """Forward dynamics clip accelerations beyond what was tried: free falls exceed it."""
    arm = sound()

    def forward(q, v, tau):
        return np.clip(arm.forward_dynamics(q, v, tau), -7.0, 7.0)

    return Case(Assembled(arm, forward_dynamics=forward))


# ---- residual ------------------------------------------------------------------------------------------------------


@mutant("residual_dissipates")
def driving_friction() -> Case:
    """The residual of one joint pushes along with its motion."""
    arm = sound()
    drive = np.array([0.05, 0.05, -0.05])
    return Case(Assembled(arm, residual_torque=lambda q, v, a: drive * v))


@mutant("residual_dissipates")
def mirrored_friction() -> Case:
    """Coulomb friction of all joints has the wrong sign."""
    arm = sound()
    return Case(Assembled(arm, residual_torque=lambda q, v, a: -0.1 * np.tanh(20 * v)))


@mutant("residual_holds_no_gravity")
def residual_holds_gravity() -> Case:
    """The residual carries 5 % of the gravity torque, and g that much less."""
    arm = sound()
    return Case(
        Assembled(
            arm,
            gravity_torque=lambda q: 0.95 * arm.gravity_torque(q),
            residual_torque=lambda q, v, a: 0.05 * arm.gravity_torque(q),
        )
    )


@mutant("bounded_growth")
def cubic_residual() -> Case:
    """The residual grows with v³."""
    arm = sound()
    return Case(Assembled(arm, residual_torque=lambda q, v, a: 0.05 * v**3))


@mutant("bounded_growth")
def exploding_residual() -> Case:
    """The residual grows exponentially and overflows outside the data."""
    arm = sound()

    def residual(q, v, a):
        with np.errstate(over="ignore"):
            return 1e-3 * np.sinh(5 * v)

    return Case(Assembled(arm, residual_torque=residual))
