"""What is done to sound recordings: one fault of a log each, drawn by a generator, and the words that would name it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.recordings.recording import Recording

Recordings = list[Recording]


@dataclass(frozen=True)
class Corruption:
    """A fault of a log.

    Args:
        name: of the row.
        do: makes it, by a generator of random numbers.
        words: any of which names the cause in a refusal or in a finding; empty where it is to be survived silently.
        survived: whether the right diagnosis is as good an answer as a sentence.
        least_joints: joints that the arm must have.
    """

    name: str
    do: Callable[[Recordings, np.random.Generator], Recordings]
    words: tuple[str, ...]
    survived: bool = False
    least_joints: int = 1


def lost_as_zeros(recordings: Recordings, rng: np.random.Generator) -> Recordings:
    """One to three packets of one file written as zeros."""
    k, rows = _place(recordings, rng, int(rng.integers(1, 4)))
    return _with(recordings, k, rows, q=0.0, v=0.0, tau=0.0)


def lost_as_copies(recordings: Recordings, rng: np.random.Generator) -> Recordings:
    """1 % of the packets of one file written as copies of the one before."""
    k = int(rng.integers(len(recordings)))
    r = recordings[k]
    source = np.arange(len(r))
    for row in np.sort(rng.choice(np.arange(1, len(r)), len(r) // 100, replace=False)):
        source[row] = source[row - 1]
    copied = replace(r.rows(source), time=r.time, trajectory=r.trajectory)
    return [*recordings[:k], copied, *recordings[k + 1 :]]


def zero_cells(recordings: Recordings, rng: np.random.Generator) -> Recordings:
    """Ten cells of positions that are far from zero are zero."""
    out = list(recordings)
    for _ in range(10):
        k, rows = _place(out, rng, 1)
        j = int(np.argmax(np.abs(out[k].q[rows[0]])))
        out = _with_cell(out, k, rows, "q", j, lambda x: 0.0 * x)
    return out


def position_spike(recordings: Recordings, rng: np.random.Generator) -> Recordings:
    """One cell of a position is 8 rad off."""
    k, rows = _place(recordings, rng, 1)
    return _with_cell(recordings, k, rows, "q", _joint(recordings, rng), lambda x: x + 8.0)


def torque_spikes(recordings: Recordings, rng: np.random.Generator) -> Recordings:
    """Three cells of torques far beyond all others."""
    out = list(recordings)
    for _ in range(3):
        k, rows = _place(out, rng, 1)
        j = _joint(out, rng)
        size = 4.0 * float(np.abs(out[k].tau).max())
        out = _with_cell(out, k, rows, "tau", j, lambda x, size=size: x + size)
    return out


def held(recordings: Recordings, rng: np.random.Generator) -> Recordings:
    """Every sample is kept for ten rows."""
    every = 10
    sources = [np.arange(len(r)) // every * every for r in recordings]
    return [
        replace(r.rows(source), time=r.time, trajectory=r.trajectory)
        for r, source in zip(recordings, sources, strict=True)
    ]


def reordered(order: Callable[[tuple[str, ...], np.random.Generator], Sequence[int]]):
    """All columns in another order."""

    def do(recordings: Recordings, rng: np.random.Generator) -> Recordings:
        pick = list(order(recordings[0].joints, rng))
        return [_picked(r, pick) for r in recordings]

    return do


def alphabetical(joints: tuple[str, ...], rng: np.random.Generator) -> Sequence[int]:
    """Columns sorted by the joints' names."""
    return sorted(range(len(joints)), key=lambda i: joints[i])


def backwards(joints: tuple[str, ...], rng: np.random.Generator) -> Sequence[int]:
    """Columns from the last joint to the first."""
    return range(len(joints))[::-1]


def two_exchanged(joints: tuple[str, ...], rng: np.random.Generator) -> Sequence[int]:
    """Two of the first four joints exchanged."""
    i, j = rng.choice(min(4, len(joints)), 2, replace=False)
    order = list(range(len(joints)))
    order[i], order[j] = order[j], order[i]
    return order


def clock(factor: float | None):
    """Time stamps in another unit; None: numbers of samples."""

    def do(recordings: Recordings, rng: np.random.Generator) -> Recordings:
        return [
            replace(r, time=np.arange(len(r), dtype=float) if factor is None else r.time * factor) for r in recordings
        ]

    return do


def in_turns(recordings: Recordings, rng: np.random.Generator) -> Recordings:
    """Positions in turns."""
    turn = 2 * np.pi
    return [replace(r, q=r.q / turn, v=None if r.v is None else r.v / turn) for r in recordings]


def dead_torque(recordings: Recordings, rng: np.random.Generator) -> Recordings:
    """One torque column is zero throughout."""
    j = _joint(recordings, rng)
    return [_column(r, "tau", j, np.zeros(len(r))) for r in recordings]


def stuck_position(recordings: Recordings, rng: np.random.Generator) -> Recordings:
    """One position column keeps its value from the middle of every file on."""
    j = _joint(recordings, rng)
    out = []
    for r in recordings:
        speed = np.abs(np.diff(r.q[:, j]))
        middle = len(r) // 2 + int(np.argmax(speed[len(r) // 2 : len(r) // 2 + len(r) // 8]))
        out.append(_column(r, "q", j, np.where(np.arange(len(r)) < middle, r.q[:, j], r.q[middle, j])))
    return out


def late_torque(recordings: Recordings, rng: np.random.Generator) -> Recordings:
    """Torques 300 ms late."""
    rows = [max(1, round(0.3 * r.rate)) for r in recordings]
    return [
        replace(r, tau=np.roll(r.tau, n, axis=0)).rows(slice(n, None)) for r, n in zip(recordings, rows, strict=True)
    ]


def constant_torque(recordings: Recordings, rng: np.random.Generator) -> Recordings:
    """All torques are one number."""
    return [replace(r, tau=np.ones_like(r.tau)) for r in recordings]


ZEROS, OFF = ("zeros",), ("off the neighbours", "off their curve", "off the curve")
CORRUPTIONS: tuple[Corruption, ...] = (
    Corruption("one dropped packet as zeros", lost_as_zeros, ZEROS, True, 2),
    Corruption("packets as copies", lost_as_copies, ("copies", "repeat"), True),
    Corruption("ten zero cells in q", zero_cells, OFF, True),
    Corruption("one cell of q + 8 rad", position_spike, OFF, True),
    Corruption("three spikes of torque", torque_spikes, OFF, True),
    Corruption("samples held at a tenth of the rate", held, ("held", "measured at"), True),
    Corruption("joints in alphabetical order", reordered(alphabetical), ("order",), False, 3),
    Corruption("joints reversed", reordered(backwards), ("order",), False, 2),
    Corruption("two joints exchanged", reordered(two_exchanged), ("order",), False, 2),
    Corruption("clock in milliseconds", clock(1e3), ("clock",)),
    Corruption("clock in minutes", clock(1 / 60), ("clock",)),
    Corruption("sample numbers for time", clock(None), ("numbers of samples", "clock")),
    Corruption("positions in turns", in_turns, ("turns",)),
    Corruption("a dead torque channel", dead_torque, ("dead",)),
    Corruption("a position sticks half way", stuck_position, ("stuck",)),
    Corruption("torque 300 ms late", late_torque, ("later",)),
    Corruption("constant torque", constant_torque, ("dead",)),
)


def _place(recordings: Recordings, rng: np.random.Generator, n: int) -> tuple[int, np.ndarray]:
    k = int(rng.integers(len(recordings)))
    first = int(rng.integers(20, len(recordings[k]) - 20 - n))
    return k, np.arange(first, first + n)


def _joint(recordings: Recordings, rng: np.random.Generator) -> int:
    moving = np.flatnonzero(np.ptp(recordings[0].q, axis=0) > 0.1 * np.ptp(recordings[0].q, axis=0).max())
    return int(rng.choice(moving))


def _with(recordings: Recordings, k: int, rows: np.ndarray, **values: float) -> Recordings:
    r, changed = recordings[k], {}
    for name, value in values.items():
        if getattr(r, name) is not None:
            changed[name] = getattr(r, name).copy()
            changed[name][rows] = value
    return [*recordings[:k], replace(r, **changed), *recordings[k + 1 :]]


def _with_cell(recordings: Recordings, k: int, rows: np.ndarray, name: str, joint: int, change) -> Recordings:
    r = recordings[k]
    values = getattr(r, name).copy()
    values[rows, joint] = change(values[rows, joint])
    return [*recordings[:k], replace(r, **{name: values}), *recordings[k + 1 :]]


def _column(r: Recording, name: str, joint: int, values: np.ndarray) -> Recording:
    table = getattr(r, name).copy()
    table[:, joint] = values
    return replace(r, **{name: table})


def _picked(r: Recording, pick: list[int]) -> Recording:
    changed = {n: getattr(r, n)[:, pick] for n in ("q", "v", "a", "tau") if getattr(r, n) is not None}
    return replace(r, **changed)
