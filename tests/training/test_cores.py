"""A batch spread over cores gives what one core gives, to rounding, and the same again to the bit."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lagnet.side_by_side import usable_cores
from lagnet.training.cores import mesh_for, parts_of

pytestmark = pytest.mark.slow

SCRIPT = Path(__file__).with_name("trained_on_cores.py")
PATIENCE = 240.0  # [s] for ten seconds of work
ROUNDING = 1e-3  # of torques of the order of one, after a hundred steps in single precision


def trained(*words: str, **environment: str) -> dict[str, Any]:
    kept = {k: v for k, v in os.environ.items() if k not in ("JAX_NUM_CPU_DEVICES", "XLA_FLAGS")}
    command = [sys.executable, str(SCRIPT), *words]
    done = subprocess.run(command, env=kept | environment, capture_output=True, text=True, check=True, timeout=PATIENCE)
    return json.loads(done.stdout.splitlines()[-1])


@pytest.fixture(scope="module")
def two() -> dict[str, Any]:
    return trained("2")


def test_two_devices_train_as_one_does_to_rounding(two) -> None:
    one = trained("1")
    assert (one["devices"], two["devices"]) == (1, 2)
    np.testing.assert_allclose(two["torque"], one["torque"], atol=ROUNDING)


def test_the_same_number_gives_the_same_model(two) -> None:
    assert trained("2") == two


def test_the_usual_training_of_an_arm_ends() -> None:
    """A batch of factorisations is spread over threads that the devices need for themselves: none may be asked for."""
    assert trained("2", "delan", "soap", "6")["devices"] == 2


def test_the_environment_is_heeded_where_no_number_is_given() -> None:
    assert trained(JAX_NUM_CPU_DEVICES="3")["seen"] == 3


def test_one_device_is_the_rule() -> None:
    assert parts_of(512) == 1
    assert mesh_for(512) is None
    assert usable_cores() >= 1
