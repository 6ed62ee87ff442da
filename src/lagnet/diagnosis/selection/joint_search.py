"""argmax_S −(n / 2g) ln E(S) − Σ_k penalty_k: forward selection of one joint's hypotheses by cross-validation."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from lagnet.diagnosis.regression.cross_validation import NormalEquations, statistical_inefficiency
from lagnet.diagnosis.regression.joint_system import JointSystem, joint_system
from lagnet.diagnosis.settings import DecisionLimits

ROUNDS = 40

Found = TypeVar("Found")


@dataclass(frozen=True, eq=False)
class JointView:
    """Normal equations of one joint after the contributions of arm-wide hypotheses are subtracted.

    Args:
        equations: of the whole arm.
        joint: index.
        system: its normal equations with the residual last, and what was judged on them already.
        inefficiency: samples that make one independent piece of evidence.
        noise_power: squared error that noise alone would leave.
        torque_power: squared torque of the joint, summed over samples.
    """

    equations: NormalEquations
    joint: int
    system: JointSystem
    inefficiency: float
    noise_power: float
    torque_power: float

    @property
    def limits(self) -> DecisionLimits:
        """Where the diagnosis decides."""
        return self.equations.limits

    def error(self, selection: Sequence[int]) -> float:
        """E(S) on blocks left out of the fit [N² m²]."""
        return self.system.judged(selection).error

    def coefficients(self, selection: Sequence[int]) -> np.ndarray:
        """θ of all blocks, in the order of the selection's columns."""
        return self.system.solved(selection)[1]

    def score(self, selection: Sequence[int]) -> float:
        """log P(S) [nats]; −∞ where a coefficient breaks its physical bounds."""
        judged = self.system.judged(selection)
        if not judged.feasible:
            return -np.inf
        evidence = -0.5 * self.pieces * np.log(max(judged.error, self.least_error))
        return float(evidence - self.equations.penalties[list(selection)].sum())

    @property
    def pieces(self) -> float:
        """n / g, independent pieces of evidence."""
        return float(self.equations.samples[self.joint]) / self.inefficiency

    @property
    def least_error(self) -> float:
        """Squared error below which two selections are alike [N² m²]."""
        return max(1e-3 * self.noise_power, 1e-12 * self.torque_power, 1e-300)

    def scores_with_each(self, selection: Sequence[int]) -> np.ndarray:
        """log P(S ∪ {k}) for every hypothesis k of the joint, shape (m,); −∞ where k may not stand beside S."""
        chosen = tuple(sorted(selection))
        return self.remembered(("with each", chosen), lambda: self._scores_with_each(chosen))

    def _scores_with_each(self, selection: tuple[int, ...]) -> np.ndarray:
        errors, feasible = self.system.with_each(selection)
        library = self.equations.library
        local = library.local[self.joint]
        evidence = -0.5 * self.pieces * np.log(np.maximum(errors, self.least_error))
        barred = library.barred[self.joint][:, [local.index(i) for i in selection]].any(axis=1)
        penalties = self.equations.penalties[list(local)] + self.equations.penalties[list(selection)].sum()
        return np.where(feasible & ~barred, evidence - penalties, -np.inf)

    def remembered(self, what: Hashable, make: Callable[[], Found]) -> Found:
        """What `make` finds on this system under these scales, found once."""
        key = (what, self.inefficiency, self.noise_power, self.torque_power)
        if key not in self.system.found:
            self.system.found[key] = make()
        return self.system.found[key]

    def matters(self, selection: Sequence[int], index: int) -> bool:
        """Whether an effect lowers the squared error by enough, compared with E and with the torque, to be claimed."""
        without = self.error([i for i in selection if i != index])
        gain = without - self.error(selection)
        least = float(self.limits.least_power(self.torque_power, self.system.power))
        return gain > max(self.limits.least_share * without, least)

    @property
    def least_gain(self) -> float:
        """r E_nominal: squared error that an effect must explain to be tested beside larger ones [N² m²]."""
        return self.limits.least_of_residual * self.system.power


def view_joint(
    equations: NormalEquations,
    joint: int,
    taken: dict[int, np.ndarray],
    memory: float,
    noise_power: float,
    torque_power: float,
) -> JointView:
    """Normal equations of a joint after the known contributions of arm-wide hypotheses are subtracted."""
    system = joint_system(equations, joint, taken)
    return JointView(equations, joint, system, memory, noise_power, torque_power)


def search_joint(view: JointView, warm: tuple[int, ...] = ()) -> tuple[int, ...]:
    """The best selection found from an empty start, a rich one and a given one."""
    starts = {(), rich_start(view), warm}
    found = [view.remembered(("improved", s), lambda s=s: improve(view, s)) for s in sorted(starts)]
    return max(found, key=lambda s: view.score(s))


def rich_start(view: JointView) -> tuple[int, ...]:
    """A start with every plain hypothesis that is feasible beside the others; superfluous ones are then dropped."""
    return view.remembered("rich", lambda: _rich_start(view))


def _rich_start(view: JointView) -> tuple[int, ...]:
    library = view.equations.library
    selection: tuple[int, ...] = ()
    plain = [i for i in library.local[view.joint] if not library.hypotheses[i].shape]
    errors = dict(zip(library.local[view.joint], view.system.with_each(())[0], strict=True))
    order = sorted(plain, key=lambda i: errors[i])
    for i in order:
        if compatible(view, selection, i) and np.isfinite(view.score((*selection, i))):
            selection = (*selection, i)
    return selection


def improve(view: JointView, start: tuple[int, ...]) -> tuple[int, ...]:
    """Adds, drops and exchanges hypotheses while log P grows."""
    selection, score = start, view.score(start)
    for _ in range(ROUNDS):
        for best_move in (best_plain_move, best_exchange):  # exchanges are many: only where nothing else helps
            best_score, best = best_move(view, selection)
            if best_score > score + 1e-9:
                selection, score = best, best_score
                break
        else:
            break
    return simplify(view, drop_immaterial(view, selection))


def simplify(view: JointView, selection: tuple[int, ...]) -> tuple[int, ...]:
    """Replaces a law by its special case wherever the law hardly lowers the squared error compared with it."""
    library = view.equations.library
    for i in selection:
        for name in library.hypotheses[i].law.contains:
            simple = [k for k in library.local[view.joint] if library.hypotheses[k].effect == name]
            if not simple or simple[0] in selection:
                continue
            other = tuple(simple[0] if k == i else k for k in selection)
            superfluous = not gains_over(view, selection, i, other) or _at_edge(view, i)
            if superfluous and np.isfinite(view.score(other)):
                return simplify(view, other)
    return selection


def gains_over(view: JointView, selection: Sequence[int], index: int, other: Sequence[int]) -> bool:
    """E(special case) − E(law) ≥ max(s E, c · explained): whether a law gains enough over its special case.

    At most the power of the joint's torque about its mean counts as explained: far from rest, a spring is a constant.
    """
    before, after = view.error(selection), view.error(other)
    explained = min(view.error([k for k in selection if k != index]) - before, view.torque_power)
    limits = view.limits
    return after - before >= max(limits.least_share * after, limits.least_over_special_case * explained)


def _at_edge(view: JointView, index: int) -> bool:
    """Whether a law stands at the least value of its shape that was tried: it may be no more than its special case.

    Additional friction close to standstill, for instance, cannot be distinguished there from a blurred sign of v.
    """
    library = view.equations.library
    own = library.hypotheses[index]
    tried = [library.hypotheses[k].shape for k in library.local[view.joint] if library.hypotheses[k].place == own.place]
    return len(tried) > 1 and own.shape == min(tried)


def drop_immaterial(view: JointView, selection: tuple[int, ...]) -> tuple[int, ...]:
    """Drops effects that are too small to be claimed, the smallest first."""
    while True:
        idle = [i for i in selection if not view.matters(selection, i)]
        if not idle:
            return selection
        losses = {i: view.error([k for k in selection if k != i]) for i in idle}
        worst = min(losses, key=lambda i: losses[i])
        selection = tuple(i for i in selection if i != worst)


Move = tuple[float, tuple[int, ...]]
"""A selection with its log P."""


def best_plain_move(view: JointView, selection: tuple[int, ...]) -> Move:
    """The best selection with one hypothesis dropped or added."""
    dropped = [(view.score(s), s) for s in without_each(selection)]
    return max([*dropped, best_addition(view, selection, selection)], key=lambda m: m[0])


def best_exchange(view: JointView, selection: tuple[int, ...]) -> Move:
    """The best selection with one hypothesis in the place of another."""
    found = [best_addition(view, base, selection) for base in without_each(selection)]
    return max(found, key=lambda m: m[0], default=(-np.inf, selection))


def without_each(selection: tuple[int, ...]) -> list[tuple[int, ...]]:
    """Selections with one hypothesis dropped."""
    return [tuple(k for k in selection if k != i) for i in selection]


def best_addition(view: JointView, base: tuple[int, ...], tried: tuple[int, ...]) -> Move:
    """The best selection with one hypothesis added that is none of those tried already."""
    local = view.equations.library.local[view.joint]
    if not local:
        return -np.inf, base
    scores = view.scores_with_each(base).copy()
    scores[[local.index(i) for i in tried]] = -np.inf
    best = int(np.argmax(scores))
    return float(scores[best]), (*base, local[best])


def compatible(view: JointView, selection: Sequence[int], index: int) -> bool:
    """Whether a hypothesis may stand beside the others: not twice the same, nor a law beside its special case."""
    barred = view.equations.library.incompatible_at(view.joint)
    return not any((i, index) in barred for i in selection)


def joint_inefficiency(view: JointView, selection: Sequence[int]) -> float:
    """g, statistical inefficiency of a selection's residual [samples]."""
    columns = view.equations.columns(view.joint, selection)
    return statistical_inefficiency(view.equations, view.joint, columns, view.coefficients(selection))
