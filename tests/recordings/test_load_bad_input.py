"""Every way in which a recording file can be wrong: refused in one line, or survived with a warning."""

from __future__ import annotations

import gzip
import io
import os
import struct
import zipfile
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import scipy.io

from lagnet.errors import LagnetError, RecordingError
from lagnet.recordings.loading.column_map import ColumnMap
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.readers import source

N = 60
HEADER = "time,q_0,q_1,tau_0,tau_1"
ARM = SimpleNamespace(
    joints=("shoulder", "elbow"),
    n_dof=2,
    position_lower=np.array([-3.1, -2.0]),
    position_upper=np.array([3.1, 2.0]),
    joint_types=("revolute", "revolute"),
)


def lines(n: int = N, header: str = HEADER, start: float = 0.0) -> list[str]:
    """A two-joint swing, one text line a sample."""
    time = start + 0.01 * np.arange(n)
    rows = np.column_stack([time, np.sin(time), np.cos(time), 10 * np.cos(time), 5 * np.sin(time)])
    return [header, *(",".join(f"{value:.6f}" for value in row) for row in rows)]


def replaced(line: int, text: str) -> list[str]:
    """The swing with one line (header is line 1) replaced."""
    table = lines()
    table[line - 1] = text
    return table


def save(folder: Path, content: list[str] | bytes, name: str = "run.csv") -> Path:
    """Write a file as given."""
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else ("\n".join(content) + "\n").encode())
    return path


REFUSED = {
    "missing time": (lines(header=HEADER.replace("time", "clock")), ["column time is missing", "clock"]),
    "missing position": (lines(header=HEADER.replace("q_1", "x")), ["q_1", "missing", "--columns"]),
    "missing torque": (lines(header=HEADER.replace("tau_1", "x")), ["tau_1", "missing"]),
    "no torque at all": (lines(header="time,q_0,q_1,x,y"), ["neither torque", "current"]),
    "half of the velocities": (
        [HEADER + ",v_1", *(line + ",0.0" for line in lines()[1:])],
        ["column v_0 (or v_shoulder) is missing", "leave out all v columns"],
    ),
    "doubled name": (
        [HEADER + ",q_0", *(line + ",0.0" for line in lines()[1:])],
        ["column q_0 stands 2 times in the header"],
    ),
    "index and name": (
        [HEADER + ",q_shoulder", *(line + ",0.0" for line in lines()[1:])],
        ["q_shoulder and q_0 both give joint shoulder"],
    ),
    "text": (replaced(5, "0.03,0.1,oops,1,1"), ["line 5", "column q_1", "'oops'", "not a number"]),
    "hexadecimal": (replaced(7, "0.05,0x10,0.1,1,1"), ["line 7", "column q_0", "'0x10'"]),
    "date": (replaced(2, "2024-01-01 10:00,0,0,1,1"), ["line 2", "column time"]),
    "nan": (replaced(9, "0.07,nan,0.1,1,1"), ["line 9", "column q_0", "NaN"]),
    "empty cell": (replaced(9, "0.07,0.1,0.1,,1"), ["line 9", "column tau_0", "empty cell"]),
    "infinite": (replaced(9, "0.07,0.1,0.1,1,inf"), ["line 9", "column tau_1", "infinite"]),
    "minus infinity": (replaced(9, "0.07,-inf,0.1,1,1"), ["line 9", "column q_0", "infinite"]),
    "time runs back": (replaced(9, "0.001,0.1,0.1,1,1"), ["line 9", "column time", "runs back", "0.001"]),
    "two motions without label": (
        lines() + lines()[1:],
        ["line 62", "time runs back", "trajectory column"],
    ),
    "too few samples": (lines(n=7), ["7 usable samples", "at least 20"]),
    "header only": ([HEADER], ["header but no samples"]),
    "empty": (b"", ["the file is empty"]),
    "blank": (b"\n\n  \n", ["the file is empty"]),
    "no header": (lines()[1:], ["no header line"]),
    "every line too long": (
        [HEADER, *(line + ",0.0" for line in lines()[1:])],
        ["60 of 60 lines do not have the 5 cells", "line 2"],
    ),
    "too many joints": (
        ["time,q_0,q_1,q_2,tau_0,tau_1,tau_2", *(line + ",0,0" for line in lines()[1:])],
        ["columns of 3 joints (q_0 … q_2)", "the robot has 2 (shoulder, elbow)"],
    ),
    "too few joints": (
        ["time,q_0,tau_0", *(line.rsplit(",", 2)[0] for line in lines()[1:])],
        ["columns of 1 joint (q_0)", "the robot has 2"],
    ),
    "names of another robot": (lines(header="time,q_a,q_b,tau_a,tau_b"), ["q_0 (or q_shoulder)", "missing"]),
    "binary": (b"PK\x03\x04\x00\x00\x00" + bytes(200), ["binary data"]),
    "utf-16": ("\n".join(lines()).encode("utf-16"), ["UTF-16", "UTF-8"]),
    "only newline-free bytes": (b"a" * 5_000_000, ["run.csv"]),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refuses_in_one_line_that_names_the_file_and_the_spot(case: str, tmp_path: Path) -> None:
    content, expected = REFUSED[case]
    path = save(tmp_path, content)
    with pytest.raises(RecordingError) as refusal:
        load_recording(path, robot=ARM)
    message = str(refusal.value)
    assert "\n" not in message
    assert message.startswith(str(path))
    for part in expected:
        assert part in message
    assert sorted(tmp_path.iterdir()) == [path]


DAMAGED_CSV_GZ = {
    "cut off": gzip.compress("\n".join(lines()).encode())[:-30],
    "flipped bits": bytes(
        b ^ (0xFF if 60 < i < 90 else 0) for i, b in enumerate(gzip.compress(bytes(range(256)) * 40))
    ),
    "empty": b"",
}


@pytest.mark.parametrize("case", DAMAGED_CSV_GZ)
def test_refuses_damaged_gzip(case: str, tmp_path: Path) -> None:
    path = save(tmp_path, DAMAGED_CSV_GZ[case], "run.csv.gz")
    with pytest.raises(RecordingError, match=r"middle of its compressed data|damaged gzip|is empty"):
        load_recording(path, robot=ARM)


def test_refuses_what_is_no_recording_file(tmp_path: Path) -> None:
    for name, expected in (("run.xlsx", "unknown kind of file"), ("gone.csv", "does not exist")):
        with pytest.raises(RecordingError, match=expected):
            load_recording(tmp_path / name)
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(RecordingError, match="is a folder"):
        load_recording(tmp_path / "folder.csv")


def test_refuses_more_than_fits_in_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ("source", "csv_file", "npz_file"):
        path = f"lagnet.recordings.readers.{module}.MAX_BYTES"
        monkeypatch.setattr(path, 10_000, raising=False)
    bomb = save(tmp_path, gzip.compress(b"time,q_0,tau_0\n" + b"0,0,0\n" * 100_000), "bomb.csv.gz")
    with pytest.raises(RecordingError, match=r"more than .* after decompression; split it"):
        load_recording(bomb)
    np.savez_compressed(tmp_path / "bomb.npz", time=np.zeros(10_000), q=np.zeros(10_000), tau=np.zeros(10_000))
    with pytest.raises(RecordingError, match="after decompression"):
        load_recording(tmp_path / "bomb.npz")
    pq.write_table(pa.table({n: np.zeros(10_000) for n in ("time", "q_0", "tau_0")}), tmp_path / "bomb.parquet")
    with pytest.raises(RecordingError, match="after decompression"):
        load_recording(tmp_path / "bomb.parquet")
    scipy.io.savemat(tmp_path / "bomb.mat", dict.fromkeys(("time", "q", "tau"), np.zeros(10_000)), do_compression=True)
    with pytest.raises(RecordingError, match="after decompression"):
        load_recording(tmp_path / "bomb.mat")
    assert source.MAX_BYTES == 10_000


def test_never_unpickles_objects_in_npz(tmp_path: Path) -> None:
    class Trap:
        def __reduce__(self):
            return (Path.touch, (tmp_path / "sprung",))

    trap = np.array([Trap()] * N, dtype=object)
    np.savez(tmp_path / "run.npz", time=np.arange(N) * 0.01, q=trap, tau=np.zeros(N))
    with pytest.raises(RecordingError, match="array q holds Python objects, which are never loaded"):
        load_recording(tmp_path / "run.npz")
    assert not (tmp_path / "sprung").exists()


def test_refuses_an_npz_that_lies_about_its_size(tmp_path: Path) -> None:
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": (10**12,)})
    with zipfile.ZipFile(tmp_path / "run.npz", "w") as archive:
        for name in ("time", "q", "tau"):
            archive.writestr(f"{name}.npy", header.getvalue() + bytes(80))
    with pytest.raises(RecordingError, match="after decompression"):
        load_recording(tmp_path / "run.npz")


@pytest.mark.parametrize("name", ["run.parquet", "run.npz", "run.mat"])
@pytest.mark.parametrize(
    "content", [b"time,q_0\n" * 50, bytes(300), b"PAR1" + bytes(80) + b"PAR1", b"PK\x03\x04" + bytes(99)]
)
def test_refuses_damaged_containers(name: str, content: bytes, tmp_path: Path) -> None:
    with pytest.raises(RecordingError) as refusal:
        load_recording(save(tmp_path, content, name))
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("suffix", ["parquet", "npz", "mat"])
def test_a_file_cut_or_corrupted_anywhere_is_refused_or_read_never_a_crash(suffix: str, tmp_path: Path) -> None:
    columns = {"time": 0.01 * np.arange(N), "q": np.zeros((N, 2)), "tau": np.ones((N, 2))}
    path = tmp_path / f"run.{suffix}"
    if suffix == "npz":
        np.savez_compressed(path, **columns)
    elif suffix == "mat":
        scipy.io.savemat(path, columns, do_compression=True)
    else:
        flat = {"time": columns["time"]} | {f"{k}_{i}": columns[k][:, i] for k in ("q", "tau") for i in range(2)}
        pq.write_table(pa.table(flat), path)
    whole = path.read_bytes()
    random = np.random.default_rng(0)
    for _ in range(150):
        damaged = bytearray(whole[: random.integers(1, len(whole) + 1)])
        damaged[random.integers(len(damaged))] ^= int(random.integers(1, 256))
        path.write_bytes(bytes(damaged))
        with suppress(LagnetError):
            assert load_recording(path, n_dof=2).q.shape[1] == 2


def test_refuses_matlab_7_3(tmp_path: Path) -> None:
    header = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + struct.pack("<H", 0x0200) + b"IM"
    with pytest.raises(RecordingError, match=r"MATLAB 7.3.*-v7"):
        load_recording(save(tmp_path, header.ljust(512, b"\0") + b"\x89HDF\r\n\x1a\n", "run.mat"))


def test_matlab_structs_and_cells_are_not_built(tmp_path: Path) -> None:
    scipy.io.savemat(tmp_path / "run.mat", {"time": {"a": 1}, "q": np.zeros((N, 1)), "tau": np.zeros((N, 1))})
    with pytest.raises(RecordingError, match="column time is missing"):
        load_recording(tmp_path / "run.mat")


def test_arrays_of_different_length_are_named(tmp_path: Path) -> None:
    np.savez(tmp_path / "run.npz", time=np.arange(N) * 0.01, q=np.zeros((N - 1, 1)), tau=np.zeros((N, 1)))
    with pytest.raises(RecordingError, match=r"different lengths \(time 60, q_0 59, tau_0 60\)"):
        load_recording(tmp_path / "run.npz")


@pytest.mark.parametrize(("joint", "factor"), [("shoulder", 57.3), ("elbow", 57.3)])
def test_degrees_are_refused_with_the_scale_that_mends_them(joint: str, factor: float, tmp_path: Path) -> None:
    time = 0.01 * np.arange(300)
    q = np.column_stack([0.5 * np.sin(time), 0.5 * np.sin(time)])
    q[:, ARM.joints.index(joint)] *= factor
    path = tmp_path / "run.npz"
    np.savez(path, time=time, q=q, tau=np.zeros_like(q))
    with pytest.raises(RecordingError, match=rf"\({joint}\).*degrees.*\[scale\].*0\.01745329"):
        load_recording(path, robot=ARM)
    mended = load_recording(path, robot=ARM, columns=ColumnMap(scale={f"q_{joint}": 1 / factor}))
    np.testing.assert_allclose(mended.q[:, 0], mended.q[:, 1], rtol=1e-12)


def test_degrees_are_refused_without_a_robot_and_a_stated_unit_is_believed(tmp_path: Path) -> None:
    time = 0.01 * np.arange(300)
    path = tmp_path / "run.npz"
    np.savez(path, time=time, q=90 * np.sin(time), tau=time)
    with pytest.raises(RecordingError, match="degrees instead of rad"):
        load_recording(path)
    assert load_recording(path, columns=ColumnMap(scale={"q": 1.0})).q.max() > 80
    assert load_recording(path, columns=ColumnMap(scale={"q": np.pi / 180})).q.max() < np.pi / 2


def test_a_continuous_joint_may_turn_and_one_glitch_is_no_unit(tmp_path: Path) -> None:
    time = 0.01 * np.arange(300)
    wheel = SimpleNamespace(
        joints=("wheel",),
        n_dof=1,
        position_lower=np.array([-np.inf]),
        position_upper=np.array([np.inf]),
        joint_types=("continuous",),
    )
    np.savez(tmp_path / "wheel.npz", time=time, q=30 * time, tau=time)
    assert load_recording(tmp_path / "wheel.npz", robot=wheel).n_dof == 1
    q = np.column_stack([np.sin(time), np.sin(time)])
    q[7, 0] = 150.0
    np.savez(tmp_path / "glitch.npz", time=time, q=q, tau=q)
    assert load_recording(tmp_path / "glitch.npz", robot=ARM).n_dof == 2


def test_limits_that_a_robot_file_left_at_zero_say_nothing(tmp_path: Path) -> None:
    time = 0.01 * np.arange(300)
    q = np.column_stack([6 * np.sin(time), 6 * np.sin(time)])
    np.savez(tmp_path / "run.npz", time=time, q=q, tau=q)
    unset = SimpleNamespace(**{**vars(ARM), "position_lower": np.zeros(2), "position_upper": np.zeros(2)})
    assert load_recording(tmp_path / "run.npz", robot=unset).n_dof == 2
    bare = SimpleNamespace(joints=ARM.joints, n_dof=2)
    assert load_recording(tmp_path / "run.npz", robot=bare).n_dof == 2


def test_millimetres_and_degrees_per_second_are_refused(tmp_path: Path) -> None:
    time = 0.01 * np.arange(300)
    rail = SimpleNamespace(
        joints=("rail",),
        n_dof=1,
        position_lower=np.array([0.0]),
        position_upper=np.array([0.8]),
        joint_types=("prismatic",),
    )
    np.savez(tmp_path / "mm.npz", time=time, q=400 + 300 * np.sin(time), tau=time)
    with pytest.raises(RecordingError, match=r"millimetres instead of m.*0\.001"):
        load_recording(tmp_path / "mm.npz", robot=rail)
    np.savez(tmp_path / "deg.npz", time=time, q=0.1 * np.sin(time), v=np.degrees(0.1 * np.cos(time)), tau=time)
    with pytest.raises(RecordingError, match=r"v_0 .*degrees per second.*\[scale\]"):
        load_recording(tmp_path / "deg.npz")
    np.savez(tmp_path / "rad.npz", time=time, q=0.1 * np.sin(time), v=0.1 * np.cos(time), tau=time)
    assert load_recording(tmp_path / "rad.npz").v is not None


CURRENT = [line.replace("tau", "current") for line in lines()]


def test_current_needs_torque_constants_and_says_how(tmp_path: Path) -> None:
    path = save(tmp_path, CURRENT)
    with pytest.raises(RecordingError, match=r"torque constant .*\[torque_constant\] values = .*2 numbers"):
        load_recording(path)
    with pytest.raises(RecordingError, match="3 torque constants were given for 2 joints"):
        load_recording(path, torque_constant=[1, 2, 3])
    torque = load_recording(save(tmp_path, lines(), "torque.csv")).tau
    np.testing.assert_array_equal(load_recording(path, torque_constant=[2.0, 3.0]).tau, torque * [2.0, 3.0])
    constants = ColumnMap(torque_constant=(2.0, 3.0))
    np.testing.assert_array_equal(load_recording(path, columns=constants).tau, torque * [2.0, 3.0])
    np.testing.assert_array_equal(load_recording(path, columns=constants, torque_constant=5.0).tau, torque * 5.0)


def test_contradicting_arguments_are_refused(tmp_path: Path) -> None:
    path = save(tmp_path, lines())
    with pytest.raises(RecordingError, match="n_dof = 3 was given with 2 joint names"):
        load_recording(path, joints=["a", "b"], n_dof=3)
    with pytest.raises(RecordingError, match="has columns of 2 joints"):
        load_recording(path, n_dof=1)
    with pytest.raises(RecordingError, match="limits are given for 1 of 2 joints"):
        load_recording(path, limits=np.array([[-1.0, 1.0]]))
    with pytest.raises(RecordingError, match="n_dof must be at least 1"):
        load_recording(path, n_dof=0)


def test_a_pipe_is_told_as_one_and_not_opened(tmp_path) -> None:
    os.mkfifo(tmp_path / "run.csv")
    with pytest.raises(RecordingError, match="is a pipe"):
        load_recording(tmp_path / "run.csv")
