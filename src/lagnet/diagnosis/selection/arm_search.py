"""argmax log P(S) over arm-wide effects together with those of single joints: forward selection for the whole arm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.regression.cross_validation import Fit, NormalEquations, fit_selection
from lagnet.diagnosis.regression.library import Library
from lagnet.diagnosis.selection.joint_search import rich_start, search_joint
from lagnet.diagnosis.selection.joint_view import JointView, compatible, joint_inefficiency, least_error, view_joint

TRIED = 4  # arm-wide hypotheses that are searched in full at each step
PASSES = 2  # alternations between arm-wide coefficients and local selections
FIRST_INEFFICIENCY = 4.0


@dataclass(frozen=True, eq=False)
class Scales:
    """Statistical inefficiency, noise power and torque power of the joints, each of shape (dof,).

    Args:
        inefficiency: g, consecutive samples that make one statistically independent sample.
        noise_power: n σ², squared error of noise alone, summed over samples [N² m²].
        torque_power: n var τ, summed over samples [N² m²].
    """

    inefficiency: np.ndarray
    noise_power: np.ndarray
    torque_power: np.ndarray


@dataclass(frozen=True, eq=False)
class Selection:
    """The set S of selected hypotheses, with coefficients θ and log P(S).

    Args:
        arm_wide: hypotheses that change the torque of several joints.
        local: for each joint, the hypotheses that change its torque alone.
        score: log P(S) [nats].
        fit: coefficients of all of them together.
        scales: with which the score was computed.
    """

    arm_wide: tuple[int, ...]
    local: tuple[tuple[int, ...], ...]
    score: float
    fit: Fit
    scales: Scales

    @property
    def indices(self) -> tuple[int, ...]:
        """All selected hypotheses."""
        return (*self.arm_wide, *(i for own in self.local for i in own))

    def sigma(self, equations: NormalEquations) -> np.ndarray:
        """√(max(E_j, n σ²) / n): root mean square residual of each joint, at least the noise, shape (dof,) [N m]."""
        return np.sqrt(np.maximum(self.fit.sse, self.scales.noise_power) / equations.samples)


def search_arm(
    equations: NormalEquations,
    noise_power: np.ndarray,
    torque_power: np.ndarray,
    starts: Sequence[Selection | None] = (None,),
) -> Selection:
    """argmax_S log P(S) = −Σ_j n_j / (2 g_j) ln E_j(S) − Σ_k penalty_k, by forward selection from several starts.

    Args:
        noise_power, torque_power: shape (dof,), as in `Scales`.
        starts: selections of the same normal equations; None: the empty one.
    """
    scales = Scales(np.full(equations.library.n_dof, FIRST_INEFFICIENCY), noise_power, torque_power)
    grown = [_grow(equations, _settle(equations, start.arm_wide if start else (), scales, start)) for start in starts]
    memory = np.min([f.scales.inefficiency for f in grown], axis=0)
    return max(grown, key=lambda f: score_under(equations, f, memory))


def score_under(equations: NormalEquations, found: Selection, inefficiency: np.ndarray) -> float:
    """log P(S) with g of a given shape (dof,): scores under the g of their own residuals do not compare."""
    return refit_selection(equations, replace(found, scales=replace(found.scales, inefficiency=inefficiency))).score


def _grow(equations: NormalEquations, best: Selection) -> Selection:
    """Local searches; arm-wide hypotheses are added while log P grows, then dropped where log P does not fall."""
    best = _settle(equations, best.arm_wide, _with_inefficiency(equations, best), best)
    while True:
        candidates = _promising(equations, best)
        found = [_settle(equations, (*best.arm_wide, i), best.scales, best) for i in candidates]
        better = max(found, key=lambda f: f.score, default=best)
        if better.score <= best.score or not _matters(equations, better, better.arm_wide[-1]):
            break
        best = better
    best = _settle(equations, best.arm_wide, _with_inefficiency(equations, best), best)
    return _drop_far(equations, best)


def _with_inefficiency(equations: NormalEquations, found: Selection) -> Scales:
    """The scales with the statistical inefficiency g of a selection's residual."""
    views = views_of(equations, found)
    memory = np.array([_least_inefficiency(v, own) for v, own in zip(views, found.local, strict=True)])
    return replace(found.scales, inefficiency=memory)


def _least_inefficiency(view: JointView, own: tuple[int, ...]) -> float:
    """min of g for a selection and a rich one: while effects are missing, they correlate the residual in time."""
    rich = (*own, *(i for i in rich_start(view) if i not in own and compatible(view, own, i)))
    return min(joint_inefficiency(view, own), joint_inefficiency(view, rich))


def views_of(equations: NormalEquations, found: Selection) -> list[JointView]:
    """Normal equations of every joint after the contributions of the arm-wide hypotheses are subtracted."""
    return _views(equations, {i: found.fit.coefficients[i] for i in found.arm_wide}, found.scales)


def _views(equations: NormalEquations, taken: dict[int, np.ndarray], scales: Scales) -> list[JointView]:
    return [
        view_joint(equations, j, taken, scales.inefficiency[j], scales.noise_power[j], scales.torque_power[j])
        for j in range(equations.library.n_dof)
    ]


def _settle(equations: NormalEquations, arm_wide: tuple[int, ...], scales: Scales, warm: Selection | None) -> Selection:
    """Local searches given arm-wide hypotheses, whose coefficients are fitted together with the local ones."""
    n = equations.library.n_dof
    local = warm.local if warm else tuple(() for _ in range(n))
    sigma = _sigma(equations, warm, scales)
    if arm_wide:  # fitted beside all plausible local hypotheses, so that it explains no local effect
        rich = tuple(_rich(equations, arm_wide, scales, j, own) for j, own in enumerate(local))
        taken = _coefficients(equations, arm_wide, rich, sigma)
    else:
        taken = {}
    for _ in range(PASSES if arm_wide else 1):
        views = _views(equations, taken, scales)
        local = tuple(search_joint(v, own) for v, own in zip(views, local, strict=True))
        taken = _coefficients(equations, arm_wide, local, sigma)
    fit = fit_selection(equations, (*arm_wide, *(i for own in local for i in own)), sigma)
    return Selection(arm_wide, local, _score(equations, arm_wide, local, fit, scales), fit, scales)


def _rich(
    equations: NormalEquations, arm_wide: tuple[int, ...], scales: Scales, joint: int, own: tuple[int, ...]
) -> tuple[int, ...]:
    view = view_joint(equations, joint, {}, scales.inefficiency[joint], 0.0, scales.torque_power[joint])
    rich = rich_start(view)
    return (*own, *(i for i in rich if i not in own and compatible(view, own, i)))


def _coefficients(
    equations: NormalEquations, arm_wide: tuple[int, ...], local: Sequence[tuple[int, ...]], sigma: np.ndarray
) -> dict:
    if not arm_wide:
        return {}
    fit = fit_selection(equations, (*arm_wide, *(i for own in local for i in own)), sigma, folds=False)
    return {i: fit.coefficients[i] for i in arm_wide}


def _sigma(equations: NormalEquations, warm: Selection | None, scales: Scales) -> np.ndarray:
    power = warm.fit.sse if warm else np.array([t[-1, -1] for t in equations.total])
    least = np.maximum(scales.noise_power, 1e-10 * scales.torque_power)
    return np.sqrt(np.maximum(power, np.maximum(least, 1e-300)) / equations.samples)


def _score(
    equations: NormalEquations, arm_wide: Sequence[int], local: Sequence[Sequence[int]], fit: Fit, scales: Scales
) -> float:
    """log P(S) = −Σ_j n_j / (2 g_j) ln E_j − Σ_k penalty_k; −∞ where an arm-wide hypothesis is not physical."""
    library = equations.library
    if not all(_is_physical(library, fit, i) for i in arm_wide):
        return -np.inf
    evidence = -0.5 * np.sum(equations.samples / scales.inefficiency * _log_errors(library, fit, scales))
    chosen = (*arm_wide, *(i for own in local for i in own))
    return float(evidence - sum(equations.limits.penalty(*library.freedom[i]) for i in chosen))


def least_counted(library: Library, selection: Sequence[int], scales: Scales) -> np.ndarray:
    """Squared error of each joint below which less is no evidence, shape (dof,) [N² m²].

    A law that follows from the measured torque explains the noise of its joint as well, of which it is made: there it
    is that of the noise.
    """
    floor = least_error(scales.noise_power, scales.torque_power)
    for h in (library.hypotheses[i] for i in selection):
        if h.law.uses_measured_torque and h.joint is not None:
            floor[h.joint] = max(floor[h.joint], scales.noise_power[h.joint])
    return floor


def _log_errors(library: Library, fit: Fit, scales: Scales) -> np.ndarray:
    return np.log(np.maximum(fit.sse, least_counted(library, fit.selection, scales)))


def refit_selection(equations: NormalEquations, found: Selection) -> Selection:
    """The same selection with its coefficients and score computed anew."""
    fit = fit_selection(equations, found.indices, _sigma(equations, found, found.scales))
    return replace(found, fit=fit, score=_score(equations, found.arm_wide, found.local, fit, found.scales))


def total_score(equations: NormalEquations, arm_wide: tuple[int, ...], found: Selection) -> float:
    """log P with other arm-wide hypotheses beside the same local ones."""
    fit = fit_selection(
        equations, (*arm_wide, *(i for own in found.local for i in own)), _sigma(equations, found, found.scales)
    )
    return _score(equations, arm_wide, found.local, fit, found.scales)


def _promising(equations: NormalEquations, best: Selection) -> list[int]:
    """Arm-wide hypotheses of the largest gain ½ Σ_j n_j / g_j ln(E_before / E_after) − penalty, one of each place."""
    library, scales, sigma = equations.library, best.scales, _sigma(equations, best, best.scales)
    taken = {library.hypotheses[i].place for i in best.arm_wide}
    gains = {}
    for i in library.reaching:
        if library.hypotheses[i].place not in taken:
            fit = fit_selection(equations, (*best.indices, i), sigma)
            before, after = (_log_errors(library, f, scales) for f in (best.fit, fit))
            gain = 0.5 * float(np.sum(equations.samples / scales.inefficiency * (before - after)))
            if gain > 0:
                gains[i] = gain - equations.penalties[i]
    likely = {library.hypotheses[i].place: i for i in sorted(gains, key=lambda i: gains[i])}
    return sorted(likely.values(), key=lambda i: -gains[i])[:TRIED]


def _matters(equations: NormalEquations, found: Selection, index: int) -> bool:
    """Whether an arm-wide hypothesis lowers the squared error of some joint by enough to be claimed."""
    sigma = _sigma(equations, found, found.scales)
    without = fit_selection(equations, [i for i in found.indices if i != index], sigma)
    before, after, limits, scales = without.sse, found.fit.sse, equations.limits, found.scales
    law, nominal = equations.library.hypotheses[index].law, np.array([t[-1, -1] for t in equations.total])
    least = limits.least_power_of(law, scales.torque_power, nominal, np.maximum(after, scales.noise_power))
    return bool(np.any(before - after > np.maximum(limits.least_share * before, least)))


def _drop_far(equations: NormalEquations, best: Selection) -> Selection:
    """Drops arm-wide hypotheses without which log P does not fall.

    Where one of them is not physical, the first without which all are; if there is none, that one.
    """
    for index in best.arm_wide:
        without = _without(equations, best, index)
        if without.score > -np.inf and (without.score >= best.score or not _matters(equations, best, index)):
            return _drop_far(equations, without)
    wrong = [i for i in best.arm_wide if not _is_physical(equations.library, best.fit, i)]
    return _drop_far(equations, _without(equations, best, wrong[0])) if wrong else best


def _without(equations: NormalEquations, best: Selection, index: int) -> Selection:
    return _settle(equations, tuple(i for i in best.arm_wide if i != index), best.scales, best)


def _is_physical(library: Library, fit: Fit, index: int) -> bool:
    """Whether the coefficients of a hypothesis are those of something that can be."""
    h = library.hypotheses[index]
    return h.law.plausible(fit.coefficients[index], dict(h.shape))
