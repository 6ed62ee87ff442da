"""Effects that one sinusoid of time replaces: a pump, a fan or a drive that hums, whatever the arm does.

A disturbance a sin(2πft + φ) moves its joint as well, so that acceleration, speed and position follow it: a rotor, a
friction or a spring explains a part of it. Of a frequency that all recordings share, with amplitude and phase of each
stretch, it leaves next to nothing, and an effect beside it explains nothing more. On motion that is a sinusoid itself
an effect that is there leaves as little, and stays.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from lagnet.diagnosis.regression.normal_equations import left_beside
from lagnet.diagnosis.rules.candidate import Candidate, Part
from lagnet.diagnosis.rules.lack_of_fit import left_shares
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import NamedEffect

PERIODS = 3  # least that the longest stretch must hold
LONGEST, MOST = 2000, 8  # samples of a stretch, and stretches in which the frequency is looked for
FINER, FINEST = 4, 40  # steps of the frequency in 1 / T, T the longest stretch: first, and around the best


@dataclass(frozen=True, eq=False)
class _Left:
    """Mean square residual above the noise at a joint on some motion [N² m²].

    Args:
        without, named: without the effect and with it.
        periodic, both: with a sinusoid in the place of the effect, and with both, the others scaled.
    """

    without: float
    named: float
    periodic: float
    both: float


@final
@dataclass(frozen=True)
class PeriodicDisturbance(RejectionRule):
    """What a sinusoid of time leaves in the place of an effect, over what the effect leaves, fitted and held out.

    Args:
        most_left: residual with the sinusoid over that with the effect, up to which the effect is rejected.
        nothing: of what the effect explained, that it may still add beside the sinusoid.
        little: residual share of a joint's mismatch up to which its effects are not asked.
    """

    name: ClassVar[str] = "periodic_disturbance"
    statement: ClassVar[str] = "a sinusoid of time does not leave much less in the place of the effect"
    source: ClassVar[str] = ""

    most_left: float = 0.5
    nothing: float = 0.1
    little: float = 0.01

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        fitted, held = (left_shares(candidate, part) for part in ("fit", "holdout"))
        unexplained = {j for j, share in fitted.items() if min(share, held.get(j, 0.0)) > self.little}
        for index, effect in zip(candidate.indices, candidate.effects, strict=True):
            joint = effect.joint
            if joint is None or joint not in unexplained or effect_named(effect.effect).reaches_all:
                continue
            found = _in_its_place(candidate, effect, joint)
            if found is not None and all(self._replaces(part) for part in found[1]):
                frequency, ratio = found[0], max(part.periodic / part.named for part in found[1])
                detail = f"a sinusoid of {frequency:.3g} Hz leaves {ratio:.2g} of what it leaves"
                return (self.rejection(candidate, index, ratio, self.most_left, detail),)
        return ()

    def _replaces(self, left: _Left) -> bool:
        """Whether the sinusoid leaves much less than the effect, which explains nothing beside it."""
        needless = left.periodic - left.both <= self.nothing * (left.without - left.named)
        return left.named > 0.0 and left.periodic <= self.most_left * left.named and needless


def _in_its_place(candidate: Candidate, effect: NamedEffect, joint: int) -> tuple[float, tuple[_Left, ...]] | None:
    """The frequency [Hz] of most of what is left of the fitted motion without the effect, and what it leaves there.

    None where the motion is too short for a frequency.
    """
    parts: tuple[Part, Part] = ("fit", "holdout")
    rows = [_rows(candidate, part, effect, joint) for part in parts]
    frequency = _frequency(rows[0][0], rows[0][1][:, :2].sum(axis=1), candidate.problem.bandwidth)
    noise = candidate.noise[joint] ** 2
    return None if frequency is None else (frequency, tuple(_left(*r, frequency, noise) for r in rows))


def _rows(candidate: Candidate, part: Part, effect: NamedEffect, joint: int) -> tuple[list[np.ndarray], np.ndarray]:
    """Times of the samples at which a joint does not rest, in stretches [s]; r, the effect's torque and all others'."""
    pieces = candidate.segments(part)
    valid = np.concatenate([p.counts[:, joint] for p in pieces])
    times = [p.time[p.keep][p.counts[:, joint]] for p in pieces]
    stretches = [t[k : k + LONGEST] for t in times for k in range(0, t.size, LONGEST)]
    columns = [candidate.residual(part)[:, joint], candidate.torques_at(part, effect, joint)]
    return stretches, np.column_stack(columns)[valid]


def _left(stretches: Sequence[np.ndarray], columns: np.ndarray, frequency: float, noise: float) -> _Left:
    named, without = columns[:, 0], columns[:, 0] + columns[:, 1]
    still = _without_waves(stretches, frequency, np.column_stack([without, columns[:, 1:]]))
    periodic, both = (left_beside(still[:, first:], still[:, 0]) for first in (2, 1))
    return _Left(*(max(float(np.mean(r**2)) - noise, 0.0) for r in (without, named, periodic, both)))


def _without_waves(stretches: Sequence[np.ndarray], frequency: float, columns: np.ndarray) -> np.ndarray:
    """Columns (n, k) less their parts in sin and cos of 2πft in each stretch."""
    out, start = columns.copy(), 0
    for time in stretches:
        angle, rows = 2.0 * np.pi * frequency * time, slice(start, start + time.size)
        waves = np.column_stack([np.sin(angle), np.cos(angle)])
        out[rows] = left_beside(waves, columns[rows])
        start += time.size
    return out


def _frequency(stretches: Sequence[np.ndarray], residual: np.ndarray, bandwidth: float) -> float | None:
    """argmax_f Σ over stretches of |Σ r exp(-2πift)|² / n, from a few periods a stretch to the bandwidth."""
    parts = np.split(residual, np.cumsum([t.size for t in stretches])[:-1])
    longest = max((float(np.ptp(t)) for t in stretches), default=0.0)
    if longest * bandwidth <= PERIODS:
        return None

    def best(grid: np.ndarray) -> float:
        power = np.zeros(grid.size)
        for time, r in list(zip(stretches, parts, strict=True))[:MOST]:
            power += np.abs(np.exp(-2j * np.pi * np.outer(grid, time)) @ r) ** 2 / r.size
        return float(grid[np.argmax(power)])

    coarse = best(np.arange(PERIODS / longest, bandwidth, 1.0 / (FINER * longest)))
    return best(coarse + np.arange(-FINEST // FINER, FINEST // FINER + 1) / (FINEST * longest))
