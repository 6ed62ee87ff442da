"""The servo laws of a make, fitted by rollouts to one recording of commands and positions."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lagnet.diagnosis.motion.arm.fixed_laws import FittedLaws, fit_fixed_laws
from lagnet.diagnosis.motion.diagnose import nominal_of, with_body
from lagnet.diagnosis.motion.problem import MotionProblem, pose_motion_problem
from lagnet.diagnosis.motion.wording import as_ratio
from lagnet.diagnosis.verdict.verdict import NamedParameter
from lagnet.effects.effect import Parameter
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.kinematic_tree import kinematic_tree
from lagnet.servos.catalogue import SERVO_CATALOGUE, servo_effect
from lagnet.servos.parameters import INDEX, KP, NAMES
from lagnet.tracking.fixed_fit import SHARE, ParameterRow
from lagnet.tracking.servos.tracked import PAYLOAD, STILL, Added, TrackedServo, TrackedServos
from lagnet.types import joint_types_of


@dataclass(frozen=True)
class Determined:
    """How well a recording determines an effect that the set holds beyond that of its make.

    Args:
        joint, effect: what it is.
        values, halves: its law parameters by name, with half-widths of their 95 % intervals.
        wider: largest factor by which it widens the interval of another parameter; None where motion does not tell
            them apart at all.
    """

    joint: int
    effect: str
    values: dict[str, float]
    halves: dict[str, float]
    wider: float | None


@dataclass(frozen=True, eq=False)
class ServoFit:
    """Servo laws fitted to one recording.

    Args:
        laws: shape (dof, len(LAW)).
        rows: the parameters that are followed.
        load: shape (dof,), mean magnitude of the torque that the bodies need, with what they carry [N m or N].
        left: shape (dof,), error of rollouts, root mean square [rad or m].
        determined: of the effects beyond the set of the make, at joints that move.
    """

    laws: np.ndarray
    rows: tuple[ParameterRow, ...]
    load: np.ndarray
    left: np.ndarray
    determined: tuple[Determined, ...] = ()


def fit_servos(recording: Recording, nominal: Any, tracked: TrackedServos, gain: float = 1.0) -> ServoFit:
    """The free parameters of all joints together, by rollouts of the whole arm.

    Args:
        recording: all of it is fitted.
        nominal: the nominal bodies of the make.
        tracked: the set, with laws from which to start.
        gain: of the controller, relative to that of the set's laws.

    Raises:
        DiagnosisError: no commands, or fewer than ten samples in every trajectory.
    """
    bodies, _ = nominal_of(nominal, None)
    problem = pose_motion_problem([recording], kinematic_tree(bodies), [gain], tracked.voltage)
    free = {j: s.free for j, s in enumerate(tracked.servos) if s.free and _moves(problem, j)}
    sizes = {j: dict(zip(NAMES, tracked.servos[j].sizes, strict=True)) for j in free}
    body = np.array(tracked.body) if tracked.body else None
    added = [a for a in tracked.added if a.joint in free]
    apart = [(a.joint, a.groups) for a in added]
    fitted = fit_fixed_laws(problem, tracked.laws, free, sizes, np.array(tracked.floors), body, apart)
    rows = [row for j in free for row in _rows(problem, fitted, tracked.servos[j], j, bodies)]
    if body is not None and fitted.share is not None:
        share, half = fitted.share
        rows.append(ParameterRow(PAYLOAD, None, SHARE, "–", share, share - half, share + half))
        carried = kinematic_tree(with_body(bodies, share * body))
        problem = pose_motion_problem([recording], carried, [gain], tracked.voltage)
    load = np.array([float(np.mean(np.abs(s.load))) for s in problem.series])
    determined = tuple(_determined(fitted, one, wider) for one, wider in zip(added, fitted.wider, strict=True))
    return ServoFit(fitted.laws, tuple(rows), load, fitted.left, determined)


def _determined(fitted: FittedLaws, one: Added, wider: float) -> Determined:
    names = [group[0] for group in one.groups]
    values = {n: float(fitted.laws[one.joint, INDEX[n]]) for n in names}
    halves = {n: fitted.half[one.joint, n] for n in names}
    return Determined(one.joint, one.effect, values, halves, wider if np.isfinite(wider) else None)


def _moves(problem: MotionProblem, joint: int) -> bool:
    return float(np.ptp(problem.series[joint].q)) > STILL


def _rows(
    problem: MotionProblem, fitted: FittedLaws, servo: TrackedServo, joint: int, bodies: Any
) -> Iterable[ParameterRow]:
    law = fitted.laws[joint]
    slides = joint_types_of(bodies, len(problem.joints))[joint] == "prismatic"
    for group in servo.free:
        if (owner := owner_of(group[0], servo.effects)) is None:
            continue  # fitted beside the others, and followed by no name
        effect, parameter = owner
        value, half = float(law[INDEX[group[0]]]), fitted.half[joint, group[0]]
        told = NamedParameter(parameter.name, value, parameter.unit, (value - half, value + half))
        told = told if servo.scale_is_set else as_ratio(told, float(law[KP]), group[0])
        unit = replace(parameter, unit=told.unit).unit_for(slides)
        yield ParameterRow(effect, problem.joints[joint], told.name, unit or "–", told.value, *told.ci95)


def owner_of(law_parameter: str, effects: tuple[str, ...]) -> tuple[str, Parameter] | None:
    """Effect and parameter that tell a law parameter: of the named effects, else of the plainest that has it."""
    plainest = sorted(SERVO_CATALOGUE, key=lambda name: len(servo_effect(name).parameters))
    for name in (*effects, *plainest):
        law = servo_effect(name)
        for parameter, frees in zip(law.parameters, law.frees, strict=True):
            if law_parameter in frees:
                return name, parameter
    return None
