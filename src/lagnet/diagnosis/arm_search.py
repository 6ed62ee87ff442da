"""Searches for effects that reach all joints together with those that stay at one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.fitting import Fit, Workbench, fit_selection
from lagnet.diagnosis.search import (
    LEAST_OF_ALL,
    LEAST_SHARE,
    LEAST_TORQUE,
    JointView,
    compatible,
    joint_memory,
    price,
    rich_start,
    search_joint,
    view_joint,
)

TRIED = 4  # far-reaching hypotheses that are searched in full at each step
PASSES = 2  # rounds in which far-reaching coefficients and local selections settle
FIRST_MEMORY = 4.0


@dataclass(frozen=True, eq=False)
class Scales:
    """What errors are measured against, each of shape (dof,).

    Args:
        memory: samples that make one independent piece of evidence.
        noise_power: squared error that noise alone would leave, summed over samples.
        torque_power: squared torque, summed over samples.
    """

    memory: np.ndarray
    noise_power: np.ndarray
    torque_power: np.ndarray


@dataclass(frozen=True, eq=False)
class Found:
    """A selection for the whole arm.

    Args:
        far: hypotheses that reach all joints.
        local: for each joint, the hypotheses that stay there.
        score: log evidence [nats].
        fit: coefficients of all of them together.
        scales: what it was judged with.
    """

    far: tuple[int, ...]
    local: tuple[tuple[int, ...], ...]
    score: float
    fit: Fit
    scales: Scales

    @property
    def selection(self) -> tuple[int, ...]:
        """All selected hypotheses."""
        return (*self.far, *(i for own in self.local for i in own))

    def sigma(self, bench: Workbench) -> np.ndarray:
        """Root mean square of what it leaves at each joint, no less than the noise, shape (dof,) [N m]."""
        return np.sqrt(np.maximum(self.fit.sse, self.scales.noise_power) / bench.samples)


def search_arm(
    bench: Workbench, noise_power: np.ndarray, torque_power: np.ndarray, starts: Sequence[Found | None] = (None,)
) -> Found:
    """The best selection that grows from some starts.

    Args:
        noise_power, torque_power: shape (dof,), as in `Scales`.
        starts: selections of the same workbench; None: from nothing.
    """
    scales = Scales(np.full(bench.library.n_dof, FIRST_MEMORY), noise_power, torque_power)
    grown = [_grow(bench, _settle(bench, start.far if start else (), scales, start)) for start in starts]
    alike = replace(scales, memory=np.min([f.scales.memory for f in grown], axis=0))
    return max(grown, key=lambda f: refit_found(bench, replace(f, scales=alike)).score)


def _grow(bench: Workbench, best: Found) -> Found:
    """Local searches, far-reaching hypotheses added while the evidence grows, and dropped where they are not needed."""
    best = _settle(bench, best.far, _remember(bench, best), best)
    while True:
        candidates = _promising(bench, best)
        found = [_settle(bench, (*best.far, i), best.scales, best) for i in candidates]
        better = max(found, key=lambda f: f.score, default=best)
        if better.score <= best.score or not _matters(bench, better, better.far[-1]):
            break
        best = better
    best = _settle(bench, best.far, _remember(bench, best), best)
    return _drop_far(bench, best)


def _remember(bench: Workbench, found: Found) -> Scales:
    """The scales with the memory that the residual of a selection has."""
    views = views_of(bench, found)
    memory = np.array([_least_memory(v, own) for v, own in zip(views, found.local, strict=True)])
    return replace(found.scales, memory=memory)


def _least_memory(view: JointView, own: tuple[int, ...]) -> float:
    """Memory of what even a rich selection leaves: while much is missing, the residual hangs together because of it."""
    rich = (*own, *(i for i in rich_start(view) if i not in own and compatible(view, own, i)))
    return min(joint_memory(view, own), joint_memory(view, rich))


def views_of(bench: Workbench, found: Found) -> list[JointView]:
    """Every joint's evidence after the far-reaching hypotheses were taken off."""
    return _views(bench, {i: found.fit.coefficients[i] for i in found.far}, found.scales)


def _views(bench: Workbench, taken: dict[int, np.ndarray], scales: Scales) -> list[JointView]:
    return [
        view_joint(bench, j, taken, scales.memory[j], scales.noise_power[j], scales.torque_power[j])
        for j in range(bench.library.n_dof)
    ]


def _settle(bench: Workbench, far: tuple[int, ...], scales: Scales, warm: Found | None) -> Found:
    """Local searches under far-reaching hypotheses whose coefficients are fitted together with the local ones."""
    n = bench.library.n_dof
    local = warm.local if warm else tuple(() for _ in range(n))
    sigma = _sigma(bench, warm, scales)
    if far:  # fitted beside everything that could stand at a joint, so that nothing local hides in it
        rich = tuple(_rich(bench, far, scales, j, own) for j, own in enumerate(local))
        taken = _coefficients(bench, far, rich, sigma)
    else:
        taken = {}
    for _ in range(PASSES if far else 1):
        views = _views(bench, taken, scales)
        local = tuple(search_joint(v, own) for v, own in zip(views, local, strict=True))
        taken = _coefficients(bench, far, local, sigma)
    fit = fit_selection(bench, (*far, *(i for own in local for i in own)), sigma)
    return Found(far, local, _score(bench, far, local, fit, scales), fit, scales)


def _rich(bench: Workbench, far: tuple[int, ...], scales: Scales, joint: int, own: tuple[int, ...]) -> tuple[int, ...]:
    view = view_joint(bench, joint, {}, scales.memory[joint], 0.0, scales.torque_power[joint])
    rich = rich_start(view)
    return (*own, *(i for i in rich if i not in own and compatible(view, own, i)))


def _coefficients(bench: Workbench, far: tuple[int, ...], local: Sequence[tuple[int, ...]], sigma: np.ndarray) -> dict:
    if not far:
        return {}
    fit = fit_selection(bench, (*far, *(i for own in local for i in own)), sigma, folds=False)
    return {i: fit.coefficients[i] for i in far}


def _sigma(bench: Workbench, warm: Found | None, scales: Scales) -> np.ndarray:
    power = warm.fit.sse if warm else np.array([t[-1, -1] for t in bench.total])
    least = np.maximum(scales.noise_power, 1e-10 * scales.torque_power)
    return np.sqrt(np.maximum(power, np.maximum(least, 1e-300)) / bench.samples)


def _score(bench: Workbench, far: Sequence[int], local: Sequence[Sequence[int]], fit: Fit, scales: Scales) -> float:
    """Log evidence of a selection, or minus infinity where a far-reaching one breaks physics."""
    library = bench.library
    for i in far:
        h = library.hypotheses[i]
        if not h.law.plausible(fit.coefficients[i], dict(h.shape)):
            return -np.inf
    floor = np.maximum.reduce([fit.sse, 1e-3 * scales.noise_power, 1e-12 * scales.torque_power])
    evidence = -0.5 * np.sum(bench.samples / scales.memory * np.log(np.maximum(floor, 1e-300)))
    chosen = (*far, *(i for own in local for i in own))
    return float(evidence - sum(price(library.widths[i], len(library.hypotheses[i].shape)) for i in chosen))


def refit_found(bench: Workbench, found: Found) -> Found:
    """The same selection with its coefficients and score computed anew."""
    fit = fit_selection(bench, found.selection, _sigma(bench, found, found.scales))
    return replace(found, fit=fit, score=_score(bench, found.far, found.local, fit, found.scales))


def total_score(bench: Workbench, far: tuple[int, ...], found: Found) -> float:
    """Log evidence with other far-reaching hypotheses beside the same local ones."""
    fit = fit_selection(bench, (*far, *(i for own in found.local for i in own)), _sigma(bench, found, found.scales))
    return _score(bench, far, found.local, fit, found.scales)


def _promising(bench: Workbench, best: Found) -> list[int]:
    """The far-reaching hypotheses that take most off the error beside what is already selected."""
    sigma = _sigma(bench, best, best.scales)
    taken = {bench.library.hypotheses[i].place for i in best.far}
    gains = {}
    for i in bench.library.reaching:
        if bench.library.hypotheses[i].place not in taken:
            fit = fit_selection(bench, (*best.selection, i), sigma)
            before, after = (np.maximum(f.sse, 1e-300) for f in (best.fit, fit))  # a joint that rests has no error
            gains[i] = float(np.sum(bench.samples / best.scales.memory * np.log(before / after)))
    return sorted((i for i in gains if gains[i] > 0), key=lambda i: -gains[i])[:TRIED]


def _matters(bench: Workbench, found: Found, index: int) -> bool:
    """Whether a far-reaching hypothesis takes a noticeable part off the error of some joint."""
    sigma = _sigma(bench, found, found.scales)
    without = fit_selection(bench, [i for i in found.selection if i != index], sigma)
    return bool(noticeable(bench, found.scales, without.sse, found.fit.sse).any())


def noticeable(bench: Workbench, scales: Scales, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Joints whose squared error falls by a part that may be claimed, shape (dof,)."""
    nominal = np.array([t[-1, -1] for t in bench.total])
    least = np.maximum(LEAST_TORQUE**2 * scales.torque_power, LEAST_OF_ALL * nominal)
    return before - after > np.maximum(LEAST_SHARE * before, least)


def _drop_far(bench: Workbench, best: Found) -> Found:
    """Leaves out far-reaching hypotheses that the final selection no longer needs."""
    for index in best.far:
        without = _settle(bench, tuple(i for i in best.far if i != index), best.scales, best)
        if without.score >= best.score or not _matters(bench, best, index):
            return _drop_far(bench, without)
    return best
