"""The real recordings load, and their flaws are told."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from lagnet.errors import RecordingError
from lagnet.recordings.datasets.characters import TEST_LETTERS, load_characters
from lagnet.recordings.datasets.sarcos import load_sarcos
from lagnet.recordings.loading.column_map import ColumnMap
from lagnet.recordings.loading.load import load_recording

pytestmark = pytest.mark.shared_data
UR10E = [14.87, 13.26, 11.13, 10.62, 11.03, 11.47]
MOVED = 0.01  # [rad]
SIZES = {"fit_0": 3691, "fit_1": 4639, "fit_2": 5457, "fit_3": 5375, "holdout": 5347}


@pytest.mark.parametrize("name", SIZES)
def test_ur10e(name: str, shared_data: Path) -> None:
    recording = load_recording(shared_data / "ur10e" / f"{name}.csv.gz", torque_constant=UR10E)
    assert len(recording) == SIZES[name]
    assert recording.n_dof == 6
    assert recording.v is not None
    assert 90 < (len(recording) - 1) / recording.duration < 97  # "~94 Hz with jitter"
    assert any("clock jitters" in warning for warning in recording.warnings)
    assert np.all(np.percentile(recording.v, 5, axis=0) < 0)  # every joint turns both ways
    assert np.all(np.percentile(recording.v, 95, axis=0) > 0)


@pytest.mark.parametrize("name", ["joint_0_alone", "joint_1_alone", "joint_2_alone", "point_to_point"])
def test_ur10e_special_runs(name: str, shared_data: Path) -> None:
    recording = load_recording(shared_data / "ur10e" / f"{name}.csv.gz", torque_constant=UR10E)
    moved = {*np.flatnonzero(np.ptp(recording.q, axis=0) > MOVED).tolist()}
    assert moved == ({int(name[6])} if name.endswith("alone") else set(range(6)))


def test_ur10e_raw_table_through_a_mapping(shared_data: Path) -> None:
    kinds = ("q", "v", "current")
    columns = {f"{kind}_{i}": f"column_{1 + 6 * k + i}" for k, kind in enumerate(kinds) for i in range(6)}
    mapping = ColumnMap({"time": "column_0", **columns}, torque_constant=tuple(UR10E))
    raw = load_recording(shared_data / "ur10e" / "raw" / "ur-20_02_10-30sec_12harm.csv", columns=mapping)
    ours = load_recording(shared_data / "ur10e" / "fit_0.csv.gz", torque_constant=UR10E)
    np.testing.assert_array_equal(raw.q, ours.q)
    np.testing.assert_allclose(raw.tau, ours.tau, rtol=1e-6)  # written with seven digits


def test_a_ur10e_file_cut_anywhere_still_reads(shared_data: Path, tmp_path: Path) -> None:
    import gzip

    text = gzip.decompress((shared_data / "ur10e" / "fit_0.csv.gz").read_bytes())
    whole = load_recording(shared_data / "ur10e" / "fit_0.csv.gz", torque_constant=UR10E)
    rng = np.random.default_rng(1)
    for cut in rng.integers(100_000, len(text), 20):
        path = tmp_path / "cut.csv"
        path.write_bytes(text[:cut])
        found = load_recording(path, torque_constant=UR10E)
        complete = text[:cut].count(b"\n") - 1
        assert complete <= len(found) <= complete + 1
        np.testing.assert_array_equal(found.q[:complete], whole.q[:complete])


def test_staubli_tx40(shared_data: Path) -> None:
    fit = load_recording(shared_data / "staubli_tx40" / "fit.csv.gz")
    assert (len(fit), fit.n_dof, fit.warnings) == (6000, 6, ())
    assert fit.rate == pytest.approx(1000)
    assert len(load_recording(shared_data / "staubli_tx40" / "holdout.csv.gz")) == 3000


def test_emps_and_its_raw_matlab_file(shared_data: Path) -> None:
    fit = load_recording(shared_data / "emps" / "fit.csv.gz")
    mapping = ColumnMap({"time": "t", "q_0": "qm", "tau_0": "vir"}, {"tau": 35.15065188})
    raw = load_recording(shared_data / "emps" / "raw" / "DATA_EMPS.mat", columns=mapping)
    assert len(raw) == 24841
    np.testing.assert_allclose(raw.tau[:16000], fit.tau, rtol=1e-6, atol=1e-4)  # written with seven digits
    np.testing.assert_allclose(raw.q[:16000], fit.q, atol=1e-6)


def test_sarcos(shared_data: Path) -> None:
    path = shared_data / "sarcos" / "sarcos_inv_test.mat"
    samples = load_sarcos(path)
    assert len(samples) == 4449
    assert samples.q.shape == samples.tau.shape == (4449, 7)
    assert samples.a is not None
    assert samples.rate == 0
    assert len({len(part) for part in samples.parts()}) == 1
    with pytest.raises(RecordingError, match="load_sarcos"):
        load_recording(path)
    with pytest.raises(RecordingError, match="0 arrays of 28 columns"):
        load_sarcos(shared_data / "emps" / "raw" / "DATA_EMPS.mat")


def test_characters(shared_data: Path, tmp_path: Path) -> None:
    path = shared_data / "delan_characters" / "characters.npz"
    data = load_characters(path)
    recording = data.recording
    assert (len(recording), recording.n_dof, len(recording.trajectory_names)) == (2913, 2, 20)
    assert recording.rate == pytest.approx(25)
    parts = data.inertial_torque + data.coriolis_torque + data.gravity_torque
    np.testing.assert_allclose(parts, recording.tau, atol=1e-6)
    test = data.letters(TEST_LETTERS)
    assert {recording.trajectory_names[k] for k in recording.trajectory[test]} == {"e", "q", "v"}
    inertial = np.einsum("nij,nj->ni", data.mass_matrix, recording.a)
    np.testing.assert_allclose(inertial, data.inertial_torque, atol=1e-6)
    with np.load(path) as arrays:
        np.savez(tmp_path / "plain.npz", **{name: arrays[name] for name in ("t", "q", "tau", "offsets")})
    with pytest.raises(RecordingError, match=r"array inertial_torque is not of shape \(2913, 2\)"):
        load_characters(tmp_path / "plain.npz")
