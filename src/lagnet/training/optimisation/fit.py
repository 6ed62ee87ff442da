"""One training from start to end: chunks of steps, judged on held-out samples; the best is kept."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from lagnet.models.dynamics import AbstractDynamics
from lagnet.recordings.sampling import spread_rows
from lagnet.training.checkpoint import read_checkpoint, write_checkpoint
from lagnet.training.history import History, Report
from lagnet.training.optimisation.loop import CHUNK, JUDGED, Loop, LoopState, make_loop
from lagnet.training.samples import TrainingSamples
from lagnet.training.settings import TrainingSettings

CHECKPOINT_EVERY = 5.0  # seconds between checkpoints, which is what a kill may cost; writing one takes milliseconds


@dataclass(frozen=True)
class Task:
    """What one training is to lower, and where.

    Args:
        samples: to train on; held_out: to judge by.
        settings: how; seed: of shuffling; penalty: λ of eq. 12.
        trainable: filter true for the leaves to train, None for all.
        variance: of each joint's torque, in which errors count, shape (dof,) [N² m²]; None for that of the samples.
        checkpoint: file to resume from and write to, None for none; about: fingerprint it must carry.
        progress: called with each report.
    """

    samples: TrainingSamples
    held_out: TrainingSamples
    settings: TrainingSettings
    seed: int
    penalty: float = 0.0
    trainable: Any = None
    variance: np.ndarray | None = None
    checkpoint: Path | None = None
    about: str = ""
    progress: Callable[[Report], None] | None = None


class Standing(NamedTuple):
    """Where a training stands: the loop's state, the best weights so far with their step and error, planned steps."""

    loop: LoopState
    best: Any
    best_step: Array
    best_error: Array
    total: Array


class BorneOut(NamedTuple):
    """What held-out torque says about ε: the share kept on each joint, and the error that is left with it.

    Args:
        shares: 0 … 1; errors: of all held-out torque, as a share of the torque variance; both of length dof.
    """

    shares: tuple[float, ...]
    errors: tuple[float, ...]


@dataclass(frozen=True)
class Fitted:
    """The best model of a training by held-out torque error, and how it came about.

    Args:
        dynamics: the model; error: its held-out error, mean over joints; history: all reports.
        borne_out: what became of ε, where the model has one.
    """

    dynamics: AbstractDynamics
    error: float
    history: History
    borne_out: BorneOut | None = None


def fit(dynamics: AbstractDynamics, task: Task) -> Fitted:
    """Train a model from where it is; Ctrl-C ends early with the best so far.

    Args:
        dynamics: weights to start from.
        task: what to lower.
    """
    with jax.enable_x64(False), jax.default_matmul_precision("float32"):  # a GPU would round products to ten bits
        dynamics = jax.tree.map(lambda x: jnp.asarray(x, jnp.float32) if eqx.is_array(x) else x, dynamics)
        run = _Run(dynamics, task)
        try:
            while not run.finished():
                run.advance()
        except KeyboardInterrupt:
            run.history.interrupted = True
        run.keep()
        return run.result()


class _Run:
    """The moving parts of `fit`."""

    def __init__(self, dynamics: AbstractDynamics, task: Task):
        given = task.samples.tau.var(axis=0) if task.variance is None else task.variance
        variance = np.maximum(given, 1e-18)
        trainable = eqx.is_array if task.trainable is None else task.trainable
        self.task, self.history, self.began = task, History(), time.monotonic()
        self.loop: Loop = make_loop(
            dynamics, jnp.asarray(variance, jnp.float32), len(task.samples), task.settings, task.seed, trainable
        )
        self.data = self.loop.place(_on_device(task.samples.arrays))
        self.train_probe, self.held_probe = _probe(task.samples), _probe(task.held_out)
        self.standing = self._resumed()
        self.saved_at: float = self.began
        self.warm_from: tuple[int, float] | None = None  # (step, time) after the first chunk, which compiles

    def _resumed(self) -> Standing:
        steps = -(-self.task.settings.steps // CHUNK) * CHUNK
        start = self.loop.start
        zero, worst = jnp.zeros((), jnp.int32), jnp.asarray(jnp.inf, jnp.float32)
        fresh = Standing(start, start.params, zero, worst, jnp.asarray(steps, jnp.int32))
        if self.task.checkpoint is None:
            return fresh
        found = read_checkpoint(self.task.checkpoint, fresh, self.task.about)
        if found is None:
            return fresh
        standing, told = found
        self.history = History.of_plain(told)
        return standing

    def finished(self) -> bool:
        step, total = int(self.standing.loop.step), int(self.standing.total)
        waited = step - int(self.standing.best_step)
        self.history.stopped_early = step < total and waited > max(self.task.settings.patience * total, CHUNK)
        return step >= total or self.history.stopped_early

    def advance(self) -> None:
        standing, penalty = self.standing, jnp.asarray(self.task.penalty, jnp.float32)
        state, loss = self.loop.advance(standing.loop, self.data, penalty, standing.total)
        held = self.loop.judge(state.params, self.held_probe).torque
        error = jnp.mean(held)
        if error < standing.best_error:
            standing = standing._replace(best=state.params, best_step=state.step, best_error=error)
        self.standing = self._within_minutes(standing._replace(loop=state))
        self._report(float(loss), np.asarray(held))
        if time.monotonic() - self.saved_at > CHECKPOINT_EVERY:
            self.keep()

    def _within_minutes(self, standing: Standing) -> Standing:
        """Shorten the plan to what the time allows, once the first chunk has paid for compilation."""
        step, minutes = int(standing.loop.step), self.task.settings.minutes
        pace = self._pace(step)
        if minutes is None or pace is None:
            return standing
        room = max(0.0, minutes * 60.0 - (time.monotonic() - self.began))
        possible = step + int(room / pace) // CHUNK * CHUNK
        return standing._replace(total=jnp.asarray(min(int(standing.total), max(possible, step)), jnp.int32))

    def _pace(self, step: int) -> float | None:
        """Seconds a step since the first chunk, None until there is more than that."""
        now = time.monotonic()
        if self.warm_from is None:
            self.warm_from = (step, now)
        done = step - self.warm_from[0]
        return (now - self.warm_from[1]) / done if done else None

    def _report(self, loss: float, held_out: np.ndarray) -> None:
        step, total, now = int(self.standing.loop.step), int(self.standing.total), time.monotonic()
        train = np.asarray(self.loop.judge(self.standing.loop.params, self.train_probe).torque)
        elapsed = now - self.began
        left = (self._pace(step) or elapsed / CHUNK) * (total - step)
        report = Report(step, total, elapsed, left, loss, _floats(train), _floats(held_out))
        self.history.reports.append(report)
        if self.task.progress is not None:
            self.task.progress(report)

    def keep(self) -> None:
        """Write the checkpoint."""
        self.saved_at = time.monotonic()
        if self.task.checkpoint is not None:
            write_checkpoint(self.task.checkpoint, self.standing, self.task.about, self.history.plain())

    def result(self) -> Fitted:
        self.history.kept_step = int(self.standing.best_step)
        return Fitted(self.loop.assemble(self.standing.best), float(self.standing.best_error), self.history)


def _on_device(arrays: tuple[np.ndarray, ...]) -> tuple[Array, ...]:
    return tuple(jnp.asarray(x, jnp.float32) for x in arrays)


def _probe(samples: TrainingSamples) -> tuple[Array, ...]:
    """Evenly spread rows on which errors are reported."""
    rows = spread_rows(len(samples), JUDGED)
    return _on_device(tuple(x[rows] for x in samples.arrays))


def _floats(values: np.ndarray) -> tuple[float, ...]:
    return tuple(float(x) for x in values)
