"""Words, report, verdict.json and holdout_torque.parquet of one diagnosis hold the same figures.

The real arms that another test diagnoses are held to this where that is: tests/diagnosis/scenarios/test_real_arms.py.
"""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.conftest import Plant
from tests.reports.diagnosis_report.figures import assert_figures_agree

from lagnet.diagnosis.diagnose import diagnose
from lagnet.recordings.loading.load import load_recording
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import load_description

TORQUE_CONSTANT = (14.87, 13.26, 11.13, 10.62, 11.03, 11.47)  # [N m/A] of the UR10e, the authors' identification

pytestmark = pytest.mark.slow


def test_a_small_arm(tmp_path) -> None:
    arm = random_arm(2, seed=12, kinds=("revolute",), fixed=False)
    plant = Plant(arm, [lambda q, v, a, load: np.array([1.2, 0.5]) * v, lambda q, v, a, load: 0.2 * np.sin(3.0 * q)])
    result = diagnose([plant.record(1, 20.0)], arm, [plant.record(2, 20.0)])
    assert result.effects
    assert_figures_agree(result, tmp_path)


@pytest.mark.shared_data
def test_a_real_panda(shared_data, tmp_path) -> None:
    """At 100 Hz of its 1 kHz: the figures are the same however many samples there are."""
    robot = load_description("panda")
    read = (load_recording(shared_data / "panda" / f"{name}.csv.gz", robot=robot) for name in ("fit", "holdout"))
    fit, held = (recording.rows(slice(0, None, 10)) for recording in read)
    assert_figures_agree(diagnose([fit], robot, [held]), tmp_path)


@pytest.mark.shared_data
def test_a_real_ur10_in_a_bag(shared_data, tmp_path) -> None:
    robot = load_description("ur10")
    log = load_recording(shared_data / "bags" / "ur10_exciting_trajectory.db3", robot=robot)
    assert_figures_agree(diagnose([log.rows(slice(0, None, 2))], robot), tmp_path)


@pytest.mark.shared_data
def test_a_real_ur10e_with_a_load(shared_data, tmp_path) -> None:
    """Two held-out stretches: the ends of both recordings."""
    robot = load_description(shared_data / "ur10e" / "ur10e.urdf")
    files = (shared_data / "ur10e_loaded" / f"loaded_{k}.csv.gz" for k in range(2))
    logs = [load_recording(f, robot=robot, torque_constant=TORQUE_CONSTANT).rows(slice(0, 2500)) for f in files]
    assert_figures_agree(diagnose(logs, robot), tmp_path)
