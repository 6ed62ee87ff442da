"""Recordings that hold commands and the state of the drives, with or without torque."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import diagnose
from lagnet.errors import RecordingError
from lagnet.recordings.conditioning.condition import condition
from lagnet.recordings.loading.column_map import ColumnMap
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.recording import Recording
from lagnet.recordings.signals import DRIVE_SIGNALS, kind_of
from lagnet.recordings.splits import holdout_split
from lagnet.recordings.writing import write_recording

JOINTS = ("lift", "elbow")
TIME = 0.01 * np.arange(200)
Q = np.sin(TIME[:, None] * [2.0, 3.0])


def commanded(**changes) -> Recording:
    """A position-controlled motion of two joints, without torque."""
    fields = {"time": TIME, "q": Q, "tau": None, "joints": JOINTS, "command": np.round(Q, 1)}
    return Recording(**fields | changes)


def write_csv(path: Path, columns: dict[str, np.ndarray]) -> Path:
    np.savetxt(path, np.stack(list(columns.values()), axis=1), delimiter=",", header=",".join(columns), comments="")
    return path


def table(**more: np.ndarray) -> dict[str, np.ndarray]:
    return {"time": TIME, "q_0": Q[:, 0], "q_1": Q[:, 1]} | more


def test_one_of_torque_current_and_command_is_needed() -> None:
    assert not commanded().has_torque
    assert Recording(TIME, Q, None, JOINTS, current=Q).signals == ("q", "current")
    assert Recording(TIME, Q, Q, JOINTS).has_torque
    with pytest.raises(RecordingError, match="neither torque, motor current nor commands"):
        Recording(TIME, Q, None, JOINTS)
    with pytest.raises(RecordingError, match=r"enabled has shape \(200,\), expected \(200, 2\)"):
        commanded(enabled=np.ones(200))


def test_parts_rows_and_splits_keep_every_signal() -> None:
    signals = {name: Q + k for k, name in enumerate(DRIVE_SIGNALS)}
    recording = commanded(**signals, trajectory=np.repeat([0, 1], 100), trajectory_names=("a", "b"))
    second = list(recording.parts())[1]
    (fit,), (held,) = holdout_split([recording], 0.5)
    for name, values in signals.items():
        np.testing.assert_array_equal(getattr(second, name), values[100:])
        np.testing.assert_array_equal(getattr(fit, name), values[:100])
        np.testing.assert_array_equal(getattr(held, name), values[100:])


def test_the_torque_route_refuses_a_recording_of_commands_in_one_line() -> None:
    recording = commanded(path="run.csv")
    robot = SimpleNamespace(joints=JOINTS, n_dof=2, inverse_dynamics=lambda q, v, a: a)
    for call in (lambda: condition([recording]), lambda: diagnose([recording], robot)):
        with pytest.raises(RecordingError, match=r"^run.csv: holds no joint torque, only commands; give .*tau_0"):
            call()


def test_conditioning_holds_commands_from_sample_to_sample() -> None:
    jitter = TIME + 1e-3 * np.random.default_rng(0).uniform(-1, 1, TIME.size)
    recording = commanded(time=jitter, tau=Q)
    stretch = condition([recording]).stretches[0]
    assert set(stretch.drive) == {"command"}
    for time, values in zip(stretch.time, stretch.drive["command"], strict=True):
        np.testing.assert_array_equal(values, recording.command[np.flatnonzero(jitter <= time)[-1]])


def test_joint_names_may_stand_in_the_columns(tmp_path: Path) -> None:
    path = write_csv(
        tmp_path / "run.csv",
        {"time": TIME, "q_elbow": Q[:, 1], "q_lift": Q[:, 0], "command_lift": Q[:, 0], "command_elbow": Q[:, 1] + 1}
        | {f"command_velocity_{joint}": np.full(200, 3.0) for joint in JOINTS},
    )
    found = load_recording(path, joints=JOINTS)
    np.testing.assert_array_equal(found.command, np.add(Q, [0.0, 1.0]))
    np.testing.assert_array_equal(found.command_velocity, np.full((200, 2), 3.0))
    assert found.tau is None


def test_current_without_constants_is_kept_beside_commands(tmp_path: Path) -> None:
    columns = table(current_0=Q[:, 0], current_1=Q[:, 1], command_0=Q[:, 0], command_1=Q[:, 1])
    path = write_csv(tmp_path / "run.csv", columns)
    found = load_recording(path)
    assert found.tau is None
    assert found.warnings == ("holds motor current without torque constants: there is no torque, only commands",)
    np.testing.assert_array_equal(found.current, Q)
    np.testing.assert_array_equal(load_recording(path, torque_constant=[2.0, 3.0]).tau, Q * [2.0, 3.0])


def test_scale_of_commands(tmp_path: Path) -> None:
    columns = table(**{"goal1": 100 * Q[:, 0], "goal2": 100 * Q[:, 1]})
    path = write_csv(tmp_path / "run.csv", columns)
    found = load_recording(path, columns=ColumnMap({"command": "goal{i1}"}, scale={"command": 0.01}))
    np.testing.assert_allclose(found.command, Q, rtol=1e-12)


def test_a_broken_optional_signal_costs_that_signal_alone(tmp_path: Path) -> None:
    warm = np.full(200, 30.0)
    warm[7] = np.nan
    columns = table(tau_0=Q[:, 0], tau_1=Q[:, 1], temperature_0=warm, temperature_1=warm)
    found = load_recording(write_csv(tmp_path / "run.csv", columns))
    assert found.temperature is None
    assert found.warnings == ("line 9, column temperature_0: is not a number: temperature was not read",)
    columns = table(command_0=warm, command_1=warm)
    with pytest.raises(RecordingError, match=r"line 9, column command_0: is not a number"):
        load_recording(write_csv(tmp_path / "run.csv", columns))


def test_neither_torque_nor_command(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"neither torque \(tau_0.*nor motor current.*nor commanded positions"):
        load_recording(write_csv(tmp_path / "run.csv", table()))


def test_commands_follow_positions_over_the_end_of_the_encoder(tmp_path: Path) -> None:
    q = np.pi * np.sin(0.5 * TIME) + 3.0
    command = q + 0.02
    wrapped, told = ((x + np.pi) % (2 * np.pi) - np.pi for x in (q, command))
    path = write_csv(tmp_path / "run.csv", {"time": TIME, "q_0": wrapped, "command_0": told})
    found = load_recording(path)
    np.testing.assert_allclose(found.command - found.q, 0.02, atol=1e-9)


def test_kinds_of_columns() -> None:
    assert kind_of("command_velocity_3") == "command_velocity"
    assert kind_of("command_velocity") == "command_velocity"
    assert kind_of("command_wrist") == "command"
    assert kind_of("tau_") is None
    assert kind_of("torque_1") is None


def test_written_and_read_again(tmp_path: Path) -> None:
    recording = commanded(enabled=np.ones_like(Q), duty=0.1 * Q)
    found = load_recording(write_recording(recording, tmp_path / "run.parquet"))
    assert found.signals == ("q", "command", "enabled", "duty")
    np.testing.assert_array_equal(found.duty, 0.1 * Q)
