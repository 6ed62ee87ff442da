"""Broken inputs of every kind end in a result or in one clear line, soon. The long run is validation/fuzz."""

from __future__ import annotations

import io
import os
import zipfile

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from validation.fuzz.run import fuzz

from lagnet.cli.main import main
from lagnet.errors import LagnetError
from lagnet.models.files.loading import load_any
from lagnet.recordings.loading.column_map import read_column_map
from lagnet.recordings.loading.load import load_recording

INPUTS = 200  # of seeded mutation
HEAD = "time," + ",".join(f"{kind}_{j}" for kind in ("q", "tau") for j in range(2))


def test_broken_files_end_in_a_result_or_one_line() -> None:
    found = fuzz(INPUTS, seed=20)
    assert not found.faults
    assert found.refused > 0.5 * INPUTS


@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.lists(st.floats(width=64) | st.text(max_size=4), min_size=5, max_size=5), max_size=30))
def test_any_table_is_read_or_refused(tmp_path, rows) -> None:
    path = tmp_path / "run.csv"
    path.write_text("\n".join([HEAD, *(",".join(map(str, row)) for row in rows)]), encoding="utf-8")
    told = ""
    try:
        read = len(load_recording(path))
    except LagnetError as error:
        read, told = 0, str(error)
    assert read <= len(rows)
    assert (read > 0) != bool(told)
    assert "\n" not in told


@pytest.mark.parametrize("value", ["1e300", "-1e308", "1e13"])
def test_one_cell_far_too_large_is_told_with_its_place(tmp_path, value) -> None:
    rows = [[0.01 * k, np.sin(k), np.cos(k), 1.0 + k % 3, 2.0 - k % 2] for k in range(60)]
    rows[17][3] = value
    (tmp_path / "run.csv").write_text("\n".join([HEAD, *(",".join(map(str, row)) for row in rows)]), encoding="utf-8")
    with pytest.raises(LagnetError, match=r"line 19, column tau_0"):
        load_recording(tmp_path / "run.csv")


@pytest.mark.parametrize("read", [read_column_map, load_any, load_recording], ids=["map", "robot", "recording"])
def test_pipes_are_refused_and_not_waited_for(read, tmp_path) -> None:
    os.mkfifo(tmp_path / "input.csv")
    with pytest.raises(LagnetError):
        read(tmp_path / "input.csv")


@pytest.mark.parametrize("method", [zipfile.ZIP_LZMA, zipfile.ZIP_BZIP2])
@pytest.mark.parametrize("at", [40, 80, 140, 200])
def test_archives_of_other_methods_that_are_damaged(tmp_path, method, at) -> None:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", method) as archive:
        for name in ("time", "q", "tau"):
            content = io.BytesIO()
            np.save(content, np.random.default_rng(0).standard_normal((60, 2)))
            archive.writestr(f"{name}.npy", content.getvalue())
    data = bytearray(stream.getvalue())
    data[at : at + 6] = b"\xff" * 6
    (tmp_path / "run.npz").write_bytes(data)
    with pytest.raises(LagnetError):
        load_recording(tmp_path / "run.npz")


@pytest.mark.parametrize(
    "words",
    [
        ["diagnose", "run.csv", "--robot", "ur5", "--bandwidth", "0"],
        ["diagnose", "run.csv", "--robot", "ur5", "--bandwidth", "-5"],
        ["diagnose", "run.csv", "--robot", "ur5", "--bandwidth", "nan"],
        ["diagnose", "run.csv", "--robot", "ur5", "--bandwidth", "inf"],
        ["diagnose", "run.csv", "--robot", "ur5", "--seed", "-1"],
        ["diagnose", "run.csv", "--robot", "ur5", "--torque-constant", "a"],
        ["diagnose", "run.csv", "--robot", "ur5", "--torque-constant", "nan"],
        ["train", "run.csv", "--minutes", "inf"],
        ["train", "run.csv", "--minutes", "-1"],
        ["train", "run.csv", "--penalty", "nan"],
        ["train", "run.csv", "--steps", "0"],
        ["train", "run.csv", "--seed", "-1"],
        ["simulate", "--robot", "ur5", "--out", "x", "--rate", "nan"],
        ["simulate", "--robot", "ur5", "--out", "x", "--trajectories", "-2"],
        ["simulate", "--robot", "ur5", "--out", "x", "--hold", "a=nan"],
        ["check", "ur5", "--limit", "finite_output=nan"],
    ],
    ids=" ".join,
)
def test_numbers_on_the_command_line_have_their_range(words, capsys, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(words) == 2
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert words[-2].lstrip("-") in told or "nan" in told


def test_a_folder_does_not_hide_a_robot_of_its_name(tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "ur10").mkdir()
    assert load_any("ur10").n_dof == 6
    (tmp_path / "ur10" / "model.json").write_text("{}", encoding="utf-8")
    with pytest.raises(LagnetError, match=r"write \./ur10 for the folder"):
        load_any("ur10")


def test_names_of_any_length_and_many_joints_stay_one_short_line(tmp_path) -> None:
    many = "time," + ",".join(f"q_{'a' * 5000}{k}" for k in range(2000))
    (tmp_path / "run.csv").write_text(many + "\n" + ",".join("0" * 2001), encoding="utf-8")
    with pytest.raises(LagnetError) as caught:
        load_recording(tmp_path / "run.csv")
    assert len(str(caught.value)) < 10_000
