"""A training lands on the device that was chosen, all of it, and gives there what it gives elsewhere."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import jax
import numpy as np
import pytest

from lagnet.models.devices import chosen_devices
from lagnet.training.cores import mesh_for, parts_of
from lagnet.training.optimisation.soap import _at_once, _one_by_one

SCRIPT = Path(__file__).with_name("trained_on_device.py")
PATIENCE = 240.0  # [s] for ten seconds of work
TWO = "--xla_force_host_platform_device_count=2"  # devices of this processor, for want of others


def trained(number: int, kind: str) -> dict[str, Any]:
    kept = {k: v for k, v in os.environ.items() if k != "JAX_NUM_CPU_DEVICES"}
    root = str(Path(__file__).parents[2])
    kept |= {"XLA_FLAGS": TWO, "PYTHONPATH": os.pathsep.join([root, *filter(None, [kept.get("PYTHONPATH")])])}
    command = [sys.executable, str(SCRIPT), str(number), kind]
    done = subprocess.run(command, env=kept, capture_output=True, text=True, check=True, timeout=PATIENCE)
    return json.loads(done.stdout.splitlines()[-1])


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["delan", "ffnn", "delan-ffnn"])
def test_a_training_stays_on_the_chosen_device_and_gives_the_same_there(kind):
    first, second = trained(0, kind), trained(1, kind)
    for number, told in enumerate((first, second)):
        assert told["seen"] == 2
        assert told["devices"] == 1  # the batch is not spread over the other one
        assert all(held == [number] for held in told["held"])
        assert told["called"] == [number]
    assert first["reports"] == second["reports"]
    assert first["torque"] == second["torque"]


def test_the_chosen_device_is_the_only_one():
    assert chosen_devices() == jax.local_devices()
    with jax.default_device(jax.devices()[0]):
        assert chosen_devices() == [jax.devices()[0]]
        assert (parts_of(4096), mesh_for(4096)) == (1, None)
    with jax.default_device("cpu"):
        assert chosen_devices() == jax.devices("cpu")[:1]


def test_eigenvectors_turn_alike_one_by_one_and_at_once():
    stack = jax.numpy.asarray(np.random.default_rng(0).standard_normal((5, 8, 8)))
    rounding = 100.0 * float(np.finfo(stack.dtype).eps)
    np.testing.assert_allclose(_one_by_one(stack), _at_once(stack), atol=rounding)
