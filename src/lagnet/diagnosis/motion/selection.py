"""Which effects a joint's motion asks for: added one by one, judged on blocks that were not fitted, against rivals.

Forward: every effect that is not yet there is fitted together with those that are; the one with the largest gain on the
held-out blocks stays if that gain is beyond chance and worth its parameters. Backward: an effect without which the
held-out blocks are predicted as well leaves again. Blocks, not samples, are counted: neighbouring samples share their
error. Source: Shao 1993 (selection by data that were not fitted).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from lagnet.diagnosis.motion.fitting import Fitted, JointData, fit_law, free_coordinates, robust_scale
from lagnet.servos.catalogue import SERVO_CATALOGUE, servo_effect
from lagnet.servos.effect import Scales
from lagnet.servos.parameters import NAMES

BLOCK = 2.0  # [s] of a block of the judge at most
BLOCKS = 40  # that there should be at least
SHORTEST = 0.25  # [s] of a block
QUICK = 4  # iterations of a first look at a candidate
FULL = 12
SHORT_LIST = 3  # candidates that are fitted to the end in every round
MOST_EFFECTS = 10
PLAIN = (
    "gain_error",
    "viscous_friction",
    "coulomb_friction",
    "load_dependent_friction",
    "position_bias",
    "command_delay",
    "rotor_inertia",
)


@dataclass(frozen=True)
class SelectionLimits:
    """What a name on motion must stand.

    Args:
        errors: standard errors over blocks that a gain on held-out motion must exceed.
        gain: least gain of the held-out score, 0.03 for errors 3 % smaller.
        tie: standard errors below which two rivals are tied.
        steps: change of the predicted motion, in floors of the error (half an encoder step), that it must make.
        change: least change of a parameter over its nominal value.
    """

    errors: float = 3.0
    gain: float = 0.03
    tie: float = 2.0
    steps: float = 1.0
    change: float = 0.05


@dataclass(frozen=True, eq=False)
class JointCase:
    """One joint to explain: its fitted and judged motion, nominal law and typical sizes.

    Args:
        fit, judge: data; the judge's windows were not fitted.
        law: the nominal law; start: a law from smoothed motion, with every plain effect in it.
        scale_is_set: whether loads determine torques; else they are known in proportion to kp alone.
        base: law parameters that are always free, those of an estimated servo.
        floor: error below which nothing is asked [rad].
        excited: effects that the motion can show.
    """

    fit: JointData
    judge: JointData
    law: np.ndarray
    start: np.ndarray
    scale_is_set: bool
    base: tuple[tuple[str, ...], ...]
    scales: Scales
    floor: float
    excited: tuple[str, ...]
    limits: SelectionLimits = field(default_factory=SelectionLimits)


@dataclass(frozen=True, eq=False)
class Selection:
    """Effects of one joint and the law fitted with them; `blocks` holds the judge's score by block, (n_blocks,)."""

    effects: tuple[str, ...]
    fitted: Fitted
    blocks: np.ndarray

    @property
    def law(self) -> np.ndarray:
        return self.fitted.law


@dataclass(frozen=True)
class Rejected:
    """An effect that was considered and not named, with the gain on held-out motion that it had."""

    effect: str
    rule: str
    value: float
    limit: float


def sizes_of(scales: Scales) -> dict[str, float]:
    """Typical step of every law parameter."""
    torque, speed = scales.torque, scales.speed
    sizes = dict.fromkeys(NAMES, 0.1 * torque)
    sizes |= {
        "kp": 0.3 * scales.kp,
        "kd": 0.1 * torque / speed,
        "viscous": 0.1 * torque / speed,
        "back_emf": 0.1 * torque / speed,
    }
    sizes |= {"bias": 0.05 * scales.error, "dead_band": 0.1 * scales.error, "delay": scales.sample}
    sizes |= {"rotor": 0.3 * scales.inertia + 1e-4 * scales.kp, "quadratic": 0.1 * torque / speed**2}
    sizes |= {"load_driving": 0.2, "load_driven": 0.2, "load_gain": 0.2, "load_squared": 0.1 / max(torque, 1e-9)}
    return sizes | {"stribeck_speed": 0.2 * speed, "torque_limit": torque}


def groups_of(case: JointCase, effects: Sequence[str]) -> list[tuple[str, ...]]:
    """Law parameters that are free with these effects."""
    groups = list(case.base)
    for name in effects:
        law = servo_effect(name)
        groups += [*law.frees, *((extra,) for extra in law.with_it)]
    taken: set[str] = set()
    out = []
    for group in sorted(dict.fromkeys(groups), key=len):  # one parameter for itself before one that shares
        if not taken & set(group):
            out.append(group)
            taken |= set(group)
    return out


def refit(case: JointCase, effects: Sequence[str], law: np.ndarray, scale: float, iterations: int = FULL) -> Selection:
    """The law fitted with these effects from a start, and its score on the judge's blocks."""
    coordinates = free_coordinates(groups_of(case, effects), law, sizes_of(case.scales))
    fitted = fit_law(case.fit, law, coordinates, scale=scale, iterations=iterations)
    return Selection(tuple(effects), fitted, block_scores(case.judge, fitted.law, case.floor))


def block_scores(data: JointData, law: np.ndarray, floor: float) -> np.ndarray:
    """log of the error's root mean square in each block of about `BLOCK` seconds, not below the floor, (n_blocks,).

    The logarithm lets every block speak in proportion to its own error: a contact that nothing explains does not drown
    the others. It is the log-likelihood of errors whose size differs from block to block.
    """
    squares, out, time = data.errors(law) ** 2, [], data.series.time
    total = float(np.sum(time[data.windows.last] - time[data.windows.first]))
    length = float(np.clip(total / BLOCKS, SHORTEST, BLOCK))
    for first, last in zip(data.windows.first, data.windows.last, strict=True):
        count = max(1, round(float(time[last] - time[first]) / length))
        out += [part.mean() for part in np.array_split(squares[first : last + 1], count)]
    return 0.5 * np.log(np.array(out) + floor**2)


def advantage(without: np.ndarray, with_it: np.ndarray) -> tuple[float, float]:
    """Mean gain of the block scores (0.03: errors 3 % smaller), and that gain in standard errors over blocks."""
    gains = without - with_it
    error = float(np.std(gains) / np.sqrt(len(gains))) + 1e-12
    return float(gains.mean()), float(gains.mean() / error)


def starts_with(case: JointCase, now: Selection, name: str) -> list[np.ndarray]:
    """Laws from which a fit with one more effect starts."""
    effect = servo_effect(name)
    out = []
    for start in effect.starts(replace(case.scales, kp=float(now.law[0]))):
        out.append(effect.apply(now.law, dict(zip([p.name for p in effect.parameters], start, strict=True))))
    return out


def select(case: JointCase) -> tuple[Selection, tuple[Rejected, ...]]:
    """The effects of one joint, and what was considered in the last round and not named."""
    now = _first_selection(case)
    last: tuple[Rejected, ...] = ()
    while len(now.effects) < MOST_EFFECTS:
        scale = robust_scale(now.fitted.residual, case.floor)
        now = refit(case, now.effects, now.law, scale, 2)
        better, last = _best_addition(case, now, scale)
        if better is None:
            break
        now = _less_contained(better, case, scale)
    return _backward(case, now, last)


def _first_selection(case: JointCase) -> Selection:
    """All plain effects together, from the law of the smoothed motion: what is needless leaves later."""
    plain = tuple(n for n in PLAIN if n in case.excited and (case.scale_is_set or n != "gain_error"))
    law = case.law.copy()
    for name in (*plain, *(("gain_error",) if case.base else ())):
        law = servo_effect(name).apply(law, servo_effect(name).read(case.start))
    scale = robust_scale(case.fit.errors(law), case.floor)
    now = refit(case, plain, law, scale)
    return refit(case, plain, now.law, robust_scale(now.fitted.residual, case.floor))


def _candidates(case: JointCase, now: Selection) -> list[str]:
    contained = {c for e in now.effects for c in servo_effect(e).contains}
    return [n for n in SERVO_CATALOGUE if n in case.excited and n not in now.effects and n not in contained]


def _best_addition(case: JointCase, now: Selection, scale: float) -> tuple[Selection | None, tuple[Rejected, ...]]:
    looks = []
    for name in _candidates(case, now):
        tries = [refit(case, (*now.effects, name), start, scale, QUICK) for start in starts_with(case, now, name)]
        looks.append((name, min(tries, key=lambda s: s.fitted.cost)))
    looks.sort(key=lambda pair: pair[1].fitted.cost)
    fitted = [(name, refit(case, look.effects, look.law, scale)) for name, look in looks[:SHORT_LIST]]
    fitted += looks[SHORT_LIST:]
    rejected, best = [], None
    for name, found in fitted:
        gain, errors = advantage(now.blocks, found.blocks)
        if gain < case.limits.gain:
            rejected.append(Rejected(name, "no_holdout_gain", gain, case.limits.gain))
        elif errors < case.limits.errors:
            rejected.append(Rejected(name, "not_significant", errors, case.limits.errors))
        elif best is None or _worth(found) < _worth(best):
            best = found
    return best, tuple(rejected)


def _worth(selection: Selection) -> float:
    """Held-out score with a small charge for every parameter, so that of equals the plainer wins."""
    parameters = sum(len(servo_effect(e).parameters) for e in selection.effects)
    return float(selection.blocks.mean()) + 0.01 * parameters


def _less_contained(now: Selection, case: JointCase, scale: float) -> Selection:
    """Without effects that a later one contains."""
    contained = {c for e in now.effects for c in servo_effect(e).contains}
    kept = tuple(e for e in now.effects if e not in contained)
    return now if kept == now.effects else refit(case, kept, now.law, scale)


def without(case: JointCase, now: Selection, name: str, scale: float) -> Selection:
    """The selection less one effect, its parameters back at the nominal law, the others fitted again."""
    kept = tuple(e for e in now.effects if e != name)
    law, free = now.law.copy(), {p for g in groups_of(case, kept) for p in g}
    for group in groups_of(case, (name,)):
        for parameter in set(group) - free:
            law[NAMES.index(parameter)] = case.law[NAMES.index(parameter)]
    return refit(case, kept, law, scale)


def _backward(case: JointCase, now: Selection, last: tuple[Rejected, ...]) -> tuple[Selection, tuple[Rejected, ...]]:
    """Effects that the others have made needless leave, the most needless first."""
    rejected = list(last)
    while now.effects:
        scale = robust_scale(now.fitted.residual, case.floor)
        now = refit(case, now.effects, now.law, scale)
        faults = [(_fault(case, now, w, e), w) for e in now.effects for w in [without(case, now, e, scale)]]
        worst = min((f for f in faults if f[0][1] is not None), key=lambda f: f[0][0], default=None)
        if worst is None:
            break
        (_, fault), now = worst
        rejected += [] if fault is None else [fault]
    return now, tuple(rejected)


def _fault(case: JointCase, now: Selection, fewer: Selection, name: str) -> tuple[float, Rejected | None]:
    """The gain of an effect on held-out motion, and why it may not be named, None if it may."""
    gain, errors = advantage(fewer.blocks, now.blocks)
    moved = case.judge.predict(np.array([now.law, fewer.law]))
    seen = float(np.sqrt(np.mean((moved[0] - moved[1]) ** 2)))
    change = _relative_change(case, now, name)
    limits = case.limits
    for rule, value, limit in (
        ("no_holdout_gain", gain, limits.gain),
        ("not_significant", errors, limits.errors),
        ("below_resolution", seen, limits.steps * case.floor),
        ("near_nominal", change, limits.change),
    ):
        if value < limit:
            return gain, Rejected(name, rule, value, limit)
    return gain, None


def _relative_change(case: JointCase, now: Selection, name: str) -> float:
    """Largest change of the effect's parameters over their nominal values; infinite from a nominal zero."""
    effect = servo_effect(name)
    before, after = effect.read(case.law), effect.read(now.law)
    sizes = [
        abs(after[n] - before[n]) / abs(before[n]) if before[n] else np.inf for n in before if after[n] != before[n]
    ]
    return float(max(sizes, default=0.0))
