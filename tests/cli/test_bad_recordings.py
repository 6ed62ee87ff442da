"""Bad recordings through a command: exit code 2, one line, and no half-written output."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from lagnet.cli.main import main
from lagnet.recordings.datasets.derived import EMPS_URDF

TIME = 0.01 * np.arange(100)
GOOD = ["time,q_0,tau_0", *(f"{t:.4f},{0.1 * np.sin(t):.6f},{np.cos(t):.6f}" for t in TIME)]


def changed(line: int, text: str) -> list[str]:
    return [*GOOD[: line - 1], text, *GOOD[line:]]


BAD = {
    "text": (changed(41, "0.39,oops,1"), "line 41, column q_0: 'oops' is not a number"),
    "not a number": (changed(41, "0.39,nan,1"), "line 41, column q_0: is not a number (NaN or an empty cell)"),
    "back in time": (changed(41, "0.01,0.1,1"), "line 41, column time: time runs back from 0.38 to 0.01 s"),
    "missing column": (
        [line.replace("tau_0", "force") for line in GOOD],
        "has neither torque (tau_0) nor motor current",
    ),
    "doubled column": ([GOOD[0] + ",q_0", *(line + ",0" for line in GOOD[1:])], "column q_0 stands 2 times"),
    "millimetres": (["time,q_0,tau_0", *(f"{t},{200 + 90 * np.sin(t)},1" for t in TIME)], "millimetres instead of m"),
    "motor current": ([line.replace("tau_0", "current_0") for line in GOOD], "[torque_constant] values = [...]"),
    "too short": (GOOD[:9], "holds 8 usable samples, at least 20 are needed"),
    "another arm": (["time,q_0,q_1,tau_0,tau_1", *("0,0,0,0,0" for _ in TIME)], "columns of 2 joints (q_0 … q_1)"),
    "empty": ([], "the file is empty"),
}


@pytest.mark.parametrize("case", BAD)
def test_diagnose_refuses_and_writes_nothing(case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines, expected = BAD[case]
    robot, recording = tmp_path / "slide.urdf", tmp_path / "run.csv"
    robot.write_text(EMPS_URDF)
    recording.write_text("\n".join(lines))
    words = ["diagnose", str(recording), "--robot", str(robot), "--out", str(tmp_path / "out")]
    assert main(words) == 2
    told = capsys.readouterr().err
    assert told.startswith(f"lagnet: {recording}: ")
    assert expected in told
    assert told.count("\n") == 1
    assert sorted(path.name for path in tmp_path.iterdir()) == ["run.csv", "slide.urdf"]


def test_a_bad_mapping_file_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "slide.urdf").write_text(EMPS_URDF)
    (tmp_path / "run.csv").write_text("\n".join(GOOD))
    (tmp_path / "map.toml").write_text("[columns]\nq_0 = 3\n")
    words = ["diagnose", "run.csv", "--robot", "slide.urdf", "--columns", "map.toml"]
    words = [str(tmp_path / word) if "." in word else word for word in words]
    assert main([*words, "--out", str(tmp_path / "out")]) == 2
    assert "map.toml: [columns] q_0 must be the file's column name" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
