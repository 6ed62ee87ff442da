"""What real arms leave of their torque after the full correction, and the motion that it belongs to."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from lagnet.diagnosis.identified.fit import identify
from lagnet.diagnosis.identified.remainder.learn import learn_remainder
from lagnet.diagnosis.problem.dry_friction import fit_sign_model
from lagnet.diagnosis.problem.problem import pose_problem
from lagnet.files import write_whole
from lagnet.models.corrected.model import CorrectedModel
from lagnet.recordings.conditioning.condition import condition
from validation.real_arms.layers import Case, cases

ARMS = ("emps", "staubli_tx40", "ur10e", "panda", "ur10")
RATE = 100.0  # [Hz], that of the plants


@dataclass(frozen=True, eq=False)
class Remainder:
    """What one recording of a real arm leaves, at `RATE`.

    Args:
        arm: whose.
        torque: shape (n, dof), over the root mean square of each joint's torque.
        signals: shape (n, 2 dof), speed and acceleration over the largest usual ones of each joint.
    """

    arm: str
    torque: np.ndarray
    signals: np.ndarray

    @property
    def n_dof(self) -> int:
        """Joints of the arm."""
        return int(self.torque.shape[1])


def read_remainders(data: Path, cache: Path) -> tuple[Remainder, ...]:
    """Of all arms; found once, and kept in a file of the run's folder (the data's licences stay with the data)."""
    if not cache.exists():
        every = cases(data)
        found = [r for name in ARMS for r in remainders_of(name, every[name]())]
        held = io.BytesIO()
        parts = {f"{k}_{n}": getattr(r, k) for n, r in enumerate(found) for k in ("torque", "signals")}
        np.savez(held, arms=np.array([r.arm for r in found]), **parts)
        cache.parent.mkdir(parents=True, exist_ok=True)
        write_whole(cache, held.getvalue())
    with np.load(cache, allow_pickle=False) as kept:
        return tuple(Remainder(str(a), kept[f"torque_{n}"], kept[f"signals_{n}"]) for n, a in enumerate(kept["arms"]))


def remainders_of(name: str, case: Case) -> list[Remainder]:
    """Of an arm's recordings, fitted and held out: torque less identified layer less learned remainder."""
    robot, fit_on, held = case
    fit = condition(fit_on)
    problem = fit_sign_model(pose_problem(robot, fit, condition(held, fit.bandwidth)))
    with threadpool_limits(1):
        found = identify(problem, ())
        layer = None if found is None else found.layer
        model = CorrectedModel(robot, (), problem.slow, straight=problem.straight, identified=layer)
        full = replace(model, remainder=learn_remainder(problem, model, 0))
    segments = [*problem.fit, *problem.holdout]
    left = [p.tau - full.torque_along(p.time, p.q, p.v, p.a) for p in segments]
    level = np.sqrt(np.mean(np.concatenate([p.tau for p in segments]) ** 2, axis=0))
    top = usual([p.v for p in segments]), usual([p.a for p in segments])
    out = []
    for p, rest in zip(segments, left, strict=True):
        signals = np.hstack([p.v / top[0], p.a / top[1]])
        out.append(Remainder(name, at_rate(p.time, rest / level), at_rate(p.time, signals)))
    return out


def usual(signals: Sequence[np.ndarray]) -> np.ndarray:
    """98 % of the samples of each column are no larger, shape (columns,)."""
    return np.maximum(np.quantile(np.abs(np.concatenate(signals)), 0.98, axis=0), 1e-9)


def at_rate(time: np.ndarray, signals: np.ndarray) -> np.ndarray:
    """Columns at `RATE`; of several samples in one step the nearest, so that noise keeps its size."""
    grid = np.arange(time[0], time[-1], 1.0 / RATE)
    nearest = np.clip(np.searchsorted(time, grid), 0, len(time) - 1)
    return signals[nearest]
