"""Recordings in another convention than the model's: signs, units, zeros of joints, columns. Mended before any physics.

No cause in a catalogue turns a torque round or a joint by a right angle, and against such a recording every name would
be nonsense. What a joint's offset, friction and rotor explain is taken off model and recording alike, so that they need
not be right.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import linear_sum_assignment

from lagnet.diagnosis.nominal.mounting import mounting_of
from lagnet.diagnosis.problem.problem import Problem
from lagnet.effects.catalogue import CATALOGUE
from lagnet.effects.inertia.gravity_tilt import GravityTilt
from lagnet.effects.motion import Motion
from lagnet.effects.own_terms import beside_own_terms
from lagnet.errors import DiagnosisError
from lagnet.types import has_regressor, joint_types_of, knows_masses

MISFIT = 0.5  # of some joint's torque power: only then is a convention looked for
LEAST = 0.05  # of a joint's torque: where friction is all but this, there is nothing to compare
MENDED = 0.15  # of that misfit may remain, or the convention is not what is wrong
ALIKE = 0.95  # correlation of recorded and nominal torque that are the same but for a factor
BETTER = 0.5  # of the residual with a mounting and a load: a convention must leave less to be taken for the cause
NO_LINKS = 2.0  # times the residual with all links free, up to which links of one mass are not the cause
SCALES = (0.2, 5.0)  # factors that a wrong torque constant may have
SAMPLES = 1500
RIGHT_ANGLES = (0.0, np.pi / 2, np.pi, -np.pi / 2)


@dataclass(frozen=True)
class Reading:
    """Another convention of one joint: q' = turn · q + zero, τ' = sense · τ; v and a follow q."""

    joint: int
    turn: float = 1.0
    zero: float = 0.0
    sense: float = 1.0

    def apply(self, motion: Motion) -> Motion:
        """The motion and its recorded torque in this convention."""
        q, v, a, tau = (x.copy() for x in (motion.q, motion.v, motion.a, _recorded(motion)))
        q[:, self.joint] = self.turn * q[:, self.joint] + self.zero
        for x, sign in ((v, self.turn), (a, self.turn), (tau, self.sense)):
            x[:, self.joint] *= sign
        return replace(motion, q=q, v=v, a=a, recorded=tau, cache={})

    def mapping(self, name: str) -> list[str]:
        """Lines of a mapping file that state this convention."""
        lines = [f'[scale] "{kind}_{name}" = -1' for kind in ("q", "v", "a") if self.turn < 0]
        lines += [f'[offset] "q_{name}" = {self.zero:.6g}'] if self.zero else []
        return lines + ([f'[scale] "tau_{name}" = -1'] if self.sense < 0 else [])


def refuse_other_conventions(problem: Problem) -> None:
    """Refuses recordings whose torques or positions are the model's but for sign, unit, zero or order.

    Raises:
        DiagnosisError: which columns, and how to map them.
    """
    motion = _few(problem.summary())
    if _misfit(problem, motion).max() < MISFIT:
        return
    most = BETTER * _left_by_physics(problem, motion)
    _refuse_scales(problem, motion, most)
    _refuse_other_order(problem, motion, most)
    readings, misfit = _readings(problem, motion)
    if readings and misfit < most:
        lines = [line for r in readings for line in r.mapping(problem.joints[r.joint])]
        joints = ", ".join(dict.fromkeys(problem.joints[r.joint] for r in readings))
        raise DiagnosisError(
            f"the recordings have another convention than the model at {joints}: sign or zero of its columns",
            next_step=f"if so, map them with --columns: {'; '.join(lines)}",
        )


def _few(motion: Motion) -> Motion:
    rows = slice(None, None, max(1, motion.time.size // SAMPLES))
    time, q, v, a, load, recorded = (
        x[rows] for x in (motion.time, motion.q, motion.v, motion.a, motion.load, _recorded(motion))
    )
    return replace(motion, time=time, q=q, v=v, a=a, load=load, recorded=recorded, cache={})


def _beside_own(motion: Motion, signals: np.ndarray) -> np.ndarray:
    """Signals of shape (n, dof, k), the recorded torque first, after projection on what each joint may add itself.

    All are scaled by the root mean square of the recorded torque so projected.
    """
    signals, least = signals.copy(), LEAST * signals[..., 0].std(axis=0)
    for j in range(motion.n_dof):
        signals[:, j] = beside_own_terms(motion, j, signals[:, j])
        signals[:, j] /= max(float(signals[:, j, 0].std()), float(least[j]), 1e-12)
    return signals


def _torques(problem: Problem, motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """Recorded and nominal torque beside what each joint may add, shapes (n, dof).

    The samples are of several recordings and without order: torque that depends on earlier motion is omitted.
    """
    model = problem.nominal.inverse_dynamics(motion.q, motion.v, motion.a)
    recorded, model = np.moveaxis(_beside_own(motion, np.stack([_recorded(motion), model], axis=2)), 2, 0)
    return recorded, model


def _recorded(motion: Motion) -> np.ndarray:
    assert motion.recorded is not None
    return motion.recorded


def _misfit(problem: Problem, motion: Motion) -> np.ndarray:
    """mean (τ − τ_nominal)² / mean τ² of each joint, shape (dof,)."""
    recorded, model = _torques(problem, motion)
    return np.mean((recorded - model) ** 2, axis=0)


def _left_by_links(problem: Problem, motion: Motion) -> float:
    """Misfit of all joints with any bodies on all links."""
    assert has_regressor(problem.nominal), "a model that knows its masses or has bodies"
    links = [problem.nominal.link_regressor(j, motion.q, motion.v, motion.a) for j in range(motion.n_dof)]
    return _left_by_bodies(problem, motion, np.concatenate(links, axis=2))


def _left_by_physics(problem: Problem, motion: Motion) -> float:
    """Misfit of all joints with the arm mounted as torque asks for and any body on its last link.

    A load turns the torque of a light wrist round as well as a wrong sign does.
    """
    turned = _mounted(problem)
    nominal = turned.nominal
    if not has_regressor(nominal):
        return float(_misfit(turned, motion).sum())
    return _left_by_bodies(turned, motion, nominal.link_regressor(motion.n_dof - 1, motion.q, motion.v, motion.a))


def _left_by_bodies(problem: Problem, motion: Motion, body: np.ndarray) -> float:
    """Misfit of all joints with bodies added, by their regressor, shape (n, dof, k)."""
    model = problem.nominal.inverse_dynamics(motion.q, motion.v, motion.a)
    recorded = _recorded(motion)
    signals = _beside_own(motion, np.concatenate([recorded[..., None], (recorded - model)[..., None], body], axis=2))
    columns, residual = signals[..., 2:].reshape(-1, body.shape[2]), signals[..., 1].ravel()
    fitted, *_ = np.linalg.lstsq(columns, residual, rcond=1e-9)
    return float(np.sum((residual - columns @ fitted) ** 2)) / len(motion.time)


def _mounted(problem: Problem) -> Problem:
    """The problem with the arm on the wall or ceiling that torque shows, if it shows one."""
    mounting, nominal = mounting_of(problem), problem.nominal
    if not mounting or not has_regressor(nominal):
        return problem
    law = CATALOGUE[mounting[0].effect]
    assert isinstance(law, GravityTilt)
    gravity = law.gravity_of(np.asarray(nominal.gravity, dtype=float), mounting[0].values)
    return replace(problem, nominal=nominal.with_gravity(gravity))


def _likeness(problem: Problem, motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """Correlation of the recorded torque of each joint with the nominal one of each, and the factor between them."""
    recorded, model = _torques(problem, motion)
    products = recorded.T @ model / len(model)
    sizes = [np.maximum(np.mean(x**2, axis=0), 1e-300) for x in (recorded, model)]
    return products / np.sqrt(np.outer(*sizes)), products / sizes[1]


def _refuse_other_order(problem: Problem, motion: Motion, most: float) -> None:
    alike, _ = _likeness(problem, motion)
    of_file, of_model = linear_sum_assignment(-alike)
    moved = [j for j, k in zip(of_file, of_model, strict=True) if j != k]
    ordered = _recorded(motion).copy()
    ordered[:, of_model] = _recorded(motion)
    misfit = float(_misfit(problem, replace(motion, recorded=ordered)).sum())
    if moved and misfit < min(most, MENDED * _misfit(problem, motion).sum()):
        listed = ", ".join(f"tau_{problem.joints[j]} is the torque of {problem.joints[of_model[j]]}" for j in moved)
        raise DiagnosisError(
            f"columns of torque are in another order than the model's joints: {listed}",
            next_step="map them with --columns, or put them in order",
        )


def _refuse_scales(problem: Problem, motion: Motion, most: float) -> None:
    alike, factor = (np.diag(x) for x in _likeness(problem, motion))
    off = (alike > ALIKE) & ((factor < SCALES[0]) | (factor > SCALES[1]))
    scaled = replace(motion, recorded=_recorded(motion) / np.where(off, factor, 1.0))
    if not off.any():
        return
    if not knows_masses(problem.nominal):
        most = min(most, NO_LINKS * _left_by_links(problem, motion))
    if _misfit(problem, scaled).sum() < most:
        listed = ", ".join(f"{float(f'{factor[j]:.2g}'):g} at {problem.joints[j]}" for j in np.flatnonzero(off))
        raise DiagnosisError(
            f"recorded torques are far from the model's by a factor: {listed}",
            next_step="are they those of the motors before their gears, or in another unit? map them with --columns:"
            f' [scale] "tau_{problem.joints[int(np.flatnonzero(off)[0])]}" = {float(f"{1 / factor[off][0]:.2g}"):g}',
        )


def _readings(problem: Problem, motion: Motion) -> tuple[list[Reading], float]:
    """Conventions of some joints under which the recordings fit the model, one joint more at a time; none if none do.

    Returns:
        The readings, and the misfit that they leave.
    """
    first = float(_misfit(problem, motion).sum())
    reversed_torque = np.flatnonzero(np.diag(_likeness(problem, motion)[0]) < -ALIKE)
    found = [Reading(int(joint), sense=-1.0) for joint in reversed_torque]
    for reading in found:
        motion = reading.apply(motion)
    misfit = float(_misfit(problem, motion).sum())
    if found and misfit < MENDED * first:
        return found, misfit
    for _ in range(problem.n_dof):
        tried = [(float(_misfit(problem, r.apply(motion)).sum()), r) for r in _others(problem, found)]
        if not tried:
            break
        least, best = min(tried, key=lambda pair: pair[0])
        if least > 0.9 * misfit:
            break
        motion, misfit = best.apply(motion), least
        found.append(best)
        if misfit < MENDED * first:
            return found, misfit
    return [], misfit


def _others(problem: Problem, found: list[Reading]) -> Iterator[Reading]:
    kinds = joint_types_of(problem.nominal, problem.n_dof)
    for joint in set(range(problem.n_dof)) - {r.joint for r in found}:
        for zero in RIGHT_ANGLES if kinds[joint] != "prismatic" else (0.0,):
            for turn in (1.0, -1.0):
                for sense in (1.0, -1.0):
                    if (turn, zero, sense) != (1.0, 0.0, 1.0):
                        yield Reading(joint, turn, zero, sense)
