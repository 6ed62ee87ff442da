"""Mechanics and ε one after the other: mechanics as far as mechanics goes, then ε on what it left.

The mechanics are those that the same steps give without ε, to the bit. ε is then a plain regression on torque that is
computed once, and is kept only as far as held-out torque bears it out (`held_out_share`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import cast

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from lagnet.errors import ModelError
from lagnet.models.dynamics import AbstractDynamics
from lagnet.models.lagrangians.massless import Massless
from lagnet.models.residuals.augmented import Augmented
from lagnet.models.residuals.body_drag import Dragged
from lagnet.training.held_out_share import shares
from lagnet.training.optimisation.fit import BorneOut, Fitted, Task, fit
from lagnet.training.samples import TrainingSamples
from lagnet.types import Trajectory

STAGES = ("mechanics", "epsilon")
MECHANICS_TIME = 0.75  # share of the minutes for mechanics; a step of ε alone costs less than half of one of theirs
ROWS = 4096  # samples whose torque is computed together


def in_stages(start: Augmented, task: Task) -> Fitted:
    """Train mechanics for the task's steps, then ε for as many on what they left.

    Raises:
        ModelError: an ε that acts on the bodies of its mechanics.
    """
    if isinstance(start, Dragged):
        raise ModelError("body-drag cannot be trained in stages", next_step='train with separation="joint", penalty=0')
    first = fit(start.mechanics, _stage(task, 0))
    whole = Augmented(first.dynamics, start.residual, start.parity)
    if first.history.interrupted:
        return replace(first, dynamics=whole)
    left = replace(
        _stage(task, 1),
        samples=_left(task.samples, first.dynamics),
        held_out=_left(task.held_out, first.dynamics),
        variance=task.samples.tau.var(axis=0),
    )
    second = fit(Augmented(Massless(), start.residual, start.parity), left)
    found = Augmented(first.dynamics, cast(Augmented, second.dynamics).residual, start.parity)
    history = first.history.followed_by(second.history)
    return as_borne_out(replace(second, dynamics=found, history=history), task)


def as_borne_out(fitted: Fitted, task: Task) -> Fitted:
    """The same model with the share of ε on each joint that held-out torque bears out."""
    model = fitted.dynamics
    assert isinstance(model, Augmented)
    q, v, a, _ = task.held_out.arrays
    left = _left(task.held_out, model.mechanics).tau
    epsilon = torque_of(model.epsilon, q, v, a)
    kept = shares(left, epsilon)
    smaller = eqx.tree_at(lambda x: x.residual, model, model.residual.scaled(kept))
    error = np.mean((left - kept * epsilon) ** 2, axis=0) / np.maximum(task.samples.tau.var(axis=0), 1e-18)
    return replace(fitted, dynamics=smaller, borne_out=BorneOut(tuple(kept.tolist()), tuple(error.tolist())))


def torque_of(law: Callable[..., Array], q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
    """What a model's method of (q, v, a) gives for samples of shape (n, dof) in double precision, in bounded memory."""
    rows = -(-len(q) // ROWS) * ROWS
    full = [np.pad(x, ((0, rows - len(q)), (0, 0)), mode="edge").reshape(-1, ROWS, x.shape[1]) for x in (q, v, a)]
    with jax.enable_x64(True):
        wide = jax.tree.map(lambda x: jnp.asarray(x, jnp.float64) if eqx.is_array(x) else x, law)
        parts = [np.asarray(_batch(wide, *map(jnp.asarray, part))) for part in zip(*full, strict=True)]
    return np.concatenate(parts)[: len(q)]


@eqx.filter_jit
def _batch(law: Callable[..., Array], q: Array, v: Array, a: Array) -> Array:
    return jax.vmap(law)(q, v, a)


def stage_files(checkpoint: Path) -> tuple[Path, ...]:
    """Where the stages of a training keep their states, beside the checkpoint of a training in one piece."""
    return tuple(checkpoint.with_name(f"{checkpoint.stem}_{name}{checkpoint.suffix}") for name in STAGES)


def _left(samples: TrainingSamples, mechanics: AbstractDynamics) -> TrainingSamples:
    """The samples with the torque that mechanics leave."""
    q, v, a, tau = samples.arrays
    return replace(samples, tau=tau - torque_of(mechanics.inverse_dynamics, q, v, a))


def _stage(task: Task, place: int) -> Task:
    """The task of one stage: all steps, its share of the minutes, a checkpoint of its own."""
    minutes = task.settings.minutes
    share = (MECHANICS_TIME, 1.0 - MECHANICS_TIME)[place]
    settings = replace(task.settings, minutes=None if minutes is None else minutes * share)
    path = None if task.checkpoint is None else stage_files(task.checkpoint)[place]
    return replace(task, settings=settings, checkpoint=path, penalty=task.settings.penalty or 0.0)
