"""`lagnet data inspect`: what it says, and that the mapping file it writes can be used."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.recordings.made_logs import MAKERS, TIME, Q, lerobot

import lagnet
from lagnet.cli.main import main
from lagnet.recordings.inspection.guess_columns import guess_columns
from lagnet.recordings.loading.column_map import read_column_map
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.recording import Recording
from lagnet.recordings.writing import write_recording


@pytest.mark.parametrize("maker", ["bare mcap", "LeRobot v3.0", "motion folder", "servo bench", "RTDE with spaces"])
def test_every_format_is_described(
    maker: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    path = MAKERS[maker](tmp_path)
    monkeypatch.chdir(tmp_path)
    assert main(["data", "inspect", str(path)]) == 0
    said = capsys.readouterr().out
    for word in ("recognised by", "joints:", "samples: 120", "signal: q [rad]", "clock: ", "100 Hz"):
        assert word in said
    written = tmp_path / f"{path.name}.columns.toml"
    found = load_recording(path, columns=read_column_map(written))
    np.testing.assert_array_equal(found.q, load_recording(path).q)


def test_a_made_clock_and_a_refusal_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = lerobot(tmp_path, state=57.3 * Q, action=57.3 * Q)
    assert main(["data", "inspect", str(path), "--out", str(tmp_path / "map.toml")]) == 0
    said = capsys.readouterr().out
    assert "refused as it stands" in said
    assert "degrees" in said
    assert "degrees" in (tmp_path / "map.toml").read_text()


def test_foreign_columns_are_guessed_into_the_mapping_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "log.csv"
    names = ["Timestamp", "pos1", "pos2", "vel1", "vel2", "desired_pos1", "desired_pos2"]
    rows = np.column_stack([TIME, Q[:, :2], 0 * Q[:, :2], Q[:, :2] + 0.1])
    path.write_text("\n".join([",".join(names), *(",".join(map(repr, row)) for row in rows.tolist())]))
    assert main(["data", "inspect", str(path), "--out", str(tmp_path / "map.toml")]) == 0
    assert "7 were guessed" in capsys.readouterr().out
    found = load_recording(path, columns=tmp_path / "map.toml")
    np.testing.assert_array_equal(found.command, Q[:, :2] + 0.1)


def test_guesses() -> None:
    found = guess_columns(["time", "motor_2_position", "motor_1_position", "motor_1_current", "motor_2_current"])
    assert found == {
        "time": "time",
        "q_0": "motor_1_position",
        "q_1": "motor_2_position",
        "current_0": "motor_1_current",
        "current_1": "motor_2_current",
    }
    assert guess_columns(["time", "q_0", "tau_0"]) == {}
    assert guess_columns(["a", "b"]) == {}


def test_a_current_in_the_effort_column_is_mapped_as_one(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    robot = lagnet.load_robot("ur5")
    time = 0.01 * np.arange(1500)
    rate = np.array([1.1, 1.7, 2.3, 2.9, 1.3, 3.1])
    q = (
        0.6 * np.sin(rate * time[:, None])
        + 0.3 * np.sin(0.37 * rate * time[:, None])
        + [0.0, -1.0, 1.0, -1.0, 0.5, 0.0]
    )
    v, a = np.gradient(q, time, axis=0), np.gradient(np.gradient(q, time, axis=0), time, axis=0)
    size = np.array([8.0, 12.0, 6.0, 2.0, 1.5, 1.0])
    current = (robot.inverse_dynamics(q, v, a) + size * np.tanh(v / 0.01)) / [12.0, 15.0, 9.0, 7.0, 10.0, 6.0]
    path = write_recording(Recording(time, q, current, robot.joints), tmp_path / "run.csv")
    assert main(["data", "inspect", str(path), "--robot", "ur5", "--out", str(tmp_path / "map.toml")]) == 0
    assert "most likely holds motor current" in capsys.readouterr().out
    found = load_recording(path, robot=robot, columns=tmp_path / "map.toml", torque_constant=10.0)
    np.testing.assert_allclose(found.tau, 10 * current, rtol=1e-12)


def test_what_is_no_log_ends_in_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["data", "inspect", str(tmp_path)]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not list(tmp_path.iterdir())
