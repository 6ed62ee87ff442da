"""Composes the verdict of a diagnosis on motion from the diagnoses of its joints and the rollouts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from lagnet._version import __version__
from lagnet.diagnosis.motion.joint.cases import encoder_step
from lagnet.diagnosis.motion.joint.joint_diagnosis import JointDiagnosis
from lagnet.diagnosis.motion.joint.localisation import locate_error, predictors
from lagnet.diagnosis.motion.joint.rivals import Comparison
from lagnet.diagnosis.motion.payload.entry import payload_abstention, payload_effect
from lagnet.diagnosis.motion.payload.found import PayloadFound
from lagnet.diagnosis.motion.problem import motion_rates
from lagnet.diagnosis.motion.surface.entry import surface_abstentions, surface_effects
from lagnet.diagnosis.motion.surface.found import SurfaceFound
from lagnet.diagnosis.motion.verdict import MotionVerdict, PositionErrors
from lagnet.diagnosis.motion.wording import as_ratio, explain_effect
from lagnet.diagnosis.verdict.inputs import nominal_entry, recording_entries
from lagnet.diagnosis.verdict.verdict import (
    Abstained,
    EffectEvidence,
    EffectFound,
    JointFit,
    JointMismatch,
    NamedParameter,
    Unexplained,
    Verdict,
)
from lagnet.recordings.recording import Recording
from lagnet.servos.catalogue import SERVO_CATALOGUE, servo_effect
from lagnet.servos.nominal import NominalServo
from lagnet.servos.parameters import INDEX, KP, LAW, NAMES

ABOVE = 2.0  # least motion error over the resolution to be significant
Rollouts = tuple[tuple[np.ndarray, ...], tuple[np.ndarray, ...], tuple[np.ndarray, ...]]


def compose_motion_verdict(
    robot: Any,
    servo: NominalServo,
    found: Sequence[JointDiagnosis | None],
    fit: Sequence[Recording],
    held: Sequence[Recording],
    rollouts: Rollouts,
    seed: int,
    payload: PayloadFound | None = None,
    surface: SurfaceFound | None = None,
) -> MotionVerdict:
    """All parts of the verdict; rollouts are nominal, corrected and named, one of each held-out trajectory."""
    parts = [part for recording in held for part in recording.parts()]
    measured = np.concatenate([part.q for part in parts])
    nominal, corrected, named = (np.concatenate(kind) - measured for kind in rollouts)
    signals = _signals(parts, found)
    joints = tuple(robot.joints)
    sizes = np.array([encoder_step(measured[:, j]) / np.sqrt(12.0) for j in range(len(joints))])
    floors = np.maximum(sizes, 1e-4)
    rmse = [np.sqrt(np.mean(e**2, axis=0)) for e in (nominal, named, corrected)]
    of = [[float(x) for x in r] for r in rmse]
    errors = tuple(PositionErrors(of[0][j], of[1][j], of[2][j], float(sizes[j])) for j in range(len(joints)))
    variance = np.maximum(np.var(measured, axis=0), floors**2)
    effects = [e for j, d in enumerate(found) if d is not None for e in _effects(joints[j], d, servo, j)]
    effects += [] if payload is None else [payload_effect(payload)]
    effects += surface_effects(surface)
    verdict = Verdict(
        lagnet_version=__version__,
        seed=seed,
        nominal=nominal_entry(robot, robot.joints),
        recordings=recording_entries(fit, held),
        conditioning={
            "rate_hz": float(fit[0].rate),
            "bandwidth_hz": float(fit[0].rate) / 2.0,
            "velocity_from": "differentiated",
            "velocity_reason": "rollouts are fitted to positions and judged on them",
            "acceleration_from": "differentiated",
        },
        joints=tuple(
            _mismatch(joints[j], j, nominal[:, j], float(floors[j]), float(variance[j]), signals[j])
            for j in range(len(joints))
        ),
        effects=tuple(sorted(effects, key=lambda e: -e.evidence.share_of_mismatch)),
        unexplained=tuple(
            _unexplained(joints[j], j, nominal[:, j], corrected[:, j], float(floors[j]), signals[j])
            for j in range(len(joints))
        ),
        fit=tuple(
            JointFit(
                joints[j],
                float(rmse[0][j] ** 2 / variance[j]),
                float(rmse[1][j] ** 2 / variance[j]),
                None,
                float(floors[j] ** 2 / variance[j]),
            )
            for j in range(len(joints))
        ),
        abstentions=(*_abstentions(joints, found, servo), *surface_abstentions(surface)),
        warnings=tuple(dict.fromkeys([*servo.warnings, *(w for r in (*fit, *held) for w in r.warnings)])),
    )
    bands = tuple(None if d is None or d.rest is None else asdict(d.rest) for d in found)
    return MotionVerdict(verdict, errors, _servo_of(servo, found, joints), bands, _rejected(joints, found))


def _signals(parts: Sequence[Recording], found: Sequence[JointDiagnosis | None]) -> list[dict[str, np.ndarray]]:
    """q, v, load, command and time of each joint, for locating errors; loads are those of the nominal bodies."""
    speed = np.concatenate([motion_rates(part.time, part.q)[0] for part in parts])
    out = []
    for j, diagnosis in enumerate(found):
        q, command = (np.concatenate([x[:, j] for x in kind]) for kind in _both(parts))
        load = np.zeros_like(q)
        if diagnosis is not None:
            load = diagnosis.case.fit.series.load[-len(q) :]  # the held-out trajectories stand last
            load = load if len(load) == len(q) else np.zeros_like(q)
        time = np.concatenate([part.time for part in parts])
        out.append({"q": q, "v": speed[:, j], "load": load, "command": command, "time": time})
    return out


def _both(parts: Sequence[Recording]) -> tuple[list[np.ndarray], list[np.ndarray]]:
    return [np.array(p.q) for p in parts], [np.array(p.command) for p in parts]


def _mismatch(
    name: str, joint: int, error: np.ndarray, floor: float, variance: float, signals: dict[str, np.ndarray]
) -> JointMismatch:
    rms = float(np.sqrt(np.mean(error**2)))
    significant = rms > ABOVE * floor
    where = locate_error(error, signals, joint) if significant else ()
    return JointMismatch(name, bool(significant), rms, floor, rms**2 / variance, where)


def _unexplained(
    name: str, joint: int, nominal: np.ndarray, corrected: np.ndarray, floor: float, signals: dict[str, np.ndarray]
) -> Unexplained:
    power = float(np.mean(corrected**2))
    above = power > (ABOVE * floor) ** 2
    share = min(1.0, power / max(float(np.mean(nominal**2)), 1e-300))
    return Unexplained(name, bool(above), share, predictors(corrected, signals, joint) if above else ())


def _effects(name: str, found: JointDiagnosis, servo: NominalServo, joint: int) -> list[EffectFound]:
    total = max(sum(max(c.gain, 0.0) for c in found.comparisons), 1e-12)
    return [_effect(name, found, c, total) for c in found.comparisons]


def _effect(name: str, found: JointDiagnosis, comparison: Comparison, total: float) -> EffectFound:
    law = servo_effect(comparison.effect)
    values, kp = law.read(found.named_law), float(found.named_law[KP])
    before = law.read(found.nominal)
    parameters = []
    for p, names in zip(law.parameters, law.frees, strict=True):
        value = values[p.name]
        low, high = found.intervals.get(names[0], (value, value))
        parameters.append(NamedParameter(p.name, value, p.unit, (min(low, value), max(high, value))))
    ratios = (as_ratio(p, kp, names[0]) for p, names in zip(parameters, law.frees, strict=True))
    reported = tuple(parameters if found.case.scale_is_set else ratios)
    power = float(np.exp(2.0 * found.named.blocks).mean()) / max(float(np.var(found.case.fit.series.q)), 1e-12)
    evidence = EffectEvidence(
        power * float(np.exp(2.0 * comparison.gain)),
        power,
        max(comparison.gain, 0.0) / total,
        comparison.best_rival,
        comparison.log10_odds,
    )
    nominal = {p.name: before[p.name] for p in law.parameters if abs(before[p.name]) not in (0.0, 1e9)}
    words = explain_effect(law.name, name, reported, comparison.tied, comparison.gain, nominal)
    status = "tied" if comparison.tied else "named"
    return EffectFound(law.name, name, status, comparison.tied, reported, evidence, words)


def _abstentions(
    joints: Sequence[str], found: Sequence[JointDiagnosis | None], servo: NominalServo
) -> tuple[Abstained, ...]:
    out = list(payload_abstention(servo))
    for joint, diagnosis in zip(joints, found, strict=True):
        if diagnosis is None:
            reason, advice = "the joint does not move", f"record a motion of {joint}"
            out += [Abstained(name, joint, reason, advice) for name in SERVO_CATALOGUE]
            continue
        case = diagnosis.case
        if not case.scale_is_set:
            why = (
                "nothing in the motion sets the scale of torques: no load that differs; values are in proportion to kp"
            )
            out.append(Abstained("gain_error", joint, why, f"rest and move {joint} under gravity or a known payload"))
        for name, law in SERVO_CATALOGUE.items():
            if name in case.excited or name in ("gain_error", "viscous_friction"):
                continue
            reason = law.excitation(
                case.fit.series.command, case.fit.series.q, np.abs(np.gradient(case.fit.series.q)) > 0
            )
            out.append(Abstained(name, joint, reason or "the motion cannot show it", f"a motion that {law.shown_by}"))
    return tuple(out)


def _servo_of(servo: NominalServo, found: Sequence[JointDiagnosis | None], joints: Sequence[str]) -> dict[str, Any]:
    """Source of the nominal servos, and the parameters of each law that are not neutral, before and after."""
    rows = []
    for j, diagnosis in enumerate(found):
        before = servo.laws[j] if diagnosis is None or servo.known[j] else diagnosis.nominal
        after = before if diagnosis is None else diagnosis.law
        row: dict[str, Any] = {"joint": joints[j], "source": servo.source if servo.known[j] else "estimated"}
        row["scale_is_set"] = diagnosis is not None and diagnosis.case.scale_is_set
        for key, law in (("nominal", before), ("corrected", after)):
            row[key] = {n: float(law[INDEX[n]]) for n in NAMES if law[INDEX[n]] != LAW[INDEX[n]].neutral}
        rows.append(row)
    return {"source": servo.source, "joints": rows}


def _rejected(joints: Sequence[str], found: Sequence[JointDiagnosis | None]) -> tuple[dict[str, Any], ...]:
    out = []
    for joint, diagnosis in zip(joints, found, strict=True):
        for r in () if diagnosis is None else diagnosis.rejected:
            detail = {
                "no_holdout_gain": "errors on motion that was not fitted hardly shrink with it",
                "not_significant": "the gain on motion that was not fitted is within its scatter",
                "below_resolution": "it changes the predicted motion by less than half a step of the encoder [rad]",
                "remainder": "with all that was selected most of the error remains: its cause is another [rad]",
                "explained_by_payload": "a payload at the last link predicts held-out motion as well, as one effect",
                "within_interval": "beside the other joints, its intervals hold the values of the nominal servo",
                "load_moved_the_joint": "a gear with it holds every load, and the load moved the joint",
                "changes_within_recordings": "its value changes through every recording, in shares of its effect",
                "near_nominal": "its parameters are those of the nominal servo but for a few percent",
            }[r.rule]
            entry = {"effect": r.effect, "joint": joint, "rule": r.rule, "value": r.value, "limit": r.limit}
            out.append(entry | {"detail": detail})
    return tuple(out)
