"""Run by test_cores in a process of its own: what a short training gives with as many devices as JAX was told of."""

from __future__ import annotations

import json
import sys

import numpy as np

from lagnet.recordings.recording import Recording
from lagnet.training.cores import let_jax_see_cores
from lagnet.training.settings import TrainingSettings
from lagnet.training.train import train


def springs(n: int = 2000, joints: int = 2) -> Recording:
    """Joints, each with a mass and a spring of sin q."""
    rng = np.random.default_rng(0)
    q, v, a = rng.uniform(-3, 3, (n, joints)), rng.normal(size=(n, joints)), rng.normal(size=(n, joints))
    names = tuple(f"j{j}" for j in range(joints))
    return Recording(0.01 * np.arange(n), q, a * np.linspace(0.7, 2.0, joints) + 3.0 * np.sin(q), names, v=v, a=a)


def main() -> None:
    """Print the devices seen, those trained on, and the torque at some positions."""
    seen = let_jax_see_cores(int(sys.argv[1]) if len(sys.argv) > 1 else None)
    kind, optimiser, joints = sys.argv[2:] if len(sys.argv) > 2 else ("ffnn", "adam", "2")
    recording = springs(joints=int(joints))
    done = train([recording], kind, training=TrainingSettings(steps=100, batch=256, optimiser=optimiser))
    q = np.random.default_rng(1).uniform(-2, 2, (20, int(joints)))
    torque = done.model.inverse_dynamics(q, 0.3 * q, q)
    print(json.dumps({"seen": seen, "devices": done.stats["devices"], "torque": torque.tolist()}))


if __name__ == "__main__":
    main()
