"""What is particular to each format of foreign logs."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from tests.recordings.made_logs import (
    COMMAND,
    JOINTS,
    TAU,
    TIME,
    N,
    Q,
    arm,
    lerobot,
    libfranka,
    motion_folder,
    rtde,
    servo_bench,
)

from lagnet.errors import RecordingError
from lagnet.recordings.loading.column_map import ColumnMap
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.loading.opening import open_source, recordings_in


def test_a_clock_that_was_made_is_told(tmp_path: Path) -> None:
    assert load_recording(lerobot(tmp_path)).warnings == (
        "the clock is made from frame numbers (100 per second), not recorded: no delay below a frame can be told",
    )
    jitter = TIME + 1e-3 * np.random.default_rng(0).uniform(0, 1, N)
    recorded = tmp_path / "recorded"
    recorded.mkdir()
    assert load_recording(lerobot(recorded, timestamp=jitter)).warnings == ()


def test_actions_go_to_the_joints_by_name(tmp_path: Path) -> None:
    names = [f"{joint}.pos" for joint in JOINTS]
    feature = {"dtype": "float32", "shape": [6]}
    features = {
        "observation.state": feature | {"names": names},
        "action": feature | {"names": {"motors": [f"main_{n}" for n in JOINTS[::-1]]}},
    }
    path = lerobot(tmp_path, info={"features": features}, action=COMMAND[:, ::-1])
    found = load_recording(path, robot=arm())
    np.testing.assert_array_equal(found.command, COMMAND)
    assert found.joints == JOINTS


@pytest.mark.parametrize(("factor", "match"), [(180 / np.pi, "degrees"), (60.0, "degrees instead of rad")])
def test_degrees_and_scales_to_a_hundred_are_refused_until_stated(factor: float, match: str, tmp_path: Path) -> None:
    path = lerobot(tmp_path, state=factor * Q, action=factor * COMMAND)
    with pytest.raises(RecordingError, match=match):
        load_recording(path)
    stated = ColumnMap(scale={"q": 1 / factor, "command": 1 / factor})
    np.testing.assert_allclose(load_recording(path, columns=stated).q, Q, atol=1e-12)


def test_a_single_joint_may_be_stored_as_plain_numbers(tmp_path: Path) -> None:
    found = load_recording(lerobot(tmp_path, names=["pan"], state=Q[:, 0], action=COMMAND[:, 0]))
    np.testing.assert_array_equal(found.q, Q[:, :1])
    np.testing.assert_array_equal(found.command, COMMAND[:, :1])


@pytest.mark.parametrize("name", ["timestamp", "frame_index", "episode_index"])
@pytest.mark.parametrize(
    "values", [[[1.0]] * N, [[]] * N, [np.nan] * N, [1e300] * N], ids=["lists", "empty", "nan", "big"]
)
def test_time_and_counters_are_one_number_a_row(tmp_path: Path, name: str, values: list) -> None:
    (file,) = (lerobot(tmp_path) / "data").glob("*/*.parquet")
    table = pq.read_table(file)
    pq.write_table(table.set_column(table.column_names.index(name), name, pa.array(values)), file)
    with pytest.raises(RecordingError):
        load_recording(tmp_path / "set")


@pytest.mark.parametrize("fps", [10**30, 1e-320, float("inf"), "100", True])
def test_a_rate_that_no_robot_has_is_no_clock(tmp_path: Path, fps: object) -> None:
    found = load_recording(lerobot(tmp_path, info={"fps": fps}))
    np.testing.assert_allclose(found.time, TIME, atol=1e-6)
    assert found.warnings == ()


def test_a_set_without_samples_is_refused(tmp_path: Path) -> None:
    (file,) = (lerobot(tmp_path, names=["pan"], state=Q[:, 0], action=Q[:, 0]) / "data").glob("*/*.parquet")
    pq.write_table(pq.read_table(file).slice(0, 0), file)
    with pytest.raises(RecordingError, match="no samples"):
        load_recording(tmp_path / "set")


def test_an_unknown_version_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"is of version 'v1.6' \(valid: v2.0, v2.1, v3.0\)"):
        load_recording(lerobot(tmp_path, "v1.6"))


def test_torques_with_a_sign_are_torques(tmp_path: Path) -> None:
    found = load_recording(motion_folder(tmp_path, torque=TAU))
    np.testing.assert_array_equal(found.tau, TAU)
    assert found.warnings == ()


def test_a_servo_that_counts_microseconds(tmp_path: Path) -> None:
    found = load_recording(servo_bench(tmp_path, micro=True))
    np.testing.assert_allclose(found.time, TIME, atol=1e-12)
    assert "the clock counts microseconds" in found.warnings
    assert found.duty is not None
    assert found.duty.min() < 0
    np.testing.assert_array_equal(found.enabled[:, 0], np.arange(N) > 5)


def test_loads_of_an_unknown_motor_are_no_duty(tmp_path: Path) -> None:
    found = load_recording(servo_bench(tmp_path, motor="mystery"))
    assert found.duty is None
    assert any("scale of load is not known for the motor mystery" in text for text in found.warnings)


def test_a_json_of_something_else(tmp_path: Path) -> None:
    path = tmp_path / "package.json"
    path.write_text(json.dumps({"name": "x"}))
    with pytest.raises(RecordingError, match="JSON without the keys kp and entries"):
        load_recording(path)


@pytest.mark.parametrize("separator", [",", " "])
def test_the_controllers_model_is_no_measurement(separator: str, tmp_path: Path) -> None:
    path = rtde(tmp_path, separator)
    found = load_recording(path)
    assert found.tau is None
    assert any("target_moment is the torque of the controller's own model" in text for text in found.warnings)
    np.testing.assert_allclose(load_recording(path, torque_constant=2.0).tau, 2 * TAU, atol=1e-12)
    # A user may still map the table's own names.
    own = ColumnMap(columns={"tau": "target_moment_{i}"})
    np.testing.assert_allclose(load_recording(path, columns=own).tau, 5 * TAU, atol=1e-12)


def test_milliseconds_of_libfranka(tmp_path: Path) -> None:
    found = load_recording(libfranka(tmp_path))
    np.testing.assert_array_equal(found.time, np.round(1000 * TIME) / 1000)
    assert found.n_dof == 7


def test_a_signal_can_be_left_out_by_a_mapping(tmp_path: Path) -> None:
    path = motion_folder(tmp_path, torque=TAU)
    found = load_recording(path, columns=ColumnMap(columns={"tau": "", "current": "tau_{i}"}), torque_constant=0.5)
    np.testing.assert_array_equal(found.current, TAU)
    np.testing.assert_array_equal(found.tau, 0.5 * TAU)


@pytest.mark.shared_data
def test_every_real_log_reads_without_a_mapping(shared_data: Path) -> None:
    bags = {"ur10_exciting_trajectory": (3441, 6, 125.0), "panda_exciting_trajectory": (727, 7, 30.0)}
    for name, (n, n_dof, rate) in bags.items():
        found = load_recording(shared_data / "bags" / f"{name}.db3")
        assert (len(found), found.n_dof, found.signals) == (n, n_dof, ("q", "v", "tau"))
        assert found.rate == pytest.approx(rate, rel=1e-3)
    found = load_recording(shared_data / "lerobot_g1")
    assert (len(found.trajectory_names), found.n_dof, found.signals) == (6, 26, ("q", "command"))
    motions = recordings_in(shared_data / "so101")
    assert len(motions) == 30
    for motion in motions[::10]:
        found = load_recording(motion)
        assert found.signals[0] == "q"
        assert "command" in found.signals
        assert found.tau is None
        assert found.rate == pytest.approx(50, abs=0.5)
    for path in sorted((shared_data / "bam_xl330").glob("*.json")):
        found = load_recording(path)
        assert set(found.signals) >= {"q", "command", "enabled", "temperature", "voltage", "duty"}
        assert np.abs(found.duty).max() <= 1.0
        assert 20 < found.temperature.mean() < 45


@pytest.mark.shared_data
def test_real_joint_names_with_another_prefix(shared_data: Path) -> None:
    panda = arm(tuple(f"panda_joint{k}" for k in range(1, 8)))
    found = load_recording(shared_data / "bags" / "panda_exciting_trajectory.db3", robot=panda)
    assert found.joints == panda.joints
    assert open_source(shared_data / "bags" / "panda_exciting_trajectory.db3")[0].joints[0] == "fer_joint1"
