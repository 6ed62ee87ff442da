"""Run by test_cores in a process of its own: what a short training gives with as many devices as JAX was told of."""

from __future__ import annotations

import json
import sys

import numpy as np

from lagnet.recordings.recording import Recording
from lagnet.training.cores import let_jax_see_cores
from lagnet.training.settings import TrainingSettings
from lagnet.training.train import train


def springs(n: int = 2000) -> Recording:
    """Two joints, each with a mass and a spring of sin q."""
    rng = np.random.default_rng(0)
    q, v, a = rng.uniform(-3, 3, (n, 2)), rng.normal(size=(n, 2)), rng.normal(size=(n, 2))
    return Recording(0.01 * np.arange(n), q, a * [0.7, 2.0] + 3.0 * np.sin(q), ("j0", "j1"), v=v, a=a)


def main() -> None:
    """Print the devices seen, those trained on, and the torque at some positions."""
    seen = let_jax_see_cores(int(sys.argv[1]) if len(sys.argv) > 1 else None)
    done = train([springs()], "ffnn", training=TrainingSettings(steps=100, batch=256, optimiser="adam"))
    q = np.random.default_rng(1).uniform(-2, 2, (20, 2))
    torque = done.model.inverse_dynamics(q, 0.3 * q, q)
    print(json.dumps({"seen": seen, "devices": done.stats["devices"], "torque": torque.tolist()}))


if __name__ == "__main__":
    main()
