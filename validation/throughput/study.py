"""How fast: a training step against the Hessian form, batched and single inverse dynamics. See README.md."""

from __future__ import annotations

import argparse
import itertools
import json
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from lagnet.models.features import fit_features
from lagnet.models.kinds import ModelSpec, draw
from lagnet.models.lagrangians.delan import DelanSettings
from lagnet.models.lagrangians.perceptron_delan import PerceptronDelanSettings
from lagnet.models.learned_model import LearnedModel
from lagnet.models.scales import Scales
from validation.throughput import in_training, one_core
from validation.throughput.hessian_form import hessian_inverse_dynamics

HERE = Path(__file__).parent
DOF, BATCH, MANY = 6, 512, 65_536
KINDS: dict[str, Any] = {"delan-perceptron": PerceptronDelanSettings(hidden=(64, 64)), "delan": DelanSettings()}


def made(kind: str) -> tuple[ModelSpec, Any]:
    """An untrained six-joint model: speed does not depend on the weights."""
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (100, DOF))
    features = fit_features(q, ("continuous",) * DOF)
    names = tuple(f"joint_{i}" for i in range(DOF))
    spec = ModelSpec(kind, KINDS[kind], names, features, Scales((1.0,) * DOF, (1.0,) * DOF, (1.0,) * DOF))
    return spec, draw(spec, jax.random.key(0))


def best_time(call: Callable[[], Any], repeats: int) -> float:
    """Shortest wall-clock of some calls [s], after one that compiles: what the machine can do when left alone."""
    jax.block_until_ready(call())
    return min(_timed(call) for _ in range(repeats))


def paired_times(ours: Callable[[], Any], usual: Callable[[], Any], repeats: int) -> dict[str, Any]:
    """Both calls timed in turn, so that what else the machine does falls on both; the ratio is the median of pairs."""
    for call in (ours, usual):
        jax.block_until_ready(call())
    pairs = np.array([[_timed(call) for call in (ours, usual)] for _ in range(repeats)])
    median, ratios = np.median(pairs, axis=0), pairs[:, 1] / pairs[:, 0]
    low, high = np.percentile(ratios, [25, 75])
    return {
        "ours": float(median[0]),
        "hessian": float(median[1]),
        "ratio": float(np.median(ratios)),
        "ratio_quartiles": [float(low), float(high)],
    }


def _timed(call: Callable[[], Any]) -> float:
    began = time.perf_counter()
    jax.block_until_ready(call())
    return time.perf_counter() - began


def step_calls(kind: str) -> tuple[Callable[[], Any], Callable[[], Any]]:
    """Gradient of the torque error over one batch, by ours and by the usual formulation."""
    arm, rest, torques = both_forms(kind)
    batch = one_batch()

    def gradient(torque: Callable[..., Any]) -> Callable[[], Any]:
        compiled = jax.jit(jax.grad(lambda arm: torque_error(eqx.combine(arm, rest), torque, batch)))
        return lambda: compiled(arm)

    return gradient(torques[0]), gradient(torques[1])


def both_forms(kind: str) -> tuple[Any, Any, tuple[Callable[..., Any], Callable[..., Any]]]:
    """Weights of a model, the rest of it, and its inverse dynamics as ours and as usual."""
    _, dynamics = made(kind)
    arm, rest = eqx.partition(dynamics.lagrangian, eqx.is_array)
    return arm, rest, (type(dynamics.lagrangian).inverse_dynamics, hessian_inverse_dynamics)


def one_batch() -> tuple[jax.Array, ...]:
    """q, v, a and torque, each (BATCH, DOF)."""
    return tuple(jax.random.normal(k, (BATCH, DOF)) for k in jax.random.split(jax.random.key(1), 4))


def torque_error(model: Any, torque: Callable[..., Any], batch: tuple[jax.Array, ...]) -> jax.Array:
    """Mean squared error of the torque."""
    found = jax.vmap(lambda q, v, a: torque(model, q, v, a))(*batch[:3])
    return jnp.mean((found - batch[3]) ** 2)


def batched_rate(model: LearnedModel, repeats: int) -> float:
    """Samples a second of inverse dynamics through the public call."""
    q, v, a = np.random.default_rng(2).normal(size=(3, MANY, DOF))
    return MANY / best_time(lambda: model.inverse_dynamics(q, v, a), repeats)


def single_times(model: LearnedModel, repeats: int) -> dict[str, float]:
    """Wall-clock of one NumPy sample through the public call [s]: lowest decile and median."""
    q = np.full((1, DOF), 0.3)
    model.inverse_dynamics(q, q, q)
    times = [_timed(lambda: model.inverse_dynamics(q, q, q)) for _ in range(repeats)]
    return dict(zip(("lowest_decile", "median"), np.percentile(times, [10, 50]).tolist(), strict=True))


def matrix_rate(rows: int, inner: int, columns: int, repeats: int) -> float:
    """Operations a second of a single-precision matrix product here: a ceiling of any network of such layers."""
    keys = jax.random.split(jax.random.key(0))
    x, weight = jax.random.normal(keys[0], (rows, inner)), jax.random.normal(keys[1], (inner, columns))
    product = jax.jit(lambda x, weight: x @ weight)
    return 2.0 * rows * inner * columns / best_time(lambda: product(x, weight), repeats)


def ceiling(repeats: int) -> dict[str, float]:
    """Samples a second if the perceptron form were products of its own matrices and nothing else."""
    inertia, potential = (sum(i * o for i, o in itertools.pairwise((2 * DOF, 64, 64, n))) for n in (DOF**2, DOF))
    operations = 2.0 * (3 * inertia + 2 * potential)  # forward, tangent and reverse; forward and reverse
    rate = matrix_rate(BATCH, 64, 64, repeats)
    return {"operations_a_sample": operations, "flops_at_width_64": rate, "samples_per_second": rate / operations}


def run(quick: bool) -> dict[str, Any]:
    """All timings."""
    repeats = 5 if quick else 60
    out: dict[str, Any] = {"cores": os.cpu_count(), "load": os.getloadavg()[0]}
    out["matrix_flops"] = matrix_rate(1024, 1024, 1024, repeats)
    out["ceiling"] = ceiling(20 * repeats)
    for kind in ("delan-perceptron",) if quick else KINDS:
        double = LearnedModel(*made(kind))
        both = {"double": double, "single": double.in_single_precision()}
        steps = paired_times(*step_calls(kind), 5 * repeats)
        out[kind] = {
            "step_seconds": steps,
            "step_ratio": steps["ratio"],
            "step_on_one_core": one_core.measured(kind),
            "step_in_training": in_training.measured(kind, repeats),
            "samples_per_second": {name: batched_rate(model, repeats) for name, model in both.items()},
            "single_seconds": {name: single_times(model, 50 * repeats) for name, model in both.items()},
        }
        print(kind, out[kind], flush=True)
    perceptron = out["delan-perceptron"]
    out["passed"] = {
        "step_ratio": perceptron["step_ratio"] >= 6.0,
        "step_ratio_in_training": perceptron["step_in_training"]["ratio"] >= 6.0,
        "samples_per_second": max(perceptron["samples_per_second"].values()) >= 1e6,
        "single_seconds": perceptron["single_seconds"]["double"]["median"] <= 50e-6,
    }
    return out


def main() -> None:
    """Write result.json; in quick mode only print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a minute, for CI: runs everything, proves nothing")
    quick = parser.parse_args().quick
    result = run(quick)
    print(json.dumps(result["passed"], indent=2))
    if not quick:
        (HERE / "result.json").write_text(json.dumps(result, indent=2) + "\n")


if __name__ == "__main__":
    main()
