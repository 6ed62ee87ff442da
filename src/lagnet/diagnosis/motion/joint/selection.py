"""Which effects a joint's motion asks for: forward selection and backward elimination by held-out scores of blocks.

Forward: every effect that is not yet selected is fitted together with those that are; the one of the best held-out
score is selected if its gain is significant and worth its parameters. Backward: an effect without which the held-out
blocks are predicted as well is eliminated. Standard errors are over blocks, not samples, whose errors are correlated.
Source: Shao 1993 (selection by data that were not fitted).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.motion.joint.block_scores import beyond_scatter, block_means
from lagnet.diagnosis.motion.joint.fitting import Fitted, JointData, robust_scale
from lagnet.diagnosis.motion.joint.joint_case import JointCase, SelectionLimits
from lagnet.diagnosis.motion.joint.refitting import Selection, refit, starts_with, without
from lagnet.diagnosis.motion.joint.self_locking import HOLDS, SELF_LOCKING, friction_when_driven
from lagnet.servos.catalogue import SERVO_CATALOGUE, servo_effect

QUICK = 4  # iterations of the first fit of a candidate
SHORT_LIST = 3  # candidates that are fitted to the end in every round
MOST_EFFECTS = 10
EQUAL = 0.005  # of scores: half the penalty of a parameter, so that no count of parameters is overruled
WITHIN_INTERVAL = "within_interval"  # rule: 95 % intervals by the whole arm hold the nominal values
NO_GAIN = "no_holdout_gain"  # rule: held-out motion is predicted as well without
NOT_SIGNIFICANT = "not_significant"  # rule: what it gains there is within its scatter
REMAINDER = "remainder"  # rule: with all names together most of the error remains
NEAR_NOMINAL = "near_nominal"  # rule: values are the nominal ones but for a few percent
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
class Rejected:
    """An effect that was considered and not named, with the rule, its value and its limit."""

    effect: str
    rule: str
    value: float
    limit: float


def select(case: JointCase) -> tuple[Selection, tuple[Rejected, ...]]:
    """The effects of one joint, and those that were considered in the last round and not named."""
    selected = _first_selection(case)
    if not case.base:
        names = (*PLAIN, *(n for n in SERVO_CATALOGUE if n not in PLAIN))
        alone = [_alone(case, name, selected.fitted.scale) for name in names if name in case.excited]
        best = min(map(_penalised_score, (selected, *alone)))
        selected = next(s for s in (selected, *alone) if _penalised_score(s) < best + EQUAL)  # plain ones first
    last: tuple[Rejected, ...] = ()
    while len(selected.effects) < MOST_EFFECTS:
        scale = robust_scale(selected.fitted.residual, case.floor)
        selected = refit(case, selected.effects, selected.law, scale, 2)
        better, last = _best_addition(case, selected, scale)
        if better is None:
            break
        selected = _less_contained(better, case, scale)
    return _backward(case, selected, last)


def _first_selection(case: JointCase) -> Selection:
    """All plain effects together, from the law of the equation error; backward elimination follows."""
    plain = tuple(n for n in PLAIN if n in case.excited)
    law = case.law.copy()
    for name in (*plain, *(("gain_error",) if case.base else ())):
        law = servo_effect(name).apply(law, servo_effect(name).read(case.start))
    scale = robust_scale(case.fit.errors(law), case.floor)
    selected = refit(case, plain, law, scale)
    return refit(case, plain, selected.law, robust_scale(selected.fitted.residual, case.floor))


def _alone(case: JointCase, name: str, scale: float) -> Selection:
    """One effect by itself, from the given law: what has another structure is not found from the plain effects' law.

    Beside it stand those whose parameters it sets free, else it would be selected for what they gain.
    """
    beside = (n for n in case.excited if {g[0] for g in servo_effect(n).frees} <= set(servo_effect(name).with_it))
    effects = (*beside, name)
    start = Selection((), Fitted(case.law, np.inf, np.zeros(0), np.zeros((0, 0)), scale), np.zeros(0))
    tries = [refit(case, effects, law, scale, QUICK) for law in starts_with(case, start, name)]
    best = min(tries, key=lambda s: s.fitted.cost)
    return refit(case, effects, best.law, scale)


def _candidates(case: JointCase, selected: Selection) -> list[str]:
    contained = {c for e in selected.effects for c in servo_effect(e).contains}
    new = [n for n in SERVO_CATALOGUE if n in case.excited and n not in {*selected.effects, *contained}]
    return [n for n in new if servo_effect(n).acts_beside(selected.effects)]


def _best_addition(case: JointCase, selected: Selection, scale: float) -> tuple[Selection | None, tuple[Rejected, ...]]:
    first = []
    for name in _candidates(case, selected):
        effects = (*selected.effects, name)
        tries = [refit(case, effects, start, scale, QUICK) for start in starts_with(case, selected, name)]
        first.append((name, min(tries, key=lambda s: s.fitted.cost)))
    first.sort(key=lambda pair: pair[1].fitted.cost)
    fitted = [(name, refit(case, quick.effects, quick.law, scale)) for name, quick in first[:SHORT_LIST]]
    fitted += first[SHORT_LIST:]
    rejected, best = [], None
    for name, found in fitted:
        if rejection := gains_too_little(name, beyond_scatter(selected.blocks, found.blocks), case.limits):
            rejected.append(rejection)
        elif best is None or _penalised_score(found) < _penalised_score(best):
            best = found
    return best, tuple(rejected)


def gains_too_little(name: str, gain: tuple[float, float], limits: SelectionLimits) -> Rejected | None:
    """An effect whose gain on held-out motion is small or within its scatter; None otherwise.

    Args:
        name: the effect.
        gain: mean of its gain over blocks, and that over its standard error.
        limits: of both.
    """
    if gain[0] < limits.gain:
        return Rejected(name, NO_GAIN, gain[0], limits.gain)
    return Rejected(name, NOT_SIGNIFICANT, gain[1], limits.errors) if gain[1] < limits.errors else None


def _penalised_score(selection: Selection) -> float:
    """Mean held-out score with a small penalty for every parameter: of equal scores the simpler law wins."""
    parameters = sum(len(servo_effect(e).parameters) for e in selection.effects)
    return float(selection.blocks.mean()) + 0.01 * parameters


def _less_contained(selected: Selection, case: JointCase, scale: float) -> Selection:
    """The selection without effects that a later one contains."""
    contained = {c for e in selected.effects for c in servo_effect(e).contains}
    kept = tuple(e for e in selected.effects if e not in contained)
    return selected if kept == selected.effects else refit(case, kept, selected.law, scale)


def _backward(
    case: JointCase, selected: Selection, last: tuple[Rejected, ...]
) -> tuple[Selection, tuple[Rejected, ...]]:
    """Backward elimination of effects that fail a rule, that of the least gain first.

    Before all go effects whose own values are nominal ones: what they gain is by other parameters that they set free
    (static friction frees Coulomb's), beside which the effect that has those for its own seems to gain nothing.
    """
    rejected = list(last)
    while selected.effects:
        scale = robust_scale(selected.fitted.residual, case.floor)
        selected = refit(case, selected.effects, selected.law, scale)
        fewer = [(e, without(case, selected, e, scale)) for e in selected.effects]
        tests = [(_tested(case, selected, w, e), w) for e, w in fewer]
        failed = [(gain, r, w) for (gain, r), w in tests if r is not None]
        if not failed:
            break
        _, rejection, selected = min(failed, key=lambda f: (f[1].rule != NEAR_NOMINAL, f[0]))
        rejected.append(rejection)
    return selected, tuple(rejected)


def _tested(case: JointCase, selected: Selection, fewer: Selection, name: str) -> tuple[float, Rejected | None]:
    """The gain of an effect on held-out motion, and the rule that rejects it, None if none does."""
    gain = beyond_scatter(fewer.blocks, selected.blocks)
    difference = difference_of(case.validation, selected.law, fewer.law, servo_effect(name).starts_alone)
    change = relative_change(case.law, selected.law, name)
    limits = case.limits
    if rejection := gains_too_little(name, gain, limits):
        return gain[0], rejection
    for rule, value, limit in (
        ("below_resolution", difference, limits.steps * case.floor),
        (NEAR_NOMINAL, change, limits.change),
    ):
        if value < limit:
            return gain[0], Rejected(name, rule, value, limit)
    return gain[0], refuted_by_load(case, selected.law, name)


def difference_of(data: JointData, one: np.ndarray, other: np.ndarray, at_moments: bool) -> float:
    """Root mean square of what parts the motion of two laws [rad]; at moments: half of that in one block, if more.

    What acts at moments is a step of the encoder there, and little of one over all.
    """
    predicted = data.predict(np.array([one, other]))
    squares = (predicted[0] - predicted[1]) ** 2
    most = 0.25 * float(block_means(data, squares).max()) if at_moments else 0.0
    return float(np.sqrt(max(float(np.mean(squares)), most)))


def refuted_by_load(case: JointCase, law: np.ndarray, name: str) -> Rejected | None:
    """Friction per load with which the load could never have moved the joint, although it did; None otherwise."""
    value = friction_when_driven(servo_effect(name), law)
    return Rejected(name, SELF_LOCKING, value, HOLDS) if case.moved_by_load and value >= HOLDS else None


def relative_change(nominal: np.ndarray, law: np.ndarray, name: str) -> float:
    """max |p − p₀| / |p₀| over the parameters of an effect, p₀ their nominal values; infinite for p₀ = 0."""
    effect = servo_effect(name)
    before, after = effect.read(nominal), effect.read(law)
    sizes = [
        abs(after[n] - before[n]) / abs(before[n]) if before[n] else np.inf for n in before if after[n] != before[n]
    ]
    return float(max(sizes, default=0.0))
