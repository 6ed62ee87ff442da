"""From recordings to a learned model: the call behind `lagnet.train` and `lagnet train`."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

import jax
import numpy as np

from lagnet.models.devices import chosen_devices
from lagnet.models.dynamics import AbstractDynamics
from lagnet.models.features import fit_features, guess_joint_types
from lagnet.models.kinds import ModelSpec, draw, settings_class
from lagnet.models.learned_model import LearnedModel
from lagnet.models.residuals.augmented import Augmented
from lagnet.models.scales import fit_scales
from lagnet.recordings.recording import Recording
from lagnet.recordings.splits import holdout_split
from lagnet.training import serial_chain
from lagnet.training.checkpoint import fingerprint
from lagnet.training.cores import parts_of
from lagnet.training.history import History, Report
from lagnet.training.optimisation.fit import Fitted, Task, fit
from lagnet.training.samples import TrainingSamples, samples_of
from lagnet.training.settings import PENALTIES, TrainingSettings
from lagnet.training.stages import as_borne_out, in_stages

TRIAL = 0.2  # share of the steps spent on each λ while one is being chosen
NO_WORSE = 1.05  # among λ whose held-out errors are this near to the best, the largest wins


@dataclass(frozen=True)
class TrainResult:
    """A trained model and how it came about.

    Args:
        model: speaks NumPy and SI units.
        history: errors by joint over steps.
        stats: seed, settings, checksums, versions, seconds, held-out error by joint as a share of torque variance.
    """

    model: LearnedModel
    history: History
    stats: Mapping[str, Any]


def train(
    recordings: Sequence[Recording],
    model: str = "delan",
    seed: int = 0,
    holdout: Sequence[Recording] | None = None,
    minutes: float | None = None,
    *,
    settings: Any = None,
    training: TrainingSettings | None = None,
    joint_types: tuple[str, ...] | None = None,
    checkpoint: Path | None = None,
    progress: Callable[[Report], None] | None = None,
) -> TrainResult:
    """Learn the dynamics of an arm from what it did.

    Args:
        recordings: motion and torque; v and a are derived where they are missing.
        model: kind of model, a name in `lagnet.models.kinds.KINDS`.
        seed: of initial weights and shuffling; the same seed, data, steps and number of devices give the same model.
        holdout: recordings to judge by; None for the last fifth of each of `recordings`.
        minutes: wall-clock limit; with one, the number of steps depends on the machine.
        settings: settings dataclass of the kind, None for its defaults.
        training: how to train, None for the defaults.
        joint_types: 'continuous', 'revolute' or 'prismatic' for each joint; None to tell the first two by their range.
        checkpoint: file to resume from and write to, so that a killed run goes on to the same result.
        progress: called with each report.

    Raises:
        ModelError: unknown kind or unusable settings; RecordingError: recordings that cannot be trained on.
    """
    began = time.monotonic()
    settings = settings_class(model)() if settings is None else settings
    training = TrainingSettings() if training is None else training
    training = training if minutes is None else replace(training, minutes=minutes)
    seen, unseen = (recordings, holdout) if holdout else holdout_split(recordings)
    samples, held_out = samples_of(seen), samples_of(unseen)
    types = joint_types or guess_joint_types(samples.q)
    if model == serial_chain.KIND:
        return _chain_result(serial_chain.fit_chain(samples, types, seed, settings), held_out, began)
    features = fit_features(samples.q, types)
    spec = ModelSpec(model, settings, samples.joints, features, fit_scales(samples.v, samples.a, samples.tau))
    about = fingerprint(spec=spec, training=training, seed=seed, data=[samples.sha256(), held_out.sha256()])
    task = Task(samples, held_out, training, seed, checkpoint=checkpoint, about=about, progress=progress)
    with jax.enable_x64(False):
        start = draw(spec, jax.random.key(seed))
    fitted, penalty = _fitted(start, task)
    stats = _stats(spec, task, fitted, penalty, time.monotonic() - began)
    return TrainResult(LearnedModel(spec, fitted.dynamics, stats), fitted.history, stats)


def _chain_result(model: LearnedModel, held_out: TrainingSamples, began: float) -> TrainResult:
    """A serial chain judged like the others; it has no gradient steps to report."""
    error = model.inverse_dynamics(held_out.q, held_out.v, held_out.a) - held_out.tau
    share = (error**2).mean(axis=0) / np.maximum(held_out.tau.var(axis=0), 1e-18)
    seconds = round(time.monotonic() - began, 2)
    model.training.update(held_out_error=share.tolist(), held_out_samples=len(held_out), seconds=seconds)
    return TrainResult(model, History(), model.training)


def _fitted(start: AbstractDynamics, task: Task) -> tuple[Fitted, float | None]:
    """Train, with λ chosen first where the model has an ε and none was given; returns the λ used."""
    if not isinstance(start, Augmented):
        return fit(start, task), None
    if task.settings.separation == "stages":
        return in_stages(start, task), task.settings.penalty or 0.0
    penalty = task.settings.penalty
    if penalty is None:
        penalty = choose_penalty(start, task)
    return as_borne_out(fit(start, replace(task, penalty=penalty)), task), penalty


def choose_penalty(start: AbstractDynamics, task: Task) -> float:
    """The largest λ of PENALTIES whose short training is as good on held-out torque as any."""
    steps = max(1, int(task.settings.steps * TRIAL))
    minutes = None if task.settings.minutes is None else task.settings.minutes * TRIAL
    short = replace(task.settings, steps=steps, minutes=minutes)
    trial = replace(task, settings=short, checkpoint=None)
    found = {penalty: fit(start, replace(trial, penalty=penalty)).error for penalty in PENALTIES}
    best = min(found.values())
    return max(penalty for penalty, error in found.items() if error <= NO_WORSE * best)


def _stats(spec: ModelSpec, task: Task, fitted: Fitted, penalty: float | None, seconds: float) -> dict[str, Any]:
    reports = fitted.history.reports
    kept = next((r for r in reports if r.step == fitted.history.kept_step), None)
    epsilon = fitted.borne_out and {
        "held_out_error": list(fitted.borne_out.errors),
        "epsilon_shares": list(fitted.borne_out.shares),
    }
    return {
        "seed": task.seed,
        "seconds": round(seconds, 2),
        "training": dataclasses.asdict(task.settings),
        "penalty": penalty,
        "steps": reports[-1].step if reports else 0,
        "kept_step": fitted.history.kept_step,
        "stopped_early": fitted.history.stopped_early,
        "interrupted": fitted.history.interrupted,
        "device": chosen_devices()[0].device_kind,
        "devices": parts_of(min(task.settings.batch, len(task.samples))),
        "samples": len(task.samples),
        "samples_sha256": task.samples.sha256(),
        "held_out_samples": len(task.held_out),
        "held_out_error": list(kept.held_out) if kept else None,
        "versions": {name: version(name) for name in ("jax", "equinox", "optax", "numpy")},
        **(epsilon or {}),
    }
