"""Axes that the log of a bare arm leaves open, put where the load on the real arm shows them to be.

An arm learned from torque has the right torque and may have axes in the wrong place, where nothing hangs behind them.
A payload would then be told as what it is not: there is no body on the arm as learned that bears on the joints as the
payload does. So the open offsets are fitted together with a body on the last link and with what joints may add by
themselves, and kept where held-out motion is explained better.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import least_squares

from lagnet.diagnosis.problem.problem import Problem, Segment, pose_problem
from lagnet.diagnosis.regression.normal_equations import scaled_weights
from lagnet.effects.motion import Motion
from lagnet.recordings.conditioning.condition import condition
from lagnet.recordings.recording import Recording
from lagnet.recordings.sampling import spread_rows

if TYPE_CHECKING:
    from lagnet.models.serial_chain.open_shape import OpenShape

SAMPLES = 1_000
STARTS = 3
ROUNDS = 2  # of weighing each joint by its residual
USUAL = 0.01  # noise of torque as a share of it, before the residual is known
SPREAD = 0.1  # [m] of the starts
BETTER = 0.99  # of the held-out squared residual: less gain than this is none
RANK = 1e-10


def settle_axis_offsets(
    robot: Any, recordings: Sequence[Recording], holdout: Sequence[Recording], missed: np.ndarray | None, seed: int
) -> Any:
    """The same model, or the arm of the same torque whose axes explain the load on the real one.

    Args:
        robot: any model; all but a learned serial chain are given back as they are.
        recordings, holdout: of the real arm, to fit and to confirm.
        missed: shape (dof,), torque that the model is known to miss [N m]; None: the residual of its training.
        seed: of the starts.
    """
    if not hasattr(robot, "training"):  # not learned: JAX, a fourth of all imports, is not needed for it
        return robot
    from lagnet.models.serial_chain.model import SerialChain
    from lagnet.models.serial_chain.open_shape import OpenShape

    if not isinstance(robot, SerialChain) or robot.n_dof < 2:
        return robot
    if missed is None:
        missed = np.asarray(robot.training.get("noise", np.zeros(robot.n_dof)))
    shape = OpenShape(robot, missed, seed)
    if not shape.sureness.size:
        return robot
    fit = condition(recordings)
    problem = pose_problem(robot, fit, condition(holdout, fit.bandwidth))
    load, unseen = (_Load(shape, _samples(problem, pieces)) for pieces in (problem.fit, problem.holdout))
    move, noise = _fitted(shape, load, np.random.default_rng(seed))
    before, after = (unseen.cost(load.body(at, noise), at, noise) for at in (0.0 * move, move))
    return shape.moved(move) if after < BETTER * before else robot


class _Load:
    """r = τ − τ_nominal after projection on what each joint may add by itself, fitted by a body on the last link."""

    def __init__(self, shape: OpenShape, motion: Motion):
        self._shape, self._motion = shape, motion
        self._bases = [np.linalg.qr(own)[0] for own in _own_columns(motion)]
        assert motion.recorded is not None
        self.usual = USUAL * _noise(motion.load)
        self._lacks = self._less_own((motion.recorded - motion.load)[..., None])

    def _less_own(self, columns: np.ndarray) -> np.ndarray:
        parts = [columns[:, j] - own @ (own.T @ columns[:, j]) for j, own in enumerate(self._bases)]
        return np.stack(parts, axis=1)

    def _columns(self, move: np.ndarray) -> np.ndarray:
        motion = self._motion
        return self._less_own(self._shape.last_link(move, motion.q, motion.v, motion.a))

    def body(self, move: np.ndarray, noise: np.ndarray) -> np.ndarray:
        """argmin_π ‖r − Y_last π‖²: inertial parameters of the best body on the last link, shape (10,)."""
        columns, lacks = ((x / noise[:, None]).reshape(-1, x.shape[-1]) for x in (self._columns(move), self._lacks))
        return scaled_weights(columns, lacks[:, 0], RANK)

    def residual(self, body: np.ndarray, move: np.ndarray) -> np.ndarray:
        """r − Y_last π: residual with this body, shape (n, dof) [N m]."""
        return self._lacks[..., 0] - self._columns(move) @ body

    def cost(self, body: np.ndarray, move: np.ndarray, noise: np.ndarray) -> float:
        """mean (r − Y_last π)² / σ²: mean square residual over the noise variance."""
        return float(np.mean((self.residual(body, move) / noise) ** 2))


def _fitted(shape: OpenShape, load: _Load, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Move of the axes along the open directions, and the root mean square residual of each joint."""
    move = np.zeros(shape.sureness.size)
    noise = load.usual

    def residuals(at: np.ndarray) -> np.ndarray:
        scaled = load.residual(load.body(at, noise), at) / noise
        return np.concatenate([scaled.ravel(), shape.sureness * at, shape.reach(at)])

    for _ in range(ROUNDS):
        starts = [move, *(move + SPREAD * rng.normal(size=(STARTS - 1, move.size)))]
        ends = [least_squares(residuals, start, max_nfev=40) for start in starts]
        move = min(ends, key=lambda end: end.cost).x
        noise = _noise(load.residual(load.body(move, noise), move))
    return move, noise


def _noise(residual: np.ndarray) -> np.ndarray:
    size = np.sqrt(np.mean(residual**2, axis=0))
    return np.maximum(size, 1e-6 * max(float(size.max()), 1e-12))


def _own_columns(motion: Motion) -> list[np.ndarray]:
    """What friction, a rotor, an offset and a gain add to each joint, shape (n, 5) each."""
    ones = np.ones(len(motion.q))
    sign = np.tanh(motion.v / motion.slow)
    parts = (motion.a, motion.v, sign, motion.load)
    return [np.column_stack([ones, *(part[:, j] for part in parts)]) for j in range(motion.q.shape[1])]


def _samples(problem: Problem, pieces: tuple[Segment, ...]) -> Motion:
    """Samples from all over the pieces."""
    seen = replace(problem, fit=pieces).summary()
    rows = spread_rows(len(seen.q), SAMPLES)
    assert seen.recorded is not None
    time, q, v, a, load = (x[rows] for x in (seen.time, seen.q, seen.v, seen.a, seen.load))
    return Motion(time, q, v, a, load, seen.slow, seen.model, seen.recorded[rows], straight=seen.straight)
