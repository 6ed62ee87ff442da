"""Builds the `JointCase` of each joint: windows to fit and to validate on, a first law, typical sizes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lagnet.diagnosis.motion.joint.equation_error import FirstLaw, first_law
from lagnet.diagnosis.motion.joint.fitting import JointData
from lagnet.diagnosis.motion.joint.joint_case import JointCase, SelectionLimits
from lagnet.diagnosis.motion.joint.self_locking import moved_by_load
from lagnet.diagnosis.motion.problem import MotionProblem
from lagnet.recordings.sampling import median_step
from lagnet.rollout.one_joint import JointSeries, Windows
from lagnet.servos.catalogue import SERVO_CATALOGUE
from lagnet.servos.effect import Scales
from lagnet.servos.nominal import NominalServo
from lagnet.servos.parameters import BIAS, FULL_ERROR, INDEX, KD, KP, VISCOUS

FULL_DUTY = 0.98  # recorded duty below which the controller's torque was not limited
LEAST_ERROR = 1e-4  # [rad] discretisation error of a rollout
ENOUGH = 40.0  # [s] of motion for validation, below which every window is for validation once
EVERY = 4  # one window in so many of the fitted recordings is for validation
FIRST_FOLD = 2  # its windows are 2, 6, 10 ...
LONG = 10.0  # [s] of a rollout to which the complete law is fitted
SAMPLES = 8000  # that a search uses; the last fit uses all
ESTIMATED: tuple[tuple[str, ...], ...] = (("kp",), ("viscous",))  # free from the start where no servo is given


def joint_case(
    problem: MotionProblem,
    fitted: int,
    joint: int,
    servo: NominalServo,
    limits: SelectionLimits,
    reference: float = 1.0,
) -> JointCase:
    """The case of one joint.

    Args:
        problem: all recordings; the first `fitted` of them may be fitted, the others are for validation.
        joint: its index.
        servo: the nominal one.
        limits: where effects are named.
        reference: kp of a servo without a nominal law where no load determines it [N m/rad].
    """
    series, speed = problem.series[joint], problem.speed[:, joint]
    resolution = encoder_step(series.q)
    moving = (np.abs(speed) > 3.0 * resolution / 0.1 + 1e-4) & _inside(problem, fitted)
    start = _first(problem, joint, moving, servo, reference)
    known, law = servo.known[joint], servo.laws[joint].copy()
    if not known:
        law[[KP, VISCOUS]] = start.law[[KP, VISCOUS]]
    if (line := problem.duty_lines[joint]) is not None:
        for one in (law, start.law):
            one[FULL_ERROR] = line.full_error
            one[BIAS] = one[BIAS] if known else line.bias
    excited = tuple(n for n, e in SERVO_CATALOGUE.items() if e.excitation(series.command, series.q, moving) is None)
    if not known:
        excited = tuple(n for n in excited if n not in ("gain_error", "viscous_friction"))
    shown = _shown_by_duty(problem, joint, known)
    excited = tuple(n for n in excited if n not in shown)
    base = () if known else (ESTIMATED if start.scale_is_set else ESTIMATED[1:])
    if base and np.ptp(series.enabled) > 0.0:  # friction alone acts while the drive is off
        base = (*base, ("back_emf",))
    floor = max(0.5 * resolution, LEAST_ERROR)
    (data, validation), *folds = _folds(problem, fitted, joint, min(problem.step, 0.004))
    scales, scale_is_set = _scales(series, speed, moving, law, start), start.scale_is_set
    case = JointCase(data, validation, law, start.law, scale_is_set, base, scales, floor, excited, limits, tuple(folds))
    return replace(case, moved_by_load=moved_by_load(series, speed, moving, start.law))


def _shown_by_duty(problem: MotionProblem, joint: int, known: bool) -> set[str]:
    """Effects that are no question of motion: a recorded duty answers them, or without one nothing does."""
    if problem.duty_lines[joint] is None:
        return {"torque_saturation", *(["duty_saturation"] if problem.greatest_duty[joint] < FULL_DUTY else [])}
    return {"duty_saturation"} if known else {"duty_saturation", "position_bias"}


def _inside(problem: MotionProblem, fitted: int) -> np.ndarray:
    """Samples of recordings that may be fitted, shape (n,)."""
    inside = np.zeros(len(problem.speed), dtype=bool)
    for run in problem.runs:
        inside[run.first : run.last + 1] = run.recording < fitted
    return inside


def _divided(
    problem: MotionProblem, fitted: int, joint: int, length: float | None = None, fold: int = FIRST_FOLD
) -> tuple[Windows, Windows]:
    """Windows to fit, and windows for validation: long ones of all that is held out, and every fourth of the others.

    Effects of rest and of stops show where the state comes from a rollout and not from a measurement nearby. What is
    held out is in the first fold, that of the windows 2, 6, 10 ...
    """
    of_fit, inside = windows_to_fit(problem, fitted, joint, length), _inside(problem, fitted)
    seen = np.zeros(len(of_fit.first), dtype=bool)
    seen[fold::EVERY] = True
    to_fit, to_validate = (_pick(of_fit, np.flatnonzero(mask)) for mask in (~seen, seen))
    if fold != FIRST_FOLD:
        return to_fit, to_validate
    long = problem.windows(joint, LONG)
    return to_fit, _joined(_pick(long, np.flatnonzero(~inside[long.first])), to_validate)


def _folds(
    problem: MotionProblem, fitted: int, joint: int, step: float, length: float | None = None
) -> list[tuple[JointData, JointData]]:
    """Pairs of data to fit and for validation: one where that is enough for validation, else one for each fold."""
    series = problem.series[joint]
    parts = [_divided(problem, fitted, joint, length)]
    if _duration(parts[0][1], series) < ENOUGH:
        parts += [_divided(problem, fitted, joint, length, fold) for fold in range(EVERY) if fold != FIRST_FOLD]
    pairs = [tuple(JointData(series, _thinned(w, series, SAMPLES), step) for w in part) for part in parts]
    return [(fit, seen) for fit, seen in pairs if len(seen.windows.first) and len(fit.windows.first)]


def _duration(windows: Windows, series: JointSeries) -> float:
    return float(np.sum(series.time[windows.last] - series.time[windows.first]))


def with_long_windows(case: JointCase, problem: MotionProblem, fitted: int, joint: int) -> JointCase:
    """The case with windows of `LONG` seconds, in which errors of rest positions have time to add up."""
    (fit, validation), *folds = _folds(problem, fitted, joint, case.fit.step, LONG)
    return replace(case, fit=fit, validation=validation, folds=tuple(folds))


def windows_to_fit(problem: MotionProblem, fitted: int, joint: int, length: float | None = None) -> Windows:
    """All windows of the recordings that may be fitted."""
    windows = problem.windows(joint, length)
    return _pick(windows, np.flatnonzero(_inside(problem, fitted)[windows.first]))


def _pick(windows: Windows, rows: np.ndarray) -> Windows:
    return Windows(windows.first[rows], windows.last[rows], windows.floor[rows], windows.speed[rows])


def _joined(one: Windows, other: Windows) -> Windows:
    return Windows(*(np.concatenate([getattr(w, n) for w in (one, other)]) for n in Windows.__dataclass_fields__))


def encoder_step(q: np.ndarray) -> float:
    """Resolution of the encoder, 1 % quantile of |Δq| > 0 [rad]; of unquantised positions nearly zero."""
    steps = np.abs(np.diff(q))
    steps = steps[steps > 1e-9]
    return float(np.quantile(steps, 0.01)) if steps.size else 0.0


def _first(fit: MotionProblem, joint: int, moving: np.ndarray, servo: NominalServo, reference: float) -> FirstLaw:
    """The law of the equation error; where no load sets its scale, the nominal damping does, or the reference gain."""
    acceleration = np.concatenate(
        [
            np.gradient(fit.speed[r.first : r.last + 1, joint], fit.series[joint].time[r.first : r.last + 1])
            for r in fit.runs
        ]
    )
    found = first_law(fit.series[joint], fit.speed[:, joint], acceleration, moving, reference)
    nominal = servo.laws[joint]
    damping = float(nominal[VISCOUS] + nominal[KD])
    if found.scale_is_likely or not servo.known[joint]:
        return found
    kp = float(nominal[KP])
    if damping > 0.0 and found.law[VISCOUS] > 0.0:
        kp = min(kp, damping * reference / float(found.law[VISCOUS]))
    return replace(found, law=rescaled(found.law, kp / reference))


def rescaled(law: np.ndarray, factor: float) -> np.ndarray:
    """c · law: every torque of the servo multiplied by c, which gives the same motion where there is no load."""
    out = law.copy()
    for name in (
        "kp",
        "kd",
        "ki",
        "back_emf",
        "rotor",
        "viscous",
        "quadratic",
        "coulomb",
        "static",
        "offset",
        "spring",
        "stiffness",
        "twist_damping",
        "load_gain",
    ):
        out[INDEX[name]] *= factor if name != "load_gain" else 1.0
    return out


def _scales(series: JointSeries, speed: np.ndarray, moving: np.ndarray, law: np.ndarray, start: FirstLaw) -> Scales:
    error = float(np.sqrt(np.mean((series.command - series.q) ** 2))) + 1e-9
    driving = series.enabled > 0.5
    asked = (series.gain * (series.command - series.q))[driving]  # γ e, which kp makes a torque
    rms_asked = float(np.sqrt(np.mean(asked**2))) + 1e-9 if driving.any() else error
    rms_speed = float(np.sqrt(np.mean(speed[moving] ** 2))) if moving.any() else 1.0
    kp = float(start.law[KP])
    inertia = float(series.mass.mean() + law[INDEX["rotor"]])
    sample = median_step(series.time)
    return Scales(kp * rms_asked, max(rms_speed, 1e-6), error, max(inertia, 1e-9), sample, kp)


def _thinned(windows: Windows, series: JointSeries, most: int) -> Windows:
    """Windows of at most so many samples: first every second one by decreasing travel, then the others."""
    sizes = windows.last - windows.first
    if sizes.sum() <= most:
        return windows
    travel = np.array([np.ptp(series.q[a : b + 1]) for a, b in zip(windows.first, windows.last, strict=True)])
    by_travel = np.argsort(-travel)
    order = np.concatenate([by_travel[::2], by_travel[1::2][::-1]])
    keep = np.sort(order[: max(1, int(np.searchsorted(np.cumsum(sizes[order]), most)))])
    return _pick(windows, keep)
