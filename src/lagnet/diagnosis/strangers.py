"""Names that plain terms of no effect make needless.

A belt between two joints pulls with the angle of the other; the weight of a link that was drawn wrongly may come close
to it, as weights go with sines of angles. Where a joint is left with physics above the noise, a few terms that belong
to no effect in the catalogue (another joint's angle, friction that changes along the path) are given the place of a
name. If they leave much less than the name did, and the name beside them adds next to nothing, the name was their
likeness. Only laws that take their form from the arm's own torque, or a power of speed, are tried: dry and viscous
friction, springs, offsets and rotors are as plain as the terms.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.adequacy import left_by
from lagnet.diagnosis.arm_search import Found
from lagnet.diagnosis.fitting import Workbench
from lagnet.diagnosis.leftover import ABOVE
from lagnet.diagnosis.problem import Piece, Problem
from lagnet.diagnosis.scaled_fit import scaled_weights
from lagnet.diagnosis.settle import without
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected import NamedEffect

MUCH_LESS = 0.5  # of what the names leave, that the terms may leave
NOTHING = 0.1  # of what the name was thought to explain: beside the terms it adds no more
MATERIAL = 0.05  # of a joint's mismatch that a name explains, so that it is worth asking
LITTLE = 0.01  # of a joint's mismatch: a joint left with less, by a name that matters there, speaks for it
RANK = 1e-9
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

    def left(self, columns: np.ndarray, weights: np.ndarray) -> float:
        """Share of the mismatch that weighted columns leave."""
        return (float(np.mean((self.wanted - columns @ weights) ** 2)) - self.noise) / self.mismatch


def drop_likenesses(
    problem: Problem, bench: Workbench, found: Found, effects: tuple[NamedEffect, ...], noise: np.ndarray
) -> Found:
    """The selection less names that plain terms of no effect make needless.

    Args:
        effects: the selection refitted by the exact laws, in its order.
        noise: shape (dof,), noise floor [N m].
    """
    asked = [k for k, e in enumerate(effects) if effect_named(e.effect).plain_terms]
    if not asked:
        return found
    torques = [_torques(problem, pieces, effects) for pieces in (problem.fit, problem.holdout)]
    joints = [j for j in range(problem.n_dof) if _open(torques, j, noise[j])]
    if not joints:
        return found
    sides = {j: _sides(problem, torques, j, noise[j]) for j in joints}
    out = found
    for k in asked:
        most = effect_named(effects[k].effect).plain_terms
        like = any(_is_likeness(*sides[j], k, most) for j in joints)
        if like and not _speaks_elsewhere(torques, k, noise):
            out = without(bench, out, found.selection[k])
    return out


def _is_likeness(fit: _Side, unseen: _Side, k: int, most: int) -> bool:
    """Whether up to so many terms take the place of name k at this joint."""
    others = [i for i in range(fit.names.shape[1]) if i != k and np.any(fit.names[:, i])]
    kept = (fit.names[:, others], unseen.names[:, others])
    alone = _left(fit, unseen, *kept)
    name = (fit.names[:, [k]], unseen.names[:, [k]])
    with_name = _left(fit, unseen, *map(np.hstack, zip(kept, name, strict=True)))
    if np.any(alone - with_name < MATERIAL):
        return False
    for count in range(1, most + 1):
        chosen = _chosen(kept[0], fit.terms, fit.wanted, count)
        placed = [np.hstack([a, b[:, chosen]]) for a, b in zip(kept, (fit.terms, unseen.terms), strict=True)]
        instead = _left(fit, unseen, *placed)
        beside = _left(fit, unseen, *map(np.hstack, zip(placed, name, strict=True)))
        if np.all(instead <= MUCH_LESS * with_name) and np.all(instead - beside <= NOTHING * (alone - with_name)):
            return True
    return False


def _left(fit: _Side, unseen: _Side, fitted: np.ndarray, there: np.ndarray) -> np.ndarray:
    """Share of the mismatch left on both sides by columns weighted on the first."""
    weights = scaled_weights(fitted, fit.wanted, RANK)
    return np.array([fit.left(fitted, weights), unseen.left(there, weights)])


def _chosen(kept: np.ndarray, terms: np.ndarray, wanted: np.ndarray, count: int) -> list[int]:
    """Terms that take most off the mismatch, one after the other."""
    chosen: list[int] = []
    size = np.linalg.norm(terms, axis=0)
    for _ in range(count):
        basis = np.linalg.qr(np.hstack([kept, terms[:, chosen]]))[0]
        rest, fresh = wanted - basis @ (basis.T @ wanted), terms - basis @ (basis.T @ terms)
        new = np.linalg.norm(fresh, axis=0)
        gain = np.where(new > NEW * size, np.abs(fresh.T @ rest) / np.where(new > 0, new, 1.0), 0.0)
        chosen.append(int(np.argmax(gain)))
    return chosen


def _torques(problem: Problem, pieces: tuple[Piece, ...], effects: tuple[NamedEffect, ...]) -> list[np.ndarray]:
    """Mismatch, what all names leave, and the torque of each, shape (n, dof) each."""
    wanted = left_by(problem, pieces, ())
    alone = (wanted - left_by(problem, pieces, (e,)) for e in effects)
    return [wanted, left_by(problem, pieces, effects), *alone]


def _open(torques: list[list[np.ndarray]], joint: int, noise: float) -> bool:
    """Whether more than a little is left at a joint, above the noise, on both sides."""
    shares = [_shares(side, joint, noise) for side in torques]
    return all(above and share > LITTLE for share, above in shares)


def _shares(side: list[np.ndarray], joint: int, noise: float) -> tuple[float, bool]:
    """Share of the mismatch that the names leave, and whether that is above the noise."""
    before, after = (float(np.mean(x[:, joint] ** 2)) - noise**2 for x in side[:2])
    return (after / before, after > (ABOVE**2 - 1.0) * noise**2) if before > 0 else (0.0, False)


def _speaks_elsewhere(torques: list[list[np.ndarray]], k: int, noise: np.ndarray) -> bool:
    """Whether the name explains some joint of which next to nothing is left, on both sides."""

    def explains(side: list[np.ndarray], joint: int) -> bool:
        wanted, left, named = (side[i][:, joint] for i in (0, 1, k + 2))
        share, above = _shares(side, joint, noise[joint])
        gain = float(np.mean((left + named) ** 2) - np.mean(left**2))
        settled = share <= LITTLE or not above
        return settled and gain > MATERIAL * max(float(np.mean(wanted**2)) - noise[joint] ** 2, 0.0) > 0

    return any(all(explains(side, j) for side in torques) for j in range(noise.size))


def _sides(problem: Problem, torques: list[list[np.ndarray]], joint: int, noise: float) -> tuple[_Side, _Side]:
    fit, unseen = (
        _Side(side[0][:, joint], np.column_stack([t[:, joint] for t in side[2:]]), terms, noise**2)
        for side, terms in zip(
            torques, (_terms(problem, pieces, joint) for pieces in (problem.fit, problem.holdout)), strict=True
        )
    )
    return fit, unseen


def _terms(problem: Problem, pieces: tuple[Piece, ...], joint: int) -> np.ndarray:
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
    yield from (own**2, own**3, v[:, joint] ** 3, rub * own, rub * own**2)
    yield from (rub * wave(n * own) for n in TURNS for wave in (np.sin, np.cos))
    for other in range(q.shape[1]):
        if other != joint:
            angle, speed = q[:, other], v[:, other]
            yield from (angle, np.sin(angle), np.cos(angle), own * angle)
            yield from (speed, sign[:, other], v[:, joint] * speed)
            yield from (rub * angle, rub * np.sin(angle), rub * np.cos(angle))
