"""Run by test_devices in a process of its own: a training and its model on one of two devices, told by number."""

from __future__ import annotations

import json
import sys
from typing import Any

import jax
import numpy as np
from tests.training.trained_on_cores import springs

from lagnet.models import learned_model
from lagnet.training.history import Report
from lagnet.training.settings import TrainingSettings
from lagnet.training.train import train


def held() -> list[int]:
    """Numbers of the devices that hold an array."""
    return sorted({d.id for x in jax.live_arrays() for d in x.devices()})


def watched(seen: set[int]) -> None:
    """Lets every compiled call of a model note where its result lies."""
    compiled = learned_model._compiled

    def noting(*about: Any) -> Any:
        function = compiled(*about)

        def call(*given: Any) -> Any:
            found = function(*given)
            seen.update(d.id for d in found.devices())
            return found

        return call

    learned_model._compiled = noting


def main() -> None:
    """Print the devices that held arrays while training and calling, losses, errors and torques."""
    number, kind = int(sys.argv[1]), sys.argv[2]
    while_training: list[list[int]] = []
    called: set[int] = set()
    watched(called)

    def note(report: Report) -> None:
        while_training.append(held())

    settings = TrainingSettings(steps=200, batch=512)
    with jax.default_device(jax.devices()[number]):
        done = train([springs()], kind, training=settings, progress=note)
        q = np.random.default_rng(1).uniform(-2, 2, (3 * learned_model.CHUNK, 2))
        torque = done.model.inverse_dynamics(q, 0.3 * q, q)
    reports = [[r.loss, *r.held_out] for r in done.history.reports]
    told = {"held": while_training, "called": sorted(called), "devices": done.stats["devices"], "reports": reports}
    print(json.dumps(told | {"seen": len(jax.devices()), "torque": torque[::100].tolist()}))


if __name__ == "__main__":
    main()
