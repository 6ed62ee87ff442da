"""What every reader must do alike, and that writing and reading loses nothing."""

from __future__ import annotations

import hashlib
import tempfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.io
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from lagnet.errors import RecordingError
from lagnet.recordings.loading.column_map import ColumnMap
from lagnet.recordings.loading.load import READERS, load_recording
from lagnet.recordings.readers.source import RowNames
from lagnet.recordings.recording import Recording
from lagnet.recordings.signals import DRIVE_SIGNALS, JOINT_SIGNALS
from lagnet.recordings.writing import WRITERS, write_recording

JOINTS = ("pan", "lift", "elbow")
FINITE = st.floats(-1e6, 1e6, allow_subnormal=True)
FIELDS = ("time", "trajectory", *JOINT_SIGNALS)


def write_mat(recording: Recording, path: Path) -> Path:
    """MATLAB's view of a recording; the product reads this format and does not write it."""
    arrays = {name: getattr(recording, name) for name in ("time", *recording.signals)}
    if recording.trajectory_names != ("0",):
        arrays["trajectory"] = np.array([int(name) for name in recording.trajectory_names])[recording.trajectory]
    scipy.io.savemat(path, arrays, do_compression=True)
    return path


def swing(n_dof: int = 3, **changes) -> Recording:
    """A smooth motion of a few joints."""
    time = 0.01 * np.arange(80)
    q = np.sin(time[:, None] * (1 + np.arange(n_dof)))
    fields = {"time": time, "q": q, "tau": 3 * q, "joints": JOINTS[:n_dof], "v": np.cos(q), "a": -q} | changes
    return Recording(**fields)


def assert_same(found: Recording, expected: Recording) -> None:
    """Every number bit for bit."""
    for name in FIELDS:
        left, right = getattr(found, name), getattr(expected, name)
        assert (left is None) == (right is None), name
        if right is not None:
            np.testing.assert_array_equal(left, right, err_msg=name)
    assert found.trajectory_names == expected.trajectory_names
    assert found.warnings == ()


@st.composite
def recordings(draw) -> Recording:
    """Any recording: extreme numbers, with and without rates, one or several labelled motions."""
    n, n_dof = draw(st.integers(20, 40)), draw(st.integers(1, 3))
    matrix = hnp.arrays(np.float64, (n, n_dof), elements=FINITE)
    # An even clock between steps of 1 ms and 1 s: gaps and jitter have warnings, and tests, of their own.
    time = draw(st.floats(-1e5, 1e9)) + np.arange(n) * draw(st.sampled_from([0.001, 0.0078125, 0.1]))
    motions = draw(st.lists(st.integers(-5, 99), min_size=1, max_size=3, unique=True))
    labels = np.arange(n) * len(motions) // n
    told = draw(st.sets(st.sampled_from(DRIVE_SIGNALS)))
    return Recording(
        time=time,
        q=draw(matrix.map(lambda q: np.clip(q, -3, 3))),
        tau=draw(st.none() | matrix) if "command" in told else draw(matrix),
        joints=JOINTS[:n_dof],
        a=draw(st.none() | matrix),
        trajectory=labels,
        trajectory_names=tuple(map(str, motions)),
        **{name: draw(matrix) for name in sorted(told)},
    )


@pytest.mark.parametrize("suffix", [*WRITERS, ".mat"])
@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(recording=recordings())
def test_any_recording_survives_writing_and_reading(suffix: str, recording: Recording) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"run{suffix}"
        (write_mat if suffix == ".mat" else write_recording)(recording, path)
        found = load_recording(path, joints=recording.joints)
    for name in FIELDS:
        left, right = getattr(found, name), getattr(recording, name)
        assert (left is None) == (right is None)
        if right is not None:
            np.testing.assert_array_equal(left, right)
    assert found.trajectory_names == recording.trajectory_names


@pytest.mark.parametrize("suffix", READERS)
def test_every_reader_keeps_the_contract(suffix: str, tmp_path: Path) -> None:
    recording = swing(trajectory=np.repeat([0, 1], 40), trajectory_names=("7", "3"))
    path = tmp_path / f"run{suffix}"
    (write_mat if suffix == ".mat" else write_recording)(recording, path)
    found = load_recording(path, joints=JOINTS)
    assert_same(found, recording)
    assert found.joints == JOINTS
    assert found.path == str(path)
    assert found.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()
    assert not found.q.flags.writeable
    assert found.rate == pytest.approx(100)
    with pytest.raises(RecordingError, match=r"columns of 3 joints .*the robot has 2"):
        load_recording(path, joints=JOINTS[:2])


@pytest.mark.parametrize("suffix", READERS)
def test_every_reader_names_the_row_and_column_of_a_bad_number(suffix: str, tmp_path: Path) -> None:
    q = swing().q.copy()
    q[30, 1], q[50, 0] = np.nan, np.inf
    path = tmp_path / f"run{suffix}"
    (write_mat if suffix == ".mat" else write_recording)(swing(q=q), path)
    row = "line 32" if "csv" in suffix else "row 31"
    with pytest.raises(RecordingError, match=rf"{row}, column q_1: is not a number.*2 such cells"):
        load_recording(path)


@pytest.mark.parametrize("suffix", READERS)
def test_every_reader_finds_time_that_runs_back(suffix: str, tmp_path: Path) -> None:
    time = swing().time.copy()
    time[30] = 0.05
    path = tmp_path / f"run{suffix}"
    (write_mat if suffix == ".mat" else write_recording)(swing(time=time), path)
    with pytest.raises(RecordingError, match=r"(line 32|row 31), column time: time runs back from 0\.29 to 0\.05"):
        load_recording(path)


@pytest.mark.parametrize("suffix", WRITERS)
def test_written_bytes_are_the_same_every_time_and_nothing_else_is_left(suffix: str, tmp_path: Path) -> None:
    first = write_recording(swing(), tmp_path / "one" / f"run{suffix}").read_bytes()
    second = write_recording(swing(), tmp_path / "two" / f"run{suffix}").read_bytes()
    assert first == second
    assert [path.name for path in (tmp_path / "one").iterdir()] == [f"run{suffix}"]


def test_a_format_that_cannot_be_written_is_refused_before_anything_is_made(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"cannot write the format '\.mat'"):
        write_recording(swing(), tmp_path / "new" / "run.mat")
    assert not (tmp_path / "new").exists()


def test_a_failed_write_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write_recording(swing(), tmp_path / "run.csv")
    before = path.read_bytes()

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("lagnet.files.os.replace", fail)
    with pytest.raises(OSError, match="No space left"):
        write_recording(swing(n_dof=1), path)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["run.csv"]


@pytest.mark.parametrize("suffix", [".parquet", ".npz"])
def test_joint_names_in_the_file_put_columns_in_the_robots_order(suffix: str, tmp_path: Path) -> None:
    path = write_recording(swing(), tmp_path / f"run{suffix}")
    assert load_recording(path).joints == JOINTS
    robot = SimpleNamespace(joints=("elbow", "pan", "lift"), n_dof=3)
    np.testing.assert_array_equal(load_recording(path, robot=robot).q, swing().q[:, [2, 0, 1]])
    stranger = SimpleNamespace(joints=("a", "b", "c"), n_dof=3)
    np.testing.assert_array_equal(load_recording(path, robot=stranger).q, swing().q)


def test_joint_names_in_the_header_put_columns_in_the_robots_order(tmp_path: Path) -> None:
    path = write_recording(swing(), tmp_path / "run.csv")
    text = path.read_text()
    for i, joint in enumerate(JOINTS):
        text = text.replace(f"_{i},", f"_{joint},").replace(f"_{i}\n", f"_{joint}\n")
    path.write_text(text)
    assert load_recording(path).joints == JOINTS
    robot = SimpleNamespace(joints=("elbow", "pan", "lift"), n_dof=3)
    np.testing.assert_array_equal(load_recording(path, robot=robot).tau, swing().tau[:, [2, 0, 1]])


def test_joints_that_are_called_by_numbers(tmp_path: Path) -> None:
    path = write_recording(swing(), tmp_path / "run.csv")
    from_one = SimpleNamespace(joints=("1", "2", "3"), n_dof=3)
    np.testing.assert_array_equal(load_recording(path, robot=from_one).q, swing().q)
    text = path.read_text()
    for i in (2, 1, 0):
        text = text.replace(f"_{i},", f"_{i + 1},").replace(f"_{i}\n", f"_{i + 1}\n")
    path.write_text(text)
    np.testing.assert_array_equal(load_recording(path, robot=from_one).q, swing().q)


def test_row_names_count_what_was_left_out() -> None:
    rows = RowNames("line", 2, (3, 4, 8))
    assert [rows.of(i) for i in range(6)] == ["line 2", "line 5", "line 6", "line 7", "line 9", "line 10"]
    fewer = rows.without(np.array([1, 4]))
    assert [fewer.of(i) for i in range(4)] == ["line 2", "line 6", "line 7", "line 10"]


@pytest.mark.parametrize("dtype", ["float32", "float64", "int64", "uint16", "timestamp", "string", "dictionary"])
def test_parquet_columns_of_other_types(dtype: str, tmp_path: Path) -> None:
    """Numbers of any kind are read as float64; dates and text are refused by name."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    clock = pa.array(10 * np.arange(80))
    kinds = {"timestamp": pa.timestamp("ns"), "string": pa.string()}
    column = clock.dictionary_encode() if dtype == "dictionary" else clock.cast(kinds.get(dtype, dtype))
    table = pa.table({"time": column, "q_0": np.zeros(80), "tau_0": np.zeros(80)})
    pq.write_table(table, tmp_path / "run.parquet")
    if dtype in kinds:
        with pytest.raises(RecordingError, match=r"column time holds (timestamp|string).*not numbers"):
            load_recording(tmp_path / "run.parquet")
    else:
        np.testing.assert_array_equal(load_recording(tmp_path / "run.parquet").time, 10.0 * np.arange(80))


def test_a_clock_in_nanoseconds_since_1970(tmp_path: Path) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    start = 1_700_000_000_123_456_789
    table = pa.table({"time": start + 10_000_000 * np.arange(80), "q_0": np.zeros(80), "tau_0": np.zeros(80)})
    pq.write_table(table, tmp_path / "run.parquet")
    found = load_recording(tmp_path / "run.parquet", columns=ColumnMap(scale={"time": 1e-9}))
    np.testing.assert_allclose(np.diff(found.time), 0.01, atol=1e-6)
