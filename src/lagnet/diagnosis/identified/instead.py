"""The identified layer beside the named effects, or in their place where their values hinder it.

Names are claims with parameters of their own. Where a name holds a part of what another cause does, as a gain does of
links that differ, a layer that is fitted beside its fixed value cannot take that back. Held-out blocks of the fitted
recordings decide: the names' parameters have seen them, which the final prediction error (Akaike 1970) accounts for.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.identified.equations import joint_equations
from lagnet.diagnosis.identified.fit import Identified, identify
from lagnet.diagnosis.problem.problem import Problem
from lagnet.effects.catalogue import effect_named
from lagnet.effects.effect import Effect
from lagnet.models.corrected.named_effects import NamedEffect, torque_with

REPLACED = ("rotor_inertia", "torque_offset", "torque_gain", "coupled_transmission")  # beside friction and bodies
SPRING = "joint_spring"  # that no layer has a function of, though links and curves over position come near to it
TIE = 1e-3  # mean over joints of ln(error in place of the names / error beside them): within it names stay


@dataclass(frozen=True, eq=False)
class Instead:
    """A layer in the place of names.

    Args:
        found: the layer.
        kept: the names that it stands beside.
    """

    found: Identified
    kept: tuple[NamedEffect, ...]


def instead_of_names(
    problem: Problem,
    effects: Sequence[NamedEffect],
    beside: Identified | None,
    floor: np.ndarray | float = 0.0,
    samples: np.ndarray | float = np.inf,
) -> Instead | None:
    """The layer in the place of effects that it has functions of, where it predicts unseen blocks better; else None.

    Springs, which stand for links and curves as gains do, are given up as well where blocks are predicted better still,
    and also where names leave noise alone: a spring that others could be as well holds nowhere else.

    Args:
        problem: the diagnosis' problem.
        effects: named physics.
        beside: the layer beside all of it; None where it predicts nothing more.
        floor: shape (dof,), error with the names up to which nothing is left to explain [N m].
        samples: shape (dof,), independent samples of each joint that the names' parameters were fitted to.
    """
    rest = kept_among(effects)
    with_names = _error_of(problem, effects) if beside is None else _block_error(beside)
    without_springs = tuple(e for e in rest if e.effect != SPRING)
    if rest == without_springs and np.all(with_names <= np.square(floor)):
        return None
    others = [rest] if rest == without_springs else [rest, without_springs]

    def beyond(kept: tuple[NamedEffect, ...], alone: Identified) -> float:
        """Mean over joints of ln(error in the place of the names / error beside them)."""
        unseen = with_names * _optimism([e for e in effects if e not in kept], samples, problem.n_dof)
        return float(np.mean(np.log(np.maximum(_block_error(alone), 1e-300) / np.maximum(unseen, 1e-300))))

    tried = [(kept, identify(problem, kept)) for kept in others if len(kept) < len(effects)]
    found = [(beyond(kept, alone), Instead(alone, kept)) for kept, alone in tried if alone is not None]
    least, best = min(found, key=lambda one: one[0], default=(0.0, None))
    return best if least < -TIE else None


def kept_among(effects: Sequence[NamedEffect]) -> tuple[NamedEffect, ...]:
    """Those that no layer can stand for: what acts for a while, and laws of which it has no function."""
    return tuple(e for e in effects if not (e.always_acts and _has_function(effect_named(e.effect))))


def _has_function(law: Effect) -> bool:
    return law.is_friction or law.is_body or law.name in REPLACED


def _optimism(effects: Sequence[NamedEffect], samples: np.ndarray | float, n_dof: int) -> np.ndarray:
    """1 + 2 p / n, shape (dof,): error on new samples over that on the n which p parameters were fitted to.

    Parameters that reach all joints are spread over them.
    """
    parameters = np.zeros(n_dof)
    for effect in effects:
        shared = effect.joint is None or effect_named(effect.effect).reaches_all
        parameters[slice(None) if shared else effect.joint] += len(effect.values) / (n_dof if shared else 1)
    return 1.0 + 2.0 * parameters / samples


def _block_error(found: Identified) -> np.ndarray:
    """Mean square residual of each joint on held-out blocks, shape (dof,) [N² m²]."""
    power = np.array([joint.power for joint in joint_equations(found.design)])
    return found.choice.nmse * power / np.array([max(1, joint.valid.sum()) for joint in found.design.joints])


def _error_of(problem: Problem, effects: Sequence[NamedEffect]) -> np.ndarray:
    """Mean square residual of each joint with the named effects alone, shape (dof,) [N² m²]."""
    motions = [replace(p.motion(problem), recorded=None) for p in problem.fit]
    left = [problem.reduce(p, p.tau - torque_with(m, effects)) for p, m in zip(problem.fit, motions, strict=True)]
    counts = np.concatenate([p.counts for p in problem.fit])
    return np.sum((np.concatenate(left) * counts) ** 2, axis=0) / np.maximum(1, counts.sum(axis=0))
