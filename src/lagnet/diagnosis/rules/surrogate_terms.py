"""Effects that a few surrogate terms of no effect replace: E(terms in its place) ≤ limit · E(effect).

A belt between two joints pulls with the angle of the other; the weight of a wrongly modelled link may resemble it, as
weights vary with sines of angles. Where a joint has a residual above the noise, a few terms that belong to no effect in
the catalogue (another joint's angle, friction that changes along the path) replace an effect. If they leave a much
smaller residual, and the effect beside them explains next to nothing, it only imitated them. Only laws that take their
form from the arm's own torque, the speed, or the way that a joint came, are tested: Coulomb and viscous friction,
springs, offsets and rotors are as plain as the terms. Dry friction is among the terms, as the mean of one that changes
along the path.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.diagnosis.regression.normal_equations import scaled_weights
from lagnet.diagnosis.rules.candidate import Candidate, Part
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.effects.catalogue import effect_named

NEW = 1e-3  # of a term's size that must be new beside the terms before it
TURNS = (1, 2, 3)  # of the joint's own angle, along which friction may change
TAUT = np.linspace(0.1, 0.9, 9)  # shares of the samples below the angle at which a cable or a bumper may go taut


@dataclass(frozen=True, eq=False)
class _Side:
    """One joint on fitted or held-out samples.

    Args:
        wanted: shape (n,), mismatch; names: shape (n, effects), torque of each; terms: shape (n, terms).
        noise: power of the joint's noise.
    """

    wanted: np.ndarray
    names: np.ndarray
    terms: np.ndarray
    noise: float

    @property
    def mismatch(self) -> float:
        """Power above the noise."""
        return float(np.mean(self.wanted**2)) - self.noise

    def residual_share(self, columns: np.ndarray, weights: np.ndarray) -> float:
        """(mean |r − X w|² − σ²) over the mismatch, the residual share with columns X of weights w."""
        return (float(np.mean((self.wanted - columns @ weights) ** 2)) - self.noise) / self.mismatch


@final
@dataclass(frozen=True)
class SurrogateTerms(RejectionRule):
    """What a few plain terms leave in the place of an effect, over what the effect leaves.

    Args:
        most_left: residual with the terms over that with the effect, up to which the effect is rejected.
        nothing: of what the effect explained, that it may still add beside the terms.
        material: share of a joint's fitted or held-out mismatch that the effect must explain before it is tested.
        little: residual share of a joint's mismatch, below which a joint that the effect explains confirms it.
    """

    name: ClassVar[str] = "surrogate_terms"
    statement: ClassVar[str] = "plain terms of no effect do not leave much less in the place of the effect"
    source: ClassVar[str] = ""
    together: ClassVar[bool] = True

    most_left: float = 0.5
    nothing: float = 0.1
    material: float = 0.05
    little: float = 0.01

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        asked = [k for k, e in enumerate(candidate.effects) if effect_named(e.effect).plain_terms]
        joints, least = range(candidate.problem.n_dof) if asked else (), candidate.limits.above_noise
        torques = [_torques(candidate, part) for part in ("fit", "holdout")] if asked else []
        unexplained = [j for j in joints if self._is_unexplained(torques, j, candidate.noise[j], least)]
        sides = {j: _sides(candidate.problem, torques, j, candidate.noise[j]) for j in unexplained}
        out = []
        for k in asked if sides else ():
            most = effect_named(candidate.effects[k].effect).plain_terms
            found = [x for j in unexplained if (x := self._replaced(*sides[j], k, most)) is not None]
            if found and not self._explains_elsewhere(torques, k, candidate.noise, least):
                detail = f"{most} plain terms, such as another joint's angle, leave {min(found):.2g} of what it leaves"
                out.append(self.rejection(candidate, candidate.indices[k], min(found), self.most_left, detail))
        return tuple(out)

    def _replaced(self, fit: _Side, unseen: _Side, k: int, most: int) -> float | None:
        """E(terms in the place of effect k) / E(effect k) for up to so many terms; None: they do not replace it."""
        others = [i for i in range(fit.names.shape[1]) if i != k and np.any(fit.names[:, i])]
        kept = (fit.names[:, others], unseen.names[:, others])
        alone = _residual_shares(fit, unseen, *kept)
        name = (fit.names[:, [k]], unseen.names[:, [k]])
        with_name = _residual_shares(fit, unseen, *map(np.hstack, zip(kept, name, strict=True)))
        if np.all(alone - with_name < self.material):
            return None
        for count in range(1, most + 1):
            chosen = _chosen(kept[0], fit.terms, fit.wanted, count)
            placed = [np.hstack([a, b[:, chosen]]) for a, b in zip(kept, (fit.terms, unseen.terms), strict=True)]
            instead = _residual_shares(fit, unseen, *placed)
            beside = _residual_shares(fit, unseen, *map(np.hstack, zip(placed, name, strict=True)))
            needless = np.all(instead - beside <= self.nothing * (alone - with_name))
            if np.all(instead <= self.most_left * with_name) and needless:
                return float(np.max(instead / np.maximum(with_name, 1e-300)))
        return None

    def _is_unexplained(self, torques: list[list[np.ndarray]], joint: int, noise: float, least: float) -> bool:
        """Whether a joint has a residual above the noise and the least share, in the fit or held out."""
        shares = [_shares(side, joint, noise, least) for side in torques]
        return any(above and share > self.little for share, above in shares)

    def _explains_elsewhere(self, torques: list[list[np.ndarray]], k: int, noise: np.ndarray, least: float) -> bool:
        """Whether the effect explains some joint with a negligible residual, in the fit and held out."""

        def explains(side: list[np.ndarray], joint: int) -> bool:
            wanted, residual, named = (side[i][:, joint] for i in (0, 1, k + 2))
            share, above = _shares(side, joint, noise[joint], least)
            gain = float(np.mean((residual + named) ** 2) - np.mean(residual**2))
            settled = share <= self.little or not above
            return settled and gain > self.material * max(float(np.mean(wanted**2)) - noise[joint] ** 2, 0.0) > 0

        return any(all(explains(side, j) for side in torques) for j in range(noise.size))


def _residual_shares(fit: _Side, unseen: _Side, fitted: np.ndarray, there: np.ndarray) -> np.ndarray:
    """Residual shares in the fit and held out of columns with weights of the fit."""
    weights = scaled_weights(fitted, fit.wanted)
    return np.array([fit.residual_share(fitted, weights), unseen.residual_share(there, weights)])


def _torques(candidate: Candidate, part: Part) -> list[np.ndarray]:
    """r of the nominal model, r with all effects, and the torque of each effect, shape (n, dof) each."""
    alone = (candidate.torque(part, e) for e in candidate.effects)
    return [candidate.residual(part, ()), candidate.residual(part), *alone]


def _shares(side: list[np.ndarray], joint: int, noise: float, least: float) -> tuple[float, bool]:
    """Residual share of the mismatch with all effects, and whether the residual is above the noise."""
    before, after = (float(np.mean(x[:, joint] ** 2)) - noise**2 for x in side[:2])
    return (after / before, after > (least**2 - 1.0) * noise**2) if before > 0 else (0.0, False)


def _chosen(kept: np.ndarray, terms: np.ndarray, wanted: np.ndarray, count: int) -> list[int]:
    """Greedy forward selection (orthogonal matching pursuit) of the terms that explain most of the mismatch."""
    chosen: list[int] = []
    size = np.linalg.norm(terms, axis=0)
    for _ in range(count):
        basis = np.linalg.qr(np.hstack([kept, terms[:, chosen]]))[0]
        residual, added = wanted - basis @ (basis.T @ wanted), terms - basis @ (basis.T @ terms)
        new = np.linalg.norm(added, axis=0)
        gain = np.where(new > NEW * size, np.abs(added.T @ residual) / np.where(new > 0, new, 1.0), 0.0)
        chosen.append(int(np.argmax(gain)))
    return chosen


def _sides(problem: Problem, torques: list[list[np.ndarray]], joint: int, noise: float) -> tuple[_Side, _Side]:
    fit, unseen = (
        _Side(side[0][:, joint], np.column_stack([t[:, joint] for t in side[2:]]), terms, noise**2)
        for side, terms in zip(
            torques, (_terms(problem, pieces, joint) for pieces in (problem.fit, problem.holdout)), strict=True
        )
    )
    return fit, unseen


def _terms(problem: Problem, pieces: tuple[Segment, ...], joint: int) -> np.ndarray:
    """Plain terms that belong to no effect, low-passed as torque is, shape (n, terms)."""
    parts = []
    taut = np.quantile(np.concatenate([p.q[:, joint] for p in problem.fit]), TAUT)
    for p in pieces:
        columns = _term_columns(p.q, p.v, np.tanh(p.v / problem.slow), joint)
        table = np.column_stack([*columns, *(np.maximum(p.q[:, joint] - angle, 0.0) for angle in taut)])
        parts.append(problem.reduce(p, table) * p.counts[:, [joint]])
    return np.concatenate(parts)


def _term_columns(q: np.ndarray, v: np.ndarray, sign: np.ndarray, joint: int) -> Iterator[np.ndarray]:
    own, rub = q[:, joint], sign[:, joint]
    yield from (own**2, own**3, v[:, joint] ** 3, rub, rub * own, rub * own**2)
    yield from (rub * wave(n * own) for n in TURNS for wave in (np.sin, np.cos))
    for other in range(q.shape[1]):
        if other != joint:
            angle, speed = q[:, other], v[:, other]
            yield from (angle, np.sin(angle), np.cos(angle), own * angle)
            yield from (speed, sign[:, other], v[:, joint] * speed)
            yield from (rub * angle, rub * np.sin(angle), rub * np.cos(angle))
