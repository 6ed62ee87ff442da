"""What a controller was told at every sample: planned trajectories and nameless arrays brought to the joints' clock."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import linear_sum_assignment

from lagnet.recordings.readers.logs.log_source import held
from lagnet.recordings.readers.ros.extraction import PlannedMotion
from lagnet.recordings.readers.ros.streams import Arrays

FOLLOWS = 0.5  # rms of command minus position over the spread of the position, below which one follows the other
CLEARLY = 0.5  # an assignment of columns to joints must be that much better than the next one, joint by joint
STILL = 0.05  # of the largest spread: joints that move less say nothing of an order
SECOND = 1_000_000_000


def planned_commands(motions: Sequence[PlannedMotion], base: Arrays) -> tuple[np.ndarray, np.ndarray]:
    """Commanded positions and velocities, shape (n, dof), as a trajectory controller makes them of its points.

    From the last command (at first, the measured position) to the first point and on from point to point: straight,
    or by cubic splines where the points have velocities. NaN before the first trajectory.
    """
    n = base.stamps.size
    q, v = np.full((n, len(base.joints)), np.nan), np.full((n, len(base.joints)), np.nan)
    offset = int(np.median(base.stamps - base.received))
    for motion in sorted(motions, key=lambda m: m.start or m.received + offset):
        start = motion.start or motion.received + offset
        first = int(np.searchsorted(base.stamps, start))
        if first >= n:
            continue
        after = (base.stamps[first:] - start) / SECOND
        for k, joint in enumerate(motion.joints):
            if joint not in base.joints:
                continue
            j = base.joints.index(joint)
            measured = base.signals["q"][first, j]
            before = q[first - 1, j] if first and np.isfinite(q[first - 1, j]) else measured
            q[first:, j], v[first:, j] = _along(motion, k, before, after)
    return q, v


def _along(motion: PlannedMotion, k: int, before: float, after: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    times, q = motion.times, motion.q[:, k]
    v = np.zeros(times.size) if motion.v is None else motion.v[:, k]
    if times[0] > 0:
        times, q, v = np.r_[0.0, times], np.r_[before, q], np.r_[0.0, v]
    keep = np.r_[True, np.diff(times) > 0]
    times, q, v = times[keep], q[keep], v[keep]
    inside = np.clip(after, times[0], times[-1])
    if times.size == 1:
        return np.full(after.size, q[0]), np.zeros(after.size)
    over = after > times[-1]
    if motion.v is None:
        slope = np.diff(q) / np.diff(times)
        at = np.clip(np.searchsorted(times, inside, side="right") - 1, 0, slope.size - 1)
        return np.interp(inside, times, q), np.where(over, 0.0, slope[at])
    spline = CubicHermiteSpline(times, q, v)
    return spline(inside), np.where(over, 0.0, spline.derivative()(inside))


def array_commands(topic: str, stamps: np.ndarray, rows: np.ndarray, base: Arrays) -> tuple[dict[str, np.ndarray], str]:
    """Signals of shape (n, dof) from an array without names, and what to tell.

    The kind comes from the topic's name. Positions are assigned to the joints that follow them, where that is
    unambiguous; other kinds, and joints that never move, are taken in the order of the joint states.
    """
    kind = _kind(topic)
    offset = int(np.median(base.stamps - base.received))
    at_samples = held(stamps + offset, rows, base.stamps)
    n_dof = len(base.joints)
    if rows.shape[1] != n_dof:
        return {}, f"{topic} has {rows.shape[1]} numbers a message and no names: not read as commands of {n_dof} joints"
    if kind != "command":
        return {kind: at_samples}, f"{topic} has no joint names: taken in the order of the joint states"
    order = followers(at_samples, base.signals["q"])
    if order is None:
        return {}, f"{topic} has no joint names, and the joints do not follow it: not read as commands"
    named = ", ".join(base.joints[j] for j in order)
    sorted_ = np.empty_like(at_samples)
    sorted_[:, order] = at_samples
    return {kind: sorted_}, f"{topic} has no joint names: assigned to the joints that follow it ({named})"


def _kind(topic: str) -> str:
    if re.search(r"veloc|speed", topic, re.I):
        return "command_velocity"
    if re.search(r"effort|torque|force", topic, re.I):
        return "command_torque"
    return "command"


def followers(commands: np.ndarray, q: np.ndarray) -> list[int] | None:
    """For each column of commands the joint that follows it, or None where no joint does."""
    rows = np.isfinite(commands).all(axis=1)
    if rows.sum() < 3:
        return None
    told, seen = commands[rows], q[rows]
    same = np.arange(q.shape[1])
    miss = np.sqrt(np.mean((told[:, :, None] - seen[:, None, :]) ** 2, axis=0))
    found = linear_sum_assignment(miss)[1]
    spread = seen.std(axis=0)
    moves = spread > STILL * spread.max()

    def follow(order: np.ndarray) -> bool:
        return bool(np.all(miss[same, order] < FOLLOWS * np.where(moves, spread, spread.max())[order]))

    if follow(found) and (_clear(miss, found, moves) or not follow(same)):
        order = found
    else:
        order = same
    return [int(j) for j in order] if follow(order) else None


def _clear(miss: np.ndarray, found: np.ndarray, moves: np.ndarray) -> bool:
    """Whether every column follows its joint much better than any other joint that moves."""
    columns = np.arange(found.size)
    best = miss[columns, found]
    others = np.where(moves, miss, np.inf)
    others[columns, found] = np.inf
    return bool(np.all(best[moves[found]] < CLEARLY * others.min(axis=1)[moves[found]]))
