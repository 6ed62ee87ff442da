"""Each named effect against its rivals: replaced by one, all parameters refitted, compared on the same held-out blocks.

A rival that predicts as well is tied; one that predicts better, or as well with fewer effects, replaces the effect. A
rival that contains the effect, or has more parameters, predicts as well by construction and is no tie. A special case
of an effect takes its place where held-out motion does not ask for more, and of two that are tied the one goes first
with which a load could still move the joint.
"""

from __future__ import annotations

from dataclasses import dataclass

from lagnet.diagnosis.motion.joint.block_scores import advantage, beyond_scatter, log10_odds
from lagnet.diagnosis.motion.joint.fitting import robust_scale
from lagnet.diagnosis.motion.joint.joint_case import JointCase
from lagnet.diagnosis.motion.joint.refitting import Selection, refit, starts_with, without
from lagnet.diagnosis.motion.joint.self_locking import holds_every_load
from lagnet.servos.catalogue import SERVO_CATALOGUE, servo_effect

EQUIVALENT = {"viscous_friction": ("gain_error",)}  # observationally equivalent: Fv v and kd v
MOST_SWAPS = 3


@dataclass(frozen=True)
class Comparison:
    """One effect against its rivals.

    Args:
        effect: its name.
        gain: of the held-out score by the effect.
        errors: that gain over its standard error.
        tied: rivals that predict as well.
        best_rival, log10_odds: the rival that predicts best, and the odds of the effect over it.
    """

    effect: str
    gain: float
    errors: float
    tied: tuple[str, ...]
    best_rival: str | None
    log10_odds: float | None


def compare_rivals(case: JointCase, selected: Selection) -> tuple[Selection, tuple[Comparison, ...]]:
    """The selection with effects replaced by rivals that predict better, and one comparison for each effect."""
    for _ in range(MOST_SWAPS):
        results = [_against_rivals(case, selected, effect) for effect in selected.effects]
        swapped = [better for _, better in results if better is not None]
        if not swapped:
            return selected, tuple(comparison for comparison, _ in results)
        selected = min(swapped, key=lambda s: s.blocks.mean())
    return selected, tuple(_against_rivals(case, selected, effect)[0] for effect in selected.effects)


def _against_rivals(case: JointCase, selected: Selection, effect: str) -> tuple[Comparison, Selection | None]:
    scale = robust_scale(selected.fitted.residual, case.floor)
    bare = without(case, selected, effect, scale)
    gain, errors = beyond_scatter(bare.blocks, selected.blocks)
    own = _freedom(effect)
    tied, best, better = [r for r in EQUIVALENT.get(effect, ()) if r not in selected.effects], None, None
    for rival in _rivals(case, selected, effect):
        tries = [refit(case, (*bare.effects, rival), start, scale) for start in starts_with(case, bare, rival)]
        found = min(tries, key=lambda s: s.fitted.cost)
        lead, lead_errors = advantage(found.blocks, selected.blocks)
        if best is None or lead < best[1]:
            best = (rival, lead, lead_errors)
        if _freedom(rival) > own or effect in servo_effect(rival).contains:
            continue
        if rival in servo_effect(effect).contains:  # as good with fewer parameters, or no rival at all
            if _needless(case, found, selected):
                better = found if better is None or found.blocks.mean() < better.blocks.mean() else better
            continue
        if lead_errors < -case.limits.errors and lead < -case.limits.gain:
            better = found if better is None or found.blocks.mean() < better.blocks.mean() else better
        elif lead_errors < case.limits.tie or lead < 0.1 * max(gain, 0.0):
            tied.append(rival)
            if holds_every_load(effect, selected.law) and not holds_every_load(rival, found.law):
                better = found if better is None or found.blocks.mean() < better.blocks.mean() else better
            simpler = _simpler(case, found, scale)
            if len(simpler.effects) < len(selected.effects) and _as_good(case, simpler, selected):
                better = simpler if better is None or simpler.blocks.mean() < better.blocks.mean() else better
    odds = None if best is None else log10_odds(best[2])
    return Comparison(effect, gain, errors, tuple(tied), None if best is None else best[0], odds), better


def _freedom(effect: str) -> int:
    """Parameters that an effect sets free."""
    law = servo_effect(effect)
    return len(law.parameters) + len(law.with_it)


def _simpler(case: JointCase, selected: Selection, scale: float) -> Selection:
    """The selection without the effects that it predicts as well without."""
    for effect in selected.effects:
        fewer = without(case, selected, effect, scale)
        if _as_good(case, fewer, selected):
            return _simpler(case, fewer, scale)
    return selected


def _as_good(case: JointCase, one: Selection, other: Selection) -> bool:
    return advantage(one.blocks, other.blocks)[0] < case.limits.gain


def _needless(case: JointCase, special: Selection, general: Selection) -> bool:
    """Whether held-out motion does not ask for the general law beyond its special case, as selection would."""
    gain, errors = beyond_scatter(special.blocks, general.blocks)
    return gain < case.limits.gain or errors < case.limits.errors


def _rivals(case: JointCase, selected: Selection, effect: str) -> list[str]:
    named = set(servo_effect(effect).confused_with) | {
        n for n, law in SERVO_CATALOGUE.items() if effect in law.confused_with
    }
    contained = {c for e in selected.effects if e != effect for c in servo_effect(e).contains}
    named -= {*selected.effects, *contained}
    others = [e for e in selected.effects if e != effect]
    return [n for n in SERVO_CATALOGUE if n in named & set(case.excited) and servo_effect(n).acts_beside(others)]
