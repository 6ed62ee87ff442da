"""What happens for a while only: looked for after the lasting effects, which are then found anew without it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from lagnet.diagnosis.carried_on import carry_on
from lagnet.diagnosis.problem import OVERSAMPLING, Problem, blurred_speed
from lagnet.diagnosis.refit import Refit, refit
from lagnet.diagnosis.sharpness import sharpen
from lagnet.diagnosis.spell_fit import SpellFit, fit_spell
from lagnet.diagnosis.spells import SMEAR, Scan, Spell, find_spells, set_aside, too_much
from lagnet.diagnosis.strands import strands_of
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected import EDGES, NamedEffect

if TYPE_CHECKING:
    from lagnet.diagnosis.inquiry import Inquiry

SUSPECT = 2.0  # times the gain of the next best interval: reason enough to look again without the spell
LOOKS = 3  # rounds in which spells and lasting effects settle
LEFT = 0.25  # of the power inside a spell: where a law leaves more, it is not the law
HELPS = 0.5  # of the error inside a spell that must remain at most, on parts that were not fitted
UNNAMED = 3000.0  # nats of a spell that no law explains, below which it may be a burst of what lasts
ELSEWHERE = (
    10.0  # nats that joints other than the strongest must add: what moves one joint alone is no force on the tool
)
LEAST_ELSEWHERE = 0.01  # of all nats
NOTICED = 0.01  # of the torque: events smaller than this are not claimed


@dataclass(frozen=True, eq=False)
class Passing:
    """One effect that acts on an interval of one recording.

    Args:
        effect: with its interval and recording, refitted together with the lasting effects.
        intervals: 95 % interval of each parameter, t0 and t1 among them.
        fit: how it was chosen.
        share: of the mismatch of all fitted recordings that it explains, 0 to 1.
    """

    effect: NamedEffect
    intervals: dict[str, tuple[float, float]]
    fit: SpellFit
    share: float


def settle_passing(inquiry: Inquiry, again: Callable[[Problem], Inquiry]) -> Inquiry:
    """The inquiry as it is where nothing happens for a while only; else one of what lasts, with the rest named apart.

    Args:
        inquiry: of all samples.
        again: another inquiry into the same recordings with some samples set aside.
    """
    problem = inquiry.problem
    scan = find_spells(problem, inquiry.refit.effects, inquiry.noise, SUSPECT)
    spells, clean = scan.spells, inquiry
    for _ in range(LOOKS):
        if not spells:
            return inquiry
        masked = set_aside(problem, spells)
        if too_much(problem, masked):
            return replace(inquiry, spells=spells)
        clean = again(sharpen(replace(masked, slow=blurred_speed(inquiry.fit), straight=None, held=None)))
        whole = replace(clean.problem, fit=problem.fit, holdout=problem.holdout)
        scan = find_spells(whole, clean.refit.effects, inquiry.noise)
        slack = SMEAR / problem.bandwidth
        if all(any(old.covers(new, slack) for old in spells) for new in scan.spells):
            break
        spells = scan.spells
    found = _named(replace(clean, problem=whole), scan) if scan.spells else inquiry
    return found if found.passing or found.spells else inquiry


def _named(clean: Inquiry, scan: Scan) -> Inquiry:
    """Fits every spell of a fitted recording, and takes those that a law explains to the lasting effects."""
    lasting = clean.refit.effects
    pairs = [(s, fit_spell(clean.problem, lasting, s, scan)) for s in scan.spells if not s.held_out]
    good = [(s, f) for s, f in pairs if _convinces(f)]
    bursts = _bursts(pairs)
    others = (s for s in scan.spells if not any(s is t for t in (*bursts, *(t for t, _ in good))))
    nameless = tuple(s for s in others if s.held_out or s.gain > UNNAMED)
    together = _refitted_together(set_aside(clean.problem, nameless), clean, [f for _, f in good])
    n = len(lasting)
    found = []
    for effect, intervals, (spell, fit) in zip(together.effects[n:], together.intervals[n:], good, strict=True):
        wide = _widened(intervals, _caution(fit, scan.inflation), clean.problem.rate)
        if effect_named(effect.effect).is_determined(wide):
            found.append(Passing(effect, wide, fit, 0.0))
        elif spell.gain > UNNAMED:
            nameless = (*nameless, spell)
    rest = Refit(together.effects[:n], together.intervals[:n], together.correlations)
    shares = _shares(clean.problem, rest.effects, [p.effect for p in found])
    shared = [replace(p, share=s) for p, s in zip(found, shares, strict=True)]
    passing, nameless = carry_on(clean.problem, shared, nameless)
    return replace(clean, refit=rest, passing=passing, spells=nameless)


def _refitted_together(problem: Problem, clean: Inquiry, fits: Sequence[SpellFit]) -> Refit:
    """All parameters at once, what lasts and what passes, on all samples but those that have no name."""
    power = np.maximum(clean.found.fit.sse, clean.found.scales.noise_power)
    effects = (*clean.refit.effects, *(f.effect for f in fits))
    return refit(problem, effects, np.sqrt(power / clean.bench.samples))


def _convinces(fit: SpellFit) -> bool:
    gain = fit.without - fit.with_it
    return fit.left < LEFT and fit.with_it < HELPS * fit.without and gain > NOTICED**2 and not _local(fit)


def _local(fit: SpellFit) -> bool:
    """Whether one joint alone speaks for the law: a force or a load on the last link moves others, too."""
    return fit.elsewhere < max(ELSEWHERE, LEAST_ELSEWHERE * float(np.sum(fit.gains)))


def _bursts(pairs: Sequence[tuple[Spell, SpellFit]]) -> list[Spell]:
    """Spells that come again at one joint alone: lasting physics there, seen only where the arm goes now and then."""
    local = [(s, f.strongest) for s, f in pairs if _local(f)]
    joints = [j for _, j in local]
    return [s for s, j in local if joints.count(j) > 1]


def _widened(intervals: dict[str, tuple[float, float]], factor: float, rate: float) -> dict[str, tuple[float, float]]:
    """Wider intervals, where what is left hangs together and a spell has too few blocks to show it.

    The first sample inside may come up to one sample after the start, and the last one before the end.
    """
    out = {}
    for name, (low, high) in intervals.items():
        grown = 0.5 * (factor - 1.0) * (high - low)
        before, after = (1.0 / rate if name == edge else 0.0 for edge in EDGES)
        out[name] = (low - grown - before, high + grown + after)
    return out


def _caution(fit: SpellFit, inflation: float) -> float:
    """By how much intervals grow: the samples are no more independent than the filter and the residual let them be."""
    return float(np.sqrt(0.5 * OVERSAMPLING * inflation * max(1.0, fit.over_usual)))


def _shares(problem: Problem, lasting: Sequence[NamedEffect], passing: Sequence[NamedEffect]) -> list[float]:
    """Power that each explains, over that of the nominal residual, joints weighted by their torque."""
    nominal = _power(problem, ())
    with_all = _power(problem, (*lasting, *passing))
    return [
        float(
            np.clip((_power(problem, (*lasting, *(p for p in passing if p is not e))) - with_all) / nominal, 0.0, 1.0)
        )
        for e in passing
    ]


def _power(problem: Problem, effects: Sequence[NamedEffect]) -> float:
    strands = strands_of(problem, problem.fit, effects)
    return max(float(sum(np.sum((s.rest * s.counts / problem.scale) ** 2) for s in strands)), 1e-300)
