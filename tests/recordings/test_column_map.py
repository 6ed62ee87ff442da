"""Foreign names, units and torque constants through a mapping file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import scipy.io

from lagnet.errors import RecordingError
from lagnet.recordings.loading.column_map import ColumnMap, read_column_map
from lagnet.recordings.loading.load import load_recording


def write(folder: Path, text: str) -> Path:
    path = folder / "map.toml"
    path.write_text(text)
    return path


def table(folder: Path, header: str | None, n_columns: int, name: str = "run.csv") -> tuple[Path, np.ndarray]:
    """A file of smooth numbers."""
    values = np.sin(0.01 * np.arange(50)[:, None] * (1 + np.arange(n_columns)))
    values[:, 0] = 10.0 * np.arange(50)
    path = folder / name
    np.savetxt(path, values, delimiter=",", header=header or "", comments="", fmt="%.17g")
    if header is None:
        path.write_bytes(path.read_bytes().lstrip(b"\n"))
    return path, values


def test_names_units_and_constants_of_a_foreign_log(tmp_path: Path) -> None:
    path, values = table(tmp_path, "timestamp,actual_q_0,actual_q_1,qd1,qd2,I_0,I_1", 7)
    mapping = write(
        tmp_path,
        '[columns]\ntime = "timestamp"\nq = "actual_q_{i}"\nv = "qd{i1}"\n"current_0" = "I_0"\n"current_1" = "I_1"\n'
        "[scale]\ntime = 1e-3\nq = 0.5\nq_1 = 0.25\nv = 2\n[torque_constant]\nvalues = [10, 20]\n",
    )
    found = load_recording(path, columns=mapping)
    np.testing.assert_array_equal(found.time, values[:, 0] * 1e-3)
    np.testing.assert_array_equal(found.q, values[:, 1:3] * [0.5, 0.25])
    np.testing.assert_array_equal(found.v, values[:, 3:5] * 2)
    np.testing.assert_array_equal(found.tau, values[:, 5:7] * [10, 20])


def test_joint_names_in_patterns_and_keys(tmp_path: Path) -> None:
    path, values = table(tmp_path, "time,pos_pan,pos_lift,eff_pan,eff_lift", 5)
    mapping = ColumnMap(
        {"q": "pos_{joint}", "tau_pan": "eff_pan", "tau_1": "eff_lift"}, {"time": 0.001, "tau_lift": 3.0}
    )
    found = load_recording(path, columns=mapping, joints=("pan", "lift"))
    np.testing.assert_array_equal(found.q, values[:, 1:3])
    np.testing.assert_array_equal(found.tau, values[:, 3:5] * [1, 3])


def test_a_file_without_header_is_read_by_column_numbers(tmp_path: Path) -> None:
    path, values = table(tmp_path, None, 4)
    mapping = ColumnMap({"time": "column_0", "q_0": "column_3", "tau_0": "column_1"}, {"time": 0.001})
    found = load_recording(path, columns=mapping)
    assert len(found) == 50
    np.testing.assert_array_equal(found.q[:, 0], values[:, 3])


def test_arrays_of_a_mat_file_are_mapped(tmp_path: Path) -> None:
    time = 0.001 * np.arange(100)
    scipy.io.savemat(tmp_path / "run.mat", {"t": time, "qm": np.sin(time), "vir": np.cos(time), "pose": np.eye(4)})
    mapping = write(tmp_path, '[columns]\n"q_0" = "qm"\n"tau_0" = "vir"\n[scale]\ntau = 35.15\n')
    found = load_recording(tmp_path / "run.mat", columns=mapping)
    np.testing.assert_array_equal(found.tau[:, 0], np.cos(time) * 35.15)
    matrix = {"t": time, "qm": np.column_stack([time, -time]), "eff": np.column_stack([time, time])}
    scipy.io.savemat(tmp_path / "two.mat", matrix)
    two = load_recording(tmp_path / "two.mat", columns=ColumnMap({"q": "qm", "tau": "eff"}))
    np.testing.assert_array_equal(two.q, matrix["qm"])


REFUSED = {
    "not TOML": ("q_0 = = 3", "is not valid TOML"),
    "unknown section": ("[colums]\nq_0 = 'x'", r"\[colums\] is no section.*columns, scale, offset, torque_constant"),
    "unknown signal": ("[columns]\nposition_0 = 'x'", r"position_0 is no column of ours"),
    "misspelt kind": ("[columns]\ntraj = 'x'", "did you mean trajectory"),
    "number for a name": ("[columns]\nq_0 = 3", "must be the file's column name, in quotes"),
    "text for a factor": ("[scale]\nq = 'deg'", "must be a number other than zero, not 'deg'"),
    "zero factor": ("[scale]\nq = 0", "other than zero"),
    "boolean factor": ("[scale]\nq = true", "must be a number"),
    "infinite factor": ("[scale]\nq = inf", "must be a number"),
    "scaled labels": ("[scale]\ntrajectory = 2.0", "has no unit"),
    "one constant": ("[torque_constant]\nvalues = 3.0", "must hold one list"),
    "other key": ("[torque_constant]\nvalue = [3.0]", "must hold one list"),
    "text constants": ("[torque_constant]\nvalues = ['a']", "must be numbers"),
    "section is a value": ("columns = 3", r"\[columns\] is no section"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refuses_a_mapping_that_means_nothing(case: str, tmp_path: Path) -> None:
    text, expected = REFUSED[case]
    path = write(tmp_path, text)
    with pytest.raises(RecordingError, match=expected) as refusal:
        read_column_map(path)
    assert str(refusal.value).startswith(str(path))
    assert "\n" not in str(refusal.value)


def test_refuses_a_mapping_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="cannot be read"):
        read_column_map(tmp_path / "none.toml")
    (tmp_path / "big.toml").write_bytes(b"#" * 2_000_000)
    with pytest.raises(RecordingError, match="too long for a mapping"):
        read_column_map(tmp_path / "big.toml")
    (tmp_path / "deep.toml").write_text("a = " + "[" * 100_000)
    with pytest.raises(RecordingError, match="not valid TOML"):
        read_column_map(tmp_path / "deep.toml")


def test_a_mapped_column_that_the_file_lacks_is_named_with_the_nearest(tmp_path: Path) -> None:
    path, _ = table(tmp_path, "time,actual_q_0,tau_0", 3)
    with pytest.raises(RecordingError, match=r"column 'actual_q0', which mapping gives as q_0, .*'actual_q_0'"):
        load_recording(path, columns=ColumnMap({"q_0": "actual_q0"}))
    with pytest.raises(RecordingError, match=r"mapped to 2 signals"):
        load_recording(path, columns=ColumnMap({"q_0": "tau_0"}))
    with pytest.raises(RecordingError, match=r"gives as trajectory"):
        load_recording(path, columns=ColumnMap({"q_0": "actual_q_0", "trajectory": "run"}))
