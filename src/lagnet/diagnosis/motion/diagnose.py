"""q̂(t) from commands u(t): what a nominal robot and its servos lack, by rollouts of held-out recordings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np

from lagnet.diagnosis.motion.arm.complete_or_named import no_worse_than_named
from lagnet.diagnosis.motion.arm.named_laws import fit_named_laws
from lagnet.diagnosis.motion.arm.tied_friction import tie_dry_friction
from lagnet.diagnosis.motion.compose import compose_motion_verdict
from lagnet.diagnosis.motion.joint.cases import joint_case
from lagnet.diagnosis.motion.joint.joint_case import JointCase, SelectionLimits
from lagnet.diagnosis.motion.joint.joint_diagnosis import JointDiagnosis, diagnose_joint
from lagnet.diagnosis.motion.payload.judgement import judge_payload
from lagnet.diagnosis.motion.problem import MotionProblem, median_voltage, pose_motion_problem, start_speed
from lagnet.diagnosis.motion.surface.judgement import judge_surface
from lagnet.diagnosis.motion.verdict import MotionVerdict
from lagnet.errors import DiagnosisError
from lagnet.models.corrected.changed_bodies import Correction
from lagnet.models.corrected.servo_driven import FoundCause, ServoDrivenModel
from lagnet.recordings.recording import Recording
from lagnet.recordings.splits import holdout_split
from lagnet.rigid_body.kinematic_tree import kinematic_tree
from lagnet.rigid_body.mjcf_actuators import position_actuators
from lagnet.rigid_body.robot import Robot
from lagnet.servos.catalogue import servo_effect
from lagnet.servos.nominal import NominalServo
from lagnet.servos.parameters import INDEX, KD, KP
from lagnet.servos.servo_file import servo_of_values
from lagnet.side_by_side import side_by_side

LEAST_STEPS = 3  # changes of position that a joint must show to be diagnosed
REFERENCE = 1.0  # [N m/rad] kp where nothing determines the scale of torques


@dataclass(frozen=True, eq=False)
class MotionDiagnosis:
    """The result of a diagnosis on motion.

    Args:
        verdict: the conclusions.
        corrected: the robot with its corrected servos.
        nominal: the robot with its nominal servos.
        joints: diagnosis of each joint, None for one that does not move.
        fit_recordings, holdout_recordings: those that were fitted, and those that were not.
        nominal_rollouts, corrected_rollouts: for each held-out trajectory, shape (n, dof) [rad or m].
        problem: the arrays behind it; the first `fitted` recordings were fitted.
    """

    verdict: MotionVerdict
    corrected: ServoDrivenModel
    nominal: ServoDrivenModel
    joints: tuple[JointDiagnosis | None, ...]
    fit_recordings: tuple[Recording, ...]
    holdout_recordings: tuple[Recording, ...]
    nominal_rollouts: tuple[np.ndarray, ...]
    corrected_rollouts: tuple[np.ndarray, ...]
    problem: MotionProblem
    fitted: int

    @property
    def effects(self) -> tuple[Any, ...]:
        """The physics that was left out, strongest first."""
        return self.verdict.effects

    def to_json(self) -> str:
        """The text of verdict.json."""
        return self.verdict.to_json()


def diagnose_motion(
    recordings: Sequence[Recording],
    robot: Any,
    holdout: Sequence[Recording] | None = None,
    *,
    servo: NominalServo | None = None,
    gains: Sequence[float] | None = None,
    limits: SelectionLimits | None = None,
    seed: int = 0,
) -> MotionDiagnosis:
    """Says where rollouts of commands and recorded motion differ, names the physics left out, and corrects the servos.

    Args:
        recordings: with commands and positions, joints as the robot's.
        robot: the nominal robot, or the servo-driven model of an earlier diagnosis.
        holdout: recordings that are not fitted; None: the last fifth of each recording.
        servo: the nominal servos; None: those of the MJCF's actuators, else estimated.
        gains: the controller's gains in each recording, then in each of `holdout`, relative to the nominal servo's.
        limits: where effects are named.
        seed: kept with the verdict; nothing here is random.

    Raises:
        DiagnosisError: no recording, joints that are not the robot's, or a recording without commands.
    """
    fit_on, held, factors = _divide(recordings, robot, holdout, gains)
    bodies, servo = nominal_of(robot, servo)
    tree = kinematic_tree(bodies)
    continued = 0 if holdout else len(held)
    laws = servo.laws if all(servo.known) else None
    problem = pose_motion_problem([*fit_on, *held], tree, factors, median_voltage(fit_on), continued, laws)
    limits = limits or SelectionLimits()
    joints = _diagnose_joints(problem, len(fit_on), servo, limits)
    apart = {i: d for i, d in enumerate(joints) if d is not None}
    apart = fit_named_laws(problem, len(fit_on), servo.laws, apart)
    apart = no_worse_than_named(problem, len(fit_on), servo.laws, apart)
    apart = tie_dry_friction(problem, len(fit_on), servo.laws, apart)
    payload, beside = judge_payload(problem, len(fit_on), servo, apart, limits)
    joints = tuple(beside.get(i) for i in range(len(joints)))
    loaded = bodies if payload is None else with_body(bodies, payload.body)
    body = None if payload is None else payload.body
    given = robot.surface if isinstance(robot, ServoDrivenModel) else None
    contact = None if given is not None else judge_surface(problem, len(fit_on), servo.laws, beside, body, limits)
    surface = given if contact is None else contact.surface
    scales = tuple(j is not None and j.case.scale_is_set for j in joints)
    supply = median_voltage(fit_on)
    pairs = [(servo.laws[i], servo.laws[i]) if j is None else (j.nominal, j.law) for i, j in enumerate(joints)]
    laws = [_as_given(servo, i, nominal) for i, (nominal, _) in enumerate(pairs)]
    nominal = ServoDrivenModel(bodies, np.array(laws), scales, supply, given)
    corrected = ServoDrivenModel(loaded, np.array([law for _, law in pairs]), scales, supply, surface)
    named_laws = np.array([servo.laws[i] if j is None else j.named_law for i, j in enumerate(joints)])
    named = ServoDrivenModel(loaded, named_laws, scales, supply, surface)
    factors = factors or [1.0] * (len(fit_on) + len(held))
    starts = [(r, factors[len(fit_on) + i], fit_on[i] if continued else None) for i, r in enumerate(held)]
    before, after, with_names = (
        tuple(_roll(m, part, gain, run) for r, gain, run in starts for part in r.parts())
        for m in (nominal, corrected, named)
    )
    verdict = compose_motion_verdict(
        robot, servo, joints, fit_on, held, (before, after, with_names), seed, payload, contact
    )
    corrected = replace(corrected, causes=_causes(verdict, corrected), before=nominal)
    return MotionDiagnosis(verdict, corrected, nominal, joints, fit_on, held, before, after, problem, len(fit_on))


def _causes(verdict: MotionVerdict, model: ServoDrivenModel) -> tuple[FoundCause, ...]:
    out = []
    for e in verdict.effects:
        joint = None if e.joint is None else model.joints.index(e.joint)
        told = {p.name: float(p.value) for p in e.parameters}
        values = told if joint is None else servo_effect(e.effect).read(model.laws[joint])
        out.append(FoundCause(e.effect, joint, e.status, values))
    return tuple(out)


def with_body(robot: Any, body: np.ndarray) -> Any:
    """The robot with ten inertial parameters added to its last link, shape (10,)."""
    parameters = robot.inertial_parameters()
    parameters[-1] += body
    return robot.with_inertial_parameters(parameters)


def _as_given(servo: NominalServo, joint: int, estimated: np.ndarray) -> np.ndarray:
    return servo.laws[joint] if servo.known[joint] else estimated


def nominal_of(robot: Any, servo: NominalServo | None) -> tuple[Any, NominalServo]:
    """The nominal bodies and servos.

    Raises:
        DiagnosisError: a model without bodies.
    """
    if isinstance(robot, ServoDrivenModel):
        given = NominalServo(robot.laws, (True,) * robot.n_dof, "file")
        return robot.nominal, servo or given
    if not hasattr(robot, "inertial_parameters") or not hasattr(robot, "kind"):
        raise DiagnosisError(
            "motion is diagnosed against rigid bodies", next_step="give a URDF, an MJCF, a name such as ur5"
        )
    bodies: Any = robot.bodies() if isinstance(robot, Correction) else robot
    if servo is not None:
        return bodies, servo
    given, notes = position_actuators(cast(Robot, bodies))
    return bodies, servo_of_values(given, bodies.joints, bodies.armature, "mjcf", notes)


def _divide(
    recordings: Sequence[Recording],
    robot: Any,
    holdout: Sequence[Recording] | None,
    gains: Sequence[float] | None,
) -> tuple[tuple[Recording, ...], tuple[Recording, ...], list[float] | None]:
    if not recordings:
        raise DiagnosisError("no recording was given", next_step="give at least one of commands and positions")
    for recording in (*recordings, *(holdout or ())):
        if recording.n_dof != robot.n_dof:
            what = f"the recording has {recording.n_dof} joints, the model {robot.n_dof}"
            raise DiagnosisError(what, where=recording.path or None, choices=robot.joints)
        if recording.command is None:
            raise DiagnosisError("holds no commands", where=recording.path or None, next_step="record command_i")
    if gains is not None and len(gains) != len(recordings) + len(holdout or ()):
        raise DiagnosisError(f"{len(gains)} gains were given for {len(recordings) + len(holdout or ())} recordings")
    if holdout:
        return tuple(recordings), tuple(holdout), None if gains is None else list(gains)
    fit, held = holdout_split(recordings)
    return fit, held, None if gains is None else [*gains, *gains]


def _diagnose_joints(
    problem: MotionProblem, fitted: int, servo: NominalServo, limits: SelectionLimits
) -> tuple[JointDiagnosis | None, ...]:
    """First the joints whose loads determine the scale of torques: their gain is the reference of the others."""
    moving = [j for j in range(len(problem.joints)) if _moves(problem.series[j].q)]
    of_given = side_by_side(lambda j: joint_case(problem, fitted, j, servo, limits, REFERENCE), moving)
    cases = dict(zip(moving, of_given, strict=True))
    found = _diagnosed(problem, fitted, {j: case for j, case in cases.items() if case.scale_is_set})
    share = _gain_share(found, servo)
    gain = float(np.median([d.law[KP] for d in found.values()])) if found else REFERENCE

    def beside_them(joint: int) -> JointCase:
        assumed = servo
        if share is not None and servo.known[joint]:
            laws = servo.laws.copy()
            laws[joint, [KP, KD, INDEX["ki"]]] *= share
            assumed = NominalServo(laws, servo.known, servo.source)
        return joint_case(problem, fitted, joint, assumed, limits, gain)

    others = [joint for joint in moving if joint not in found]
    found |= _diagnosed(problem, fitted, dict(zip(others, side_by_side(beside_them, others), strict=True)))
    return tuple(found.get(joint) for joint in range(len(problem.joints)))


def _moves(q: np.ndarray) -> bool:
    return bool(np.ptp(q) > 1e-6 and np.sum(np.abs(np.diff(q)) > 1e-9) > LEAST_STEPS)


def _diagnosed(problem: MotionProblem, fitted: int, cases: Mapping[int, JointCase]) -> dict[int, JointDiagnosis]:
    found = side_by_side(lambda item: diagnose_joint(problem, fitted, *item), list(cases.items()))
    return dict(zip(cases, found, strict=True))


def _gain_share(found: dict[int, JointDiagnosis], servo: NominalServo) -> float | None:
    """Median of kp over nominal kp, of the joints whose scale is determined; None without one."""
    shares = [d.named_law[KP] / servo.laws[j, KP] for j, d in found.items() if servo.known[j]]
    return float(np.median(shares)) if shares else None


def _roll(model: ServoDrivenModel, part: Recording, gain: float, before: Recording | None) -> np.ndarray:
    signals = {"enabled": part.enabled, "voltage": part.voltage, "gain": gain, "v0": start_speed(part, before)}
    return model.rollout(np.array(part.command), part.time, part.q[0], **signals)
