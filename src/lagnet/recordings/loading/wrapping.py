"""Encoders that show one turn only jump by 2π where a joint passes the end of their scale; the joint does not."""

from __future__ import annotations

import numpy as np

from lagnet.recordings.readers.source import RowNames

TURN = 2 * np.pi
NEAR = 0.1  # a jump must come this near to a whole turn, as a share of it
CALM = 0.25  # share of a turn that ordinary steps must stay under, else jumps cannot be told from fast motion
ORDINARY = 0.99  # quantile of |step| that is called ordinary


def unwrap(
    q: np.ndarray, index: np.ndarray, turning: np.ndarray, joints: tuple[str, ...], rows: RowNames
) -> tuple[np.ndarray, tuple[str, ...]]:
    """Take jumps of a whole turn out of revolute positions; torques do not depend on whole turns.

    Args:
        q: shape (n, dof), positions [rad].
        index: shape (n,), motion of each sample.
        turning: shape (dof,), False for prismatic joints.
        joints: joint names.
        rows: where samples stand in the file.

    Returns:
        Positions without jumps, and what to tell.
    """
    if len(q) < 2:
        return q, ()
    steps = np.diff(q, axis=0) * (np.diff(index) == 0)[:, None]
    jumps = (np.abs(steps) > (1 - NEAR) * TURN) & turning
    if not jumps.any():
        return q, ()
    turns = np.round(steps / TURN) * jumps
    turns *= np.abs(steps - turns * TURN) < NEAR * TURN
    turns *= np.quantile(np.abs(steps), ORDINARY, axis=0) < CALM * TURN
    if not turns.any():
        return q, ()
    told = tuple(
        f"q_{j} ({joints[j]}) jumps by a whole turn {int(np.sum(turns[:, j] != 0))} times, first at"
        f" {rows.of(int(np.flatnonzero(turns[:, j])[0]) + 1)}: the jumps were taken out"
        for j in np.flatnonzero(turns.any(axis=0))
    )
    shift = np.zeros_like(q)
    shift[1:] = np.cumsum(turns, axis=0)
    # Every motion starts on the scale of its file.
    starts = np.flatnonzero(np.r_[True, np.diff(index) != 0])
    shift -= shift[starts][np.cumsum(np.r_[True, np.diff(index) != 0]) - 1]
    return q - TURN * shift, told


def beside(command: np.ndarray, q: np.ndarray, unwrapped: np.ndarray) -> np.ndarray:
    """Commands on the same whole turns as the positions that they were recorded with.

    Args:
        command: shape (n, dof), commanded positions [rad], on the scale of the file.
        q: shape (n, dof), positions as recorded; unwrapped: without jumps of whole turns.
    """
    shift = unwrapped - q
    moved = np.any(shift != 0, axis=0)
    turned = command + shift
    # A command passes the end of the scale some samples before its joint does.
    turned -= TURN * np.round((turned - unwrapped) / TURN)
    return np.where(moved, turned, command)
