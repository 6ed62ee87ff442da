"""Sabotaged models: each breaks one statement of physics, and names the check that is meant to catch it."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lagnet.plausibility.settings import CheckSettings
from lagnet.rigid_body.inertia import parameters_of_body
from lagnet.rigid_body.robot import load_description
from validation.mutants.bench import SKEW, Assembled, Case, added_inertia, recording_of, robot_from, sound, sound_urdf


@dataclass(frozen=True)
class Mutant:
    """One sabotage."""

    name: str
    meant_for: str
    what: str
    build: Callable[[], Case]


MUTANTS: list[Mutant] = []


def mutant(meant_for: str) -> Callable[[Callable[[], Case]], Callable[[], Case]]:
    """Register a builder; its name is the mutant's, its docstring says what was done."""

    def register(build: Callable[[], Case]) -> Callable[[], Case]:
        MUTANTS.append(Mutant(build.__name__, meant_for, " ".join((build.__doc__ or "").split()), build))
        return build

    return register


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


# ---- bodies --------------------------------------------------------------------------------------------------------


def _with_body(change: Callable[[np.ndarray], np.ndarray]) -> Case:
    arm = sound()
    rows = arm.inertial_parameters().copy()
    rows[1] = change(rows[1])
    return Case(arm.with_inertial_parameters(rows))


def _scaled_attributes(urdf: str, link: str, element: str, factor: float) -> str:
    """The file with the numbers of one element of one link scaled."""
    head, body, tail = re.split(rf'(<link name="{link}">.*?</link>)', urdf, maxsplit=1, flags=re.S)

    def scaled(match: re.Match[str]) -> str:
        return re.sub(
            r'"([^"]*)"', lambda m: '"' + " ".join(repr(factor * float(x)) for x in m[1].split()) + '"', match[0]
        )

    return head + re.sub(rf"<{element} [^>]*/>", scaled, body, count=1) + tail


@mutant("link_mass")
def massless_body() -> Case:
    """A body in the middle of the arm has moments of inertia but no mass."""

    def change(row):
        return np.concatenate([np.zeros(4), row[4:]])

    return _with_body(change)


@mutant("link_inertia_given")
def point_mass() -> Case:
    """The inertia of a link was left at zero."""
    return Case(robot_from(_scaled_attributes(sound_urdf(), "link_1", "inertia", 0.0)))


@mutant("link_triangle_inequality")
def triangle_broken_by_one_per_cent() -> Case:
    """The largest principal moment exceeds the sum of the others by 1 %."""
    return _with_body(lambda row: parameters_of_body(row[0], row[1:4] / row[0], np.diag([0.01, 0.02, 0.0303])))


@mutant("link_pseudo_inertia")
def plate_without_thickness() -> Case:
    """A link is a plate of no thickness: the triangle inequality holds as an equality."""
    return _with_body(lambda row: parameters_of_body(row[0], row[1:4] / row[0], np.diag([0.01, 0.02, 0.03])))


@mutant("link_center_of_mass")
def millimetres_for_metres() -> Case:
    """A centre of mass was given in millimetres."""
    return Case(robot_from(_scaled_attributes(sound_urdf(), "link_1", "origin", 1000.0)))


@mutant("link_density")
def one_link_in_grams() -> Case:
    """Mass and inertia of one link are in grams."""
    return _with_body(lambda row: 1000.0 * row)


@mutant("link_density")
def one_mass_in_grams() -> Case:
    """The mass alone of one link is in grams."""
    return Case(robot_from(_scaled_attributes(sound_urdf(), "link_1", "mass", 1000.0)))


@mutant("link_extent")
def inertia_in_square_millimetres() -> Case:
    """The inertia of one link is in kg mm²."""
    return Case(robot_from(_scaled_attributes(sound_urdf(), "link_1", "inertia", 1e6)))


@mutant("link_counted_once")
def link_repeated_by_a_frame() -> Case:
    """A frame welded to a link repeats its inertia."""
    urdf = sound_urdf()
    found = re.search(r'<link name="link_1">(.*?)</link>', urdf, re.S)
    assert found is not None
    weld = '<joint name="copy_joint" type="fixed"><parent link="link_1"/><child link="link_1_inertia"/></joint>'
    extra = f'<link name="link_1_inertia">{found[1]}</link>{weld}'
    return Case(robot_from(urdf.replace("</robot>", extra + "</robot>")))


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
