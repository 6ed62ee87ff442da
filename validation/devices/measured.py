"""Run by the study in a process for each platform: what the first device of JAX does, printed as JSON.

python -m validation.devices.measured FOLDER [--quick]; the folder holds the motion.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jax
import numpy as np

from lagnet.models.devices import chosen_devices
from lagnet.models.files.saving import load_model
from lagnet.models.learned_model import LearnedModel
from lagnet.recordings.recording import Recording
from lagnet.training.history import Report
from lagnet.training.settings import TrainingSettings
from lagnet.training.train import train
from validation.devices.motion import HELD_OUT, MOTION, TRAIN, read_motion

MODELS = ("delan", "delan-blackbox", "ffnn", "delan-ffnn")
LEVELS = (0.5, 0.1, 0.01)


@dataclass(frozen=True)
class Sizes:
    """How much is measured: samples to train on and to judge by, steps by batch, samples and arms of batched parts."""

    train: int = TRAIN
    held_out: int = HELD_OUT
    steps: tuple[tuple[int, int], ...] = ((512, 1000), (4096, 300))
    batched: int = 65_536
    arms: int = 4096
    roll: int = 50
    repeats: int = 5


QUICK = Sizes(2_000, 500, ((256, 200),), 2_048, 64, 5, 2)


def trained(kind: str, data: tuple[Recording, Recording], batch: int, steps: int) -> tuple[LearnedModel, dict]:
    """A training, and its figures."""
    begun, spent = time.perf_counter(), time.process_time()
    done = train([data[0]], kind, holdout=[data[1]], training=TrainingSettings(steps=steps, batch=batch, patience=1.0))
    seconds, spent = time.perf_counter() - begun, time.process_time() - spent
    reports = done.history.reports
    return done.model, {
        "steps": reports[-1].step,
        "samples_per_second": round(_pace(reports, steps) * batch),
        "seconds": round(seconds, 2),
        "processor_seconds": round(spent, 2),
        "seconds_to": {str(level): _seconds_to(reports, level) for level in LEVELS},
        "held_out_error": float(f"{np.mean(reports[-1].held_out):.3g}"),
    }


def _pace(reports: list[Report], steps: int) -> float:
    """Steps a second after the first report, of mechanics alone where ε follows in a stage of its own."""
    first, last = reports[0], [r for r in reports if r.step <= steps][-1]
    return (last.step - first.step) / (last.seconds - first.seconds)


def _seconds_to(reports: list[Report], level: float) -> float | None:
    return next((round(r.seconds, 2) for r in reports if np.mean(r.held_out) <= level), None)


def batched(model: LearnedModel, sizes: Sizes) -> dict[str, Any]:
    """Samples a second of the batched parts in both precisions."""
    q, v, a = np.random.default_rng(2).normal(size=(3, sizes.batched, model.n_dof))
    out = {}
    for name, one in (("double", model), ("single", model.in_single_precision())):
        tau = one.inverse_dynamics(q, v, a)
        parts = {
            "inverse_dynamics": (lambda one=one: one.inverse_dynamics(q, v, a), sizes.batched),
            "forward_dynamics": (lambda one=one, tau=tau: one.forward_dynamics(q, v, tau), sizes.batched),
            "rollouts": (lambda one=one: rolled(one, q[: sizes.arms], sizes.roll), sizes.arms * sizes.roll),
        }
        out[name] = {part: _rates(call, count, sizes.repeats) for part, (call, count) in parts.items()}
    return out


def rolled(model: LearnedModel, q: np.ndarray, steps: int) -> np.ndarray:
    """Arms that are let go and fall for some steps of a millisecond, all at once."""
    v, still = np.zeros_like(q), np.zeros_like(q)
    for _ in range(steps):
        v = v + 1e-3 * model.forward_dynamics(q, v, still)
        q = q + 1e-3 * v
    return q


def _rates(call: Callable[[], Any], count: int, repeats: int) -> dict[str, float]:
    call()
    best, spent = np.inf, np.inf
    for _ in range(repeats):
        begun, used = time.perf_counter(), time.process_time()
        call()
        best, spent = min(best, time.perf_counter() - begun), min(spent, time.process_time() - used)
    return {"per_second": round(count / best), "per_processor_second": round(count / max(spent, 1e-9))}


def torques(folder: Path) -> dict[str, list]:
    """Torque of the saved weights at some samples, in both precisions."""
    model = load_model(folder)
    q, v, a = np.random.default_rng(3).normal(size=(3, 2000, model.n_dof))
    both = {"double": model, "single": model.in_single_precision()}
    return {name: one.inverse_dynamics(q, v, a)[::20].tolist() for name, one in both.items()}


def main() -> None:
    """Print what was measured; the first process to find none saves its model for all."""
    folder, sizes = Path(sys.argv[1]), QUICK if "--quick" in sys.argv else Sizes()
    data = read_motion(folder / MOTION, (sizes.train, sizes.held_out))
    device = chosen_devices()[0]
    out: dict[str, Any] = {
        "platform": device.platform,
        "device": device.device_kind,
        "cores": os.cpu_count(),
        "training": {},
    }
    models = {}
    for kind in MODELS:
        out["training"][kind] = {}
        for batch, steps in sizes.steps:
            models[kind], out["training"][kind][str(batch)] = trained(kind, data, batch, steps)
            print(kind, batch, out["training"][kind][str(batch)], file=sys.stderr, flush=True)
    out["batched"] = batched(models["delan"], sizes)
    if not (folder / "model").exists():
        models["delan"].save(folder / "model")
    print(json.dumps({**out, "jax": jax.__version__, "torques": torques(folder / "model")}))


if __name__ == "__main__":
    main()
