"""Withdraws names whose form does not fit: better no name than a wrong one for physics that is in no catalogue."""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.arm_search import Found
from lagnet.diagnosis.ceiling import find_ceiling, signals_of
from lagnet.diagnosis.evidence_of import held_out_evidence
from lagnet.diagnosis.fitting import Workbench
from lagnet.diagnosis.problem import Problem
from lagnet.diagnosis.settle import without
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected import NamedEffect, torque_with

MUCH = 0.05  # of a joint's mismatch: left unexplained above noise, it casts doubt on the names given there
SMOOTH = 0.3  # of what is left that a flexible model predicts, so that it is physics and not disturbance
STANDS = 10.0  # a name stands if it alone explains this many times what is left
MOST = 0.2  # of a joint's mismatch, left unexplained: there a name must explain more than that, predictable or not


def withdraw(
    problem: Problem,
    bench: Workbench,
    unseen: Workbench,
    found: Found,
    effects: tuple[NamedEffect, ...],
    noise: np.ndarray,
    seed: int,
) -> Found:
    """The selection less the local effects of joints where much is left that depends on the state of the arm.

    Args:
        effects: the selection refitted by the exact laws.
        noise: shape (dof,), noise floor [N m].
    """
    shares = _left_shares(problem, effects, noise)
    needed = {j: s for j, s in shares.items() if s > MOST}
    needed |= {j: STANDS * s for j, s in _predictable(problem, effects, shares, seed).items()}
    if not needed:
        return found
    sigma = np.sqrt(np.maximum(found.fit.sse, found.scales.noise_power) / bench.samples)
    parts = held_out_evidence(bench, unseen, found, problem.scale, sigma)
    for index in found.selection:
        h = bench.library.hypotheses[index]
        if h.joint is None or effect_named(h.effect).reaches_all:
            continue
        if h.joint in needed and parts[index].share < needed[h.joint]:
            found = without(bench, found, index)
    return found


def _left_shares(problem: Problem, effects: tuple[NamedEffect, ...], noise: np.ndarray) -> dict[int, float]:
    """Joints where much mismatch is left above the noise on held-out motion, with its share of the joint's mismatch."""
    if not effects:
        return {}
    nominal, left = _stack(problem, problem.holdout, ()), _stack(problem, problem.holdout, effects)
    shares = {}
    for joint in range(problem.n_dof):
        before = float(np.mean(nominal[:, joint] ** 2)) - noise[joint] ** 2
        after = float(np.mean(left[:, joint] ** 2)) - noise[joint] ** 2
        if before > 0 and after > MUCH * before:
            shares[joint] = after / before
    return shares


def _predictable(
    problem: Problem, effects: tuple[NamedEffect, ...], shares: dict[int, float], seed: int
) -> dict[int, float]:
    """Those of the joints where what is left depends on the state of the arm."""
    if not shares:
        return {}
    left = {name: _stack(problem, getattr(problem, name), effects) for name in ("fit", "holdout")}
    seen, fresh = signals_of(problem, problem.fit), signals_of(problem, problem.holdout)
    counts = np.concatenate([p.counts for p in problem.fit])
    return {
        j: s
        for j, s in shares.items()
        if find_ceiling(seen, left["fit"][:, j], counts[:, j], fresh, left["holdout"][:, j], seed).share > SMOOTH
    }


def _stack(problem: Problem, pieces: tuple, effects: tuple[NamedEffect, ...]) -> np.ndarray:
    parts = [problem.reduce(p, p.tau - torque_with(p.motion(problem), effects)) * p.counts for p in pieces]
    return np.concatenate(parts)
