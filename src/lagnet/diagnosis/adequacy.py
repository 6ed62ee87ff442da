"""Withdraws names whose form does not fit: better no name than a wrong one for physics that is in no catalogue."""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.arm_search import Found
from lagnet.diagnosis.ceiling import find_ceiling, signals_of
from lagnet.diagnosis.evidence_of import HeldOut, held_out_evidence
from lagnet.diagnosis.fitting import Workbench
from lagnet.diagnosis.learned_nominal import may_be_its_error, was_learned
from lagnet.diagnosis.leftover import ABOVE, every_second_part
from lagnet.diagnosis.problem import Piece, Problem
from lagnet.diagnosis.settle import without
from lagnet.effects.effect import Effect
from lagnet.models.corrected import NamedEffect, torque_with

LITTLE = 0.01  # of a joint's mismatch: less, left unexplained, speaks against no name; real arms always leave some
MUCH = 0.05  # of a joint's mismatch: left unexplained above noise, it casts doubt on the names given there
SMOOTH = 0.3  # of what is left that a flexible model predicts, so that it is physics and not disturbance
STANDS = 10.0  # a name stands if it alone explains this many times what is left
MOST = 0.2  # of a joint's mismatch, left unexplained: a name that explains the rest has explained the joint
WORSE = 1.5  # times the nominal error on held-out motion: names that together do that are not the joint's physics
OUTGROWS = 0.5  # of the power that the nominal model is known to miss: what explains less is not told apart from it


def withdraw(
    problem: Problem,
    bench: Workbench,
    unseen: Workbench,
    found: Found,
    effects: tuple[NamedEffect, ...],
    noise: np.ndarray,
    seed: int,
) -> Found:
    """The selection less the names that do not explain the joints they help at.

    A name is held to the joints where it helps, and stands if it is good at one of them: another joint may hold
    physics of its own. What only the held-out motion meets speaks against no name, unless it can be predicted from the
    fitted one. What is smaller than the known ignorance of the nominal model is not told apart from it, and what may be
    the error of a learned one stands only if it explains many times what is left. A joint that
    the names together make worse than the nominal model loses those whose torque there is larger than the mismatch,
    since they cancel each other on the fitted motion alone; a far-reaching one that explains another joint stays.

    Args:
        effects: the selection refitted by the exact laws.
        noise: shape (dof,), noise floor [N m].
    """
    harmed = _harmed(problem, effects, noise)
    shares = _left_shares(problem, problem.holdout, effects, noise)
    fitted = _left_shares(problem, problem.fit, effects, noise)
    both = {j: min(s, fitted.get(j, 0.0)) for j, s in shares.items()}
    needed = {j: s for j, s in both.items() if s > LITTLE}
    if not was_learned(problem.nominal):  # the error of a network is a function of the arm's state, too
        much = {j: s for j, s in shares.items() if s > MUCH}
        needed |= {j: STANDS * s for j, s in _predictable(problem, effects, much, seed).items()}
    doubtful = may_be_its_error(problem, effects)
    if not needed and not harmed and not doubtful and problem.missed is None:
        return found
    ignored = _ignored(problem)
    sigma = found.sigma(bench)
    parts = held_out_evidence(bench, unseen, found, problem.scale, sigma)
    out = found
    for index in found.selection:
        h, part = bench.library.hypotheses[index], parts[index]
        good = any(part.shares[j] >= max(needed.get(j, 0.0), ignored[j]) for j in part.at_joints)
        if (h.effect, h.joint) in doubtful:
            good &= outshines(part, shares, fitted)
        harms = any((h.effect, h.joint) in names for names in harmed.values())
        if not good or (harms and not _stands_elsewhere(h.law, part, {*harmed}, shares)):
            out = without(bench, out, index)
    return out


def outshines(part: HeldOut, *left: dict[int, float]) -> bool:
    """Whether a name explains many times what is left where it does most, both in the fit and held out."""
    most = max(part.at_joints, key=lambda j: part.shares[j])
    return bool(part.shares[most] >= STANDS * max(shares.get(most, 0.0) for shares in left))


def _stands_elsewhere(law: Effect, part: HeldOut, harmed: set[int], shares: dict[int, float]) -> bool:
    """Whether a far-reaching name alone explains a joint that is not harmed: harm may come of another's own physics."""
    explained = (j for j in part.at_joints if j not in harmed and shares.get(j, 0.0) < MOST)
    return law.reaches_all and any(part.shares[j] > 1.0 - MOST for j in explained)


def _ignored(problem: Problem) -> np.ndarray:
    """Share of each joint's held-out mismatch that may be the nominal model's own ignorance, shape (dof,)."""
    if problem.missed is None:
        return np.zeros(problem.n_dof)
    power = np.mean(left_by(problem, problem.holdout, ()) ** 2, axis=0)
    return OUTGROWS * problem.missed**2 / np.maximum(power, 1e-300)


def _harmed(problem: Problem, effects: tuple[NamedEffect, ...], noise: np.ndarray) -> dict[int, list]:
    """Joints that the names make worse on held-out motion, with the names whose torque there exceeds the mismatch."""
    before, after = (np.mean(left_by(problem, problem.holdout, e) ** 2, axis=0) for e in ((), effects))
    worse = np.flatnonzero(after > WORSE * np.maximum(before, noise**2))
    if not worse.size:
        return {}
    alone = {(e.effect, e.joint): _added(problem, e) for e in effects}
    largest = {int(j): max(p[j] for p in alone.values()) for j in worse}
    limits = {j: min(max(before[j], noise[j] ** 2), largest[j]) for j in largest}
    return {j: [name for name, power in alone.items() if power[j] >= limits[j]] for j in largest}


def _added(problem: Problem, effect: NamedEffect) -> np.ndarray:
    """Mean squared torque of one effect on held-out motion, shape (dof,)."""
    left, alone = (left_by(problem, problem.holdout, e) for e in ((), (effect,)))
    return np.mean((left - alone) ** 2, axis=0)


def _left_shares(
    problem: Problem, pieces: tuple[Piece, ...], effects: tuple[NamedEffect, ...], noise: np.ndarray
) -> dict[int, float]:
    """Joints where mismatch is left above the noise, with its share of the joint's mismatch."""
    if not effects:
        return {}
    nominal, left = left_by(problem, pieces, ()), left_by(problem, pieces, effects)
    shares = {}
    for joint in range(problem.n_dof):
        before = float(np.mean(nominal[:, joint] ** 2)) - noise[joint] ** 2
        after = float(np.mean(left[:, joint] ** 2)) - noise[joint] ** 2
        if before > 0 and after > (ABOVE**2 - 1.0) * noise[joint] ** 2:
            shares[joint] = after / before
    return shares


def _predictable(
    problem: Problem, effects: tuple[NamedEffect, ...], shares: dict[int, float], seed: int
) -> dict[int, float]:
    """Those of the joints where what is left depends on the state of the arm, there or in parts of the fit."""
    if not shares:
        return {}
    left = {name: left_by(problem, getattr(problem, name), effects) for name in ("fit", "holdout")}
    seen, fresh = signals_of(problem, problem.fit), signals_of(problem, problem.holdout)
    counts = np.concatenate([p.counts for p in problem.fit])
    one, other = every_second_part(len(counts))

    def depends(j: int) -> bool:
        rest, test = left["fit"][:, j], left["holdout"][:, j]
        if find_ceiling(seen, rest, counts[:, j], fresh, test, seed).share > SMOOTH:
            return True
        halves = seen.only(one), rest[one], counts[one, j], seen.only(other), rest[other]
        return find_ceiling(*halves, seed).share > SMOOTH

    return {j: s for j, s in shares.items() if depends(j)}


def left_by(problem: Problem, pieces: tuple[Piece, ...], effects: tuple[NamedEffect, ...]) -> np.ndarray:
    """Torque that effects leave on all pieces, where it counts, low-passed and decimated, shape (n, dof) [N m]."""
    parts = [problem.reduce(p, p.tau - torque_with(p.motion(problem), effects)) * p.counts for p in pieces]
    return np.concatenate(parts)
