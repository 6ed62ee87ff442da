"""Searches for the selection of hypotheses that predicts unseen blocks best, joint by joint."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from lagnet.diagnosis.fitting import Workbench, joint_loss, memory_of, take_off

PRICE = 4.0  # nats that a hypothesis must earn: about the logarithm of the number of rivals at a joint
PRICE_PER_COLUMN = 1.0  # nats more for each coefficient, beyond what unseen blocks already charge
LEAST_SHARE = 0.06  # of the error still there: an effect that takes less off is not claimed
LEAST_TORQUE = 0.0075  # of the joint's torque: effects smaller than this, a quarter of three per cent, are not claimed
LEAST_OF_ALL = 0.0009  # of the nominal error: three per cent of its root mean square
REFINED = 0.002  # of what a law explains: what it must gain over its special case, whose form is never exact
ROUNDS = 40


@dataclass(frozen=True, eq=False)
class JointView:
    """One joint's evidence after contributions from hypotheses that reach all joints were taken off.

    Args:
        bench: the workbench.
        joint: index.
        total, folds: normal equations with the residual last.
        memory: samples that make one independent piece of evidence.
        noise_power: squared error that noise alone would leave.
        torque_power: squared torque of the joint, summed over samples.
    """

    bench: Workbench
    joint: int
    total: np.ndarray
    folds: np.ndarray
    memory: float
    noise_power: float
    torque_power: float
    known: dict[tuple[int, ...], float] = field(default_factory=dict)

    def loss(self, selection: Sequence[int]) -> tuple[float, np.ndarray]:
        """Error on unseen blocks, and coefficients."""
        return joint_loss(self.total, self.folds, self.bench.columns(self.joint, selection))

    def score(self, selection: Sequence[int]) -> float:
        """Log evidence in nats; minus infinity where a coefficient breaks its physical bounds."""
        key = tuple(sorted(selection))
        if key not in self.known:
            self.known[key] = self._score(key)
        return self.known[key]

    def _score(self, selection: Sequence[int]) -> float:
        error, theta = self.loss(selection)
        if not self.feasible(selection, theta):
            return -np.inf
        floor = max(error, 1e-3 * self.noise_power, 1e-12 * self.torque_power, 1e-300)
        evidence = -0.5 * self.bench.samples[self.joint] / self.memory * np.log(floor)
        return evidence - sum(price(self.bench.library.widths[i], self._shaped(i)) for i in selection)

    def feasible(self, selection: Sequence[int], theta: np.ndarray) -> bool:
        """Whether all coefficients lie inside their bounds."""
        at = 0
        for i in selection:
            width = self.bench.library.widths[i]
            h = self.bench.library.hypotheses[i]
            lower, upper = h.law.bounds(dict(h.shape))
            part = theta[at : at + width]
            if np.any(part < lower) or np.any(part > upper):
                return False
            at += width
        return True

    def matters(self, selection: Sequence[int], index: int) -> bool:
        """Whether an effect takes a noticeable part off the error and off the torque."""
        without, _ = self.loss([i for i in selection if i != index])
        with_it, _ = self.loss(selection)
        gain = without - with_it
        return gain > max(LEAST_SHARE * without, LEAST_TORQUE**2 * self.torque_power, self.least_gain)

    @property
    def least_gain(self) -> float:
        """Squared error that an effect must take off to stand beside larger ones."""
        return LEAST_OF_ALL * float(self.total[-1, -1])

    def _shaped(self, index: int) -> int:
        return len(self.bench.library.hypotheses[index].shape)


def price(columns: int, shapes: int) -> float:
    """Nats that a hypothesis costs."""
    return PRICE + PRICE_PER_COLUMN * (columns + shapes)


def view_joint(
    bench: Workbench, joint: int, taken: dict[int, np.ndarray], memory: float, noise_power: float, torque_power: float
) -> JointView:
    """The evidence of a joint with known contributions of far-reaching hypotheses taken off."""
    total, folds = bench.total[joint], bench.folds[joint]
    for index, theta in taken.items():
        columns = bench.columns(joint, [index])
        total, folds = take_off(total, columns, theta), take_off(folds, columns, theta)
    return JointView(bench, joint, total, folds, memory, noise_power, torque_power)


def search_joint(view: JointView, warm: tuple[int, ...] = ()) -> tuple[int, ...]:
    """The best selection found from an empty start, a rich one and a given one."""
    starts = {(), rich_start(view), warm}
    found = [improve(view, s) for s in sorted(starts)]
    return max(found, key=lambda s: view.score(s))


def rich_start(view: JointView) -> tuple[int, ...]:
    """Every plain hypothesis at once that is feasible together: what is superfluous is then dropped."""
    library = view.bench.library
    selection: tuple[int, ...] = ()
    plain = [i for i in library.local[view.joint] if not library.hypotheses[i].shape]
    order = sorted(plain, key=lambda i: view.loss([i])[0])
    for i in order:
        if compatible(view, selection, i) and np.isfinite(view.score((*selection, i))):
            selection = (*selection, i)
    return selection


def improve(view: JointView, start: tuple[int, ...]) -> tuple[int, ...]:
    """Adds, drops and exchanges hypotheses while the evidence grows."""
    selection, score = start, view.score(start)
    for _ in range(ROUNDS):
        for moves in (plain_moves, exchanges):  # exchanges are many: only where nothing else helps
            found = [(view.score(s), s) for s in moves(view, selection)]
            best_score, best = max(found, key=lambda m: m[0], default=(-np.inf, selection))
            if best_score > score + 1e-9:
                selection, score = best, best_score
                break
        else:
            break
    return simplify(view, drop_immaterial(view, selection))


def simplify(view: JointView, selection: tuple[int, ...]) -> tuple[int, ...]:
    """Puts a special case in the place of a law wherever the law gains next to nothing over it."""
    library = view.bench.library
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
    """Whether a law of a selection takes more off the error than the form of its special case in the other may miss."""
    before, after = view.loss(selection)[0], view.loss(other)[0]
    explained = view.loss([k for k in selection if k != index])[0] - before
    return after - before >= max(LEAST_SHARE * after, REFINED * explained)


def _at_edge(view: JointView, index: int) -> bool:
    """Whether a law stands at the least value of its shape that was tried: it may be no more than its special case.

    Friction that is extra close to standstill, for instance, cannot be told there from a sign that noise blurs.
    """
    library = view.bench.library
    own = library.hypotheses[index]
    tried = [library.hypotheses[k].shape for k in library.local[view.joint] if library.hypotheses[k].place == own.place]
    return len(tried) > 1 and own.shape == min(tried)


def drop_immaterial(view: JointView, selection: tuple[int, ...]) -> tuple[int, ...]:
    """Leaves out effects that are too small to be claimed, the smallest first."""
    while True:
        idle = [i for i in selection if not view.matters(selection, i)]
        if not idle:
            return selection
        losses = {i: view.loss([k for k in selection if k != i])[0] for i in idle}
        worst = min(losses, key=lambda i: losses[i])
        selection = tuple(i for i in selection if i != worst)


def plain_moves(view: JointView, selection: tuple[int, ...]) -> list[tuple[int, ...]]:
    """Selections with one hypothesis dropped or added."""
    dropped = [tuple(k for k in selection if k != i) for i in selection]
    return dropped + _with_one_more(view, selection, selection)


def exchanges(view: JointView, selection: tuple[int, ...]) -> list[tuple[int, ...]]:
    """Selections with one hypothesis in the place of another."""
    dropped = [tuple(k for k in selection if k != i) for i in selection]
    return [other for base in dropped for other in _with_one_more(view, base, selection)]


def _with_one_more(view: JointView, base: tuple[int, ...], tried: tuple[int, ...]) -> list[tuple[int, ...]]:
    local = view.bench.library.local[view.joint]
    return [(*base, i) for i in local if i not in tried and compatible(view, base, i)]


def compatible(view: JointView, selection: Sequence[int], index: int) -> bool:
    """Whether a hypothesis may stand beside the others: not twice the same, nor a law beside its special case."""
    library = view.bench.library
    new = library.hypotheses[index]
    for i in selection:
        old = library.hypotheses[i]
        if old.place == new.place or old.effect in new.law.contains or new.effect in old.law.contains:
            return False
        if set(old.law.contains) & set(new.law.contains):
            return False
    return True


def joint_memory(view: JointView, selection: Sequence[int]) -> float:
    """How long the residual of a selection remembers, in samples."""
    columns = view.bench.columns(view.joint, selection)
    _, theta = view.loss(selection)
    return memory_of(view.bench, view.joint, columns, theta)
