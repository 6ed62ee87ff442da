"""What was found of joints whose recorded torque stops at a limit: the limit acts on friction and springs, too.

A column clip(τ_nominal, ±τ_max) − τ_nominal stays zero where friction alone takes the torque beyond the limit, and the
samples on it look like something that acts for a while. Gains and delays have columns without friction: theirs would be
the friction itself, with one parameter less.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.ndimage import maximum_filter1d

from lagnet.diagnosis.problem.intervals import SMEAR
from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.diagnosis.regression.library import Library
from lagnet.diagnosis.selection.arm_search import Selection
from lagnet.diagnosis.selection.named_effects import named_effects
from lagnet.effects.catalogue import effect_named
from lagnet.effects.motion import Motion
from lagnet.effects.signal.saturation import WIDE, plateau
from lagnet.models.corrected.named_effects import NamedEffect, load_before
from lagnet.recordings.sampling import median_step

ENOUGH = 0.1  # of the mean square that the selection leaves, that it may leave with a limit


def found_below_limits(
    problem: Problem, library: Library, found: Selection, known: Sequence[NamedEffect], power: np.ndarray
) -> tuple[NamedEffect, ...]:
    """Selected torque of single joints which a limit makes explain much more than the selection does without one.

    What an earlier round found stays: beside its limit next to nothing is left that would show it again.

    Args:
        known: bodies that were found.
        power: shape (dof,), mean square residual of the selection, 0 where it is no more than noise [N² m²].
    """
    summary, out = problem.summary(), []
    for joint in map(int, np.flatnonzero(power)):
        level = None if summary.recorded is None else plateau(np.abs(summary.recorded[:, joint]))
        own = [] if level is None else _of_joint(problem, library, found, joint, level / WIDE)
        if own and level is not None and _left(summary, joint, level, (*known, *own)) < ENOUGH * power[joint]:
            out.extend(own)
    fresh = {e.joint for e in out}
    return (*(e for e in problem.below_limits if e.joint not in fresh), *out)


def _left(motion: Motion, joint: int, level: float, effects: Sequence[NamedEffect]) -> float:
    """Mean square of what effects that stop at a level leave of a joint's recorded torque [N² m²]."""
    assert motion.recorded is not None
    asked = load_before(motion, effects, "signal")[:, joint]
    return float(np.mean((motion.recorded[:, joint] - np.clip(asked, -level, level)) ** 2))


def _of_joint(problem: Problem, library: Library, found: Selection, joint: int, level: float) -> list[NamedEffect]:
    """The selected effects of one joint's own motion, fitted to samples below a level alone."""
    effects = named_effects(library, found)
    own = [n for n, e in enumerate(effects) if e.joint == joint and effect_named(e.effect).of_motion_alone]
    if not own:
        return []
    chosen = library.of(found.indices)
    table = np.concatenate([_rows_below(chosen, problem, p, joint, level) for p in problem.fit])
    slots = chosen.slots[joint]
    others = sum(table[:, at] @ found.fit.coefficients[found.indices[n]] for n, at in slots.items() if n not in own)
    columns = np.concatenate([slots[n] for n in own])
    theta, *_ = np.linalg.lstsq(table[:, columns], table[:, -1] - others, rcond=1e-10)
    parts = np.split(theta, np.cumsum([slots[n].size for n in own])[:-1])
    return [_with(library, found.indices[n], effects[n], part) for n, part in zip(own, parts, strict=True)]


def _with(library: Library, index: int, effect: NamedEffect, theta: np.ndarray) -> NamedEffect:
    h = library.hypotheses[index]
    return replace(effect, values=h.law.values(theta, dict(h.shape)))


def _rows_below(chosen: Library, problem: Problem, piece: Segment, joint: int, level: float) -> np.ndarray:
    """[F X, r] of a joint on samples that the filter does not mix with any whose torque reaches a level."""
    steps = int(np.ceil(SMEAR / problem.bandwidth / median_step(piece.time)))
    near = maximum_filter1d((np.abs(piece.tau[:, joint]) >= level).astype(np.uint8), 2 * steps + 1) > 0
    table = next(chosen.tables(problem, piece, [joint]))
    return table[~near[piece.keep] & piece.counts[:, joint]]
