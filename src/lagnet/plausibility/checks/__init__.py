"""The checks, in the order in which they are told: what breaks others comes first. One check a file."""

from lagnet.plausibility.check import Check
from lagnet.plausibility.checks.base_angle_independence import BaseAngleIndependence
from lagnet.plausibility.checks.bounded_growth import BoundedGrowth
from lagnet.plausibility.checks.coriolis_from_mass_matrix import CoriolisFromMassMatrix
from lagnet.plausibility.checks.coriolis_quadratic import CoriolisQuadratic
from lagnet.plausibility.checks.coriolis_skew_symmetric import CoriolisSkewSymmetric
from lagnet.plausibility.checks.energy_along_motion import EnergyAlongMotion
from lagnet.plausibility.checks.energy_along_rollout import EnergyAlongRollout
from lagnet.plausibility.checks.finite_output import FiniteOutput
from lagnet.plausibility.checks.forward_inverts_inverse import ForwardInvertsInverse
from lagnet.plausibility.checks.gravity_is_gradient import GravityIsGradient
from lagnet.plausibility.checks.independent_samples import IndependentSamples
from lagnet.plausibility.checks.link_center_of_mass import LinkCenterOfMass
from lagnet.plausibility.checks.link_counted_once import LinkCountedOnce
from lagnet.plausibility.checks.link_density import LinkDensity
from lagnet.plausibility.checks.link_extent import LinkExtent
from lagnet.plausibility.checks.link_inertia_given import LinkInertiaGiven
from lagnet.plausibility.checks.link_mass import LinkMass
from lagnet.plausibility.checks.link_pseudo_inertia import LinkPseudoInertia
from lagnet.plausibility.checks.link_triangle_inequality import LinkTriangleInequality
from lagnet.plausibility.checks.mass_matrix_positive_definite import MassMatrixPositiveDefinite
from lagnet.plausibility.checks.mass_matrix_symmetric import MassMatrixSymmetric
from lagnet.plausibility.checks.periodic_joints import PeriodicJoints
from lagnet.plausibility.checks.recording_within_efforts import RecordingWithinEfforts
from lagnet.plausibility.checks.recording_within_positions import RecordingWithinPositions
from lagnet.plausibility.checks.recording_within_velocities import RecordingWithinVelocities
from lagnet.plausibility.checks.reference_bodies import ReferenceBodies
from lagnet.plausibility.checks.reference_coriolis import ReferenceCoriolis
from lagnet.plausibility.checks.reference_gravity import ReferenceGravity
from lagnet.plausibility.checks.reference_inertial import ReferenceInertial
from lagnet.plausibility.checks.reference_residual import ReferenceResidual
from lagnet.plausibility.checks.reference_total import ReferenceTotal
from lagnet.plausibility.checks.residual_dissipates import ResidualDissipates
from lagnet.plausibility.checks.residual_holds_no_gravity import ResidualHoldsNoGravity
from lagnet.plausibility.checks.torque_affine_in_acceleration import TorqueAffineInAcceleration
from lagnet.plausibility.checks.torque_without_acceleration import TorqueWithoutAcceleration

CHECKS: tuple[type[Check], ...] = (
    FiniteOutput,
    IndependentSamples,
    LinkMass,
    LinkInertiaGiven,
    LinkTriangleInequality,
    LinkPseudoInertia,
    LinkCenterOfMass,
    LinkDensity,
    LinkExtent,
    LinkCountedOnce,
    MassMatrixSymmetric,
    MassMatrixPositiveDefinite,
    CoriolisQuadratic,
    CoriolisFromMassMatrix,
    CoriolisSkewSymmetric,
    GravityIsGradient,
    TorqueWithoutAcceleration,
    TorqueAffineInAcceleration,
    ForwardInvertsInverse,
    EnergyAlongMotion,
    EnergyAlongRollout,
    PeriodicJoints,
    BaseAngleIndependence,
    ResidualDissipates,
    ResidualHoldsNoGravity,
    BoundedGrowth,
    RecordingWithinPositions,
    RecordingWithinVelocities,
    RecordingWithinEfforts,
    ReferenceBodies,
    ReferenceInertial,
    ReferenceCoriolis,
    ReferenceGravity,
    ReferenceResidual,
    ReferenceTotal,
)
CHECK_NAMES: tuple[str, ...] = tuple(check.name for check in CHECKS)
