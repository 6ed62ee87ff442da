"""What every reader of foreign logs must do alike."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from tests.recordings.made_logs import EXPECTED, MAKERS, TIME, N, holds, lerobot, made_bag, motion_folder

from lagnet.errors import LagnetError, RecordingError
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.loading.opening import open_source, origin_of, recordings_in

FUZZ = 8  # damaged copies of each format


@pytest.mark.parametrize("maker", MAKERS)
def test_numbers_come_back(maker: str, tmp_path: Path) -> None:
    path = MAKERS[maker](tmp_path)
    found = load_recording(path)
    assert found.signals == holds(maker)
    np.testing.assert_allclose(found.time - found.time[0], TIME, atol=2e-9)
    for kind in set(found.signals) & set(EXPECTED):
        expected = EXPECTED[kind][:, : found.n_dof]
        np.testing.assert_allclose(getattr(found, kind)[:, : expected.shape[1]], expected, rtol=0, atol=1e-12)
    assert len(found.sha256) == 64
    assert found.path == str(path)
    source, sha256 = open_source(path)
    assert sha256 == found.sha256
    assert origin_of(source, path).recognised_by


@pytest.mark.parametrize("maker", [m for m in MAKERS if m.startswith(("rosbag", "bare", "ROS", "LeRobot", "motion"))])
def test_joints_go_to_the_robot_by_name(maker: str, tmp_path: Path) -> None:
    path = MAKERS[maker](tmp_path)
    joints = ("elbow", "pan", "wrist_3")
    found = load_recording(path, joints=joints)
    np.testing.assert_allclose(found.q, EXPECTED["q"][:, [2, 0, 5]], atol=1e-12)
    assert any("the robot has no joint lift, wrist_1, wrist_2" in warning for warning in found.warnings)
    with pytest.raises(RecordingError, match="has no joint knee: it names pan, lift"):
        load_recording(path, joints=("pan", "knee"))


@pytest.mark.parametrize("maker", MAKERS)
def test_damaged_copies_end_in_one_clear_line(maker: str, tmp_path: Path) -> None:
    """Bytes flipped, cut off or added: read all the same, or refused in one line."""
    whole = MAKERS[maker](tmp_path)
    rng = np.random.default_rng(len(maker))
    for k in range(FUZZ):
        copy = tmp_path / f"copy_{k}"
        shutil.copytree(whole, copy) if whole.is_dir() else shutil.copy(whole, copy := copy.with_suffix(whole.suffix))
        files = [f for f in copy.rglob("*") if f.is_file()] if copy.is_dir() else [copy]
        file = files[rng.integers(len(files))]
        file.write_bytes(damaged(file.read_bytes(), k, rng))
        said = outcome(copy)
        assert said == "read" or (said.startswith(str(copy)) and "\n" not in said)


def outcome(path: Path) -> str:
    """ "read" for whole numbers, else the error's text; anything but an error of ours goes through."""
    try:
        found = load_recording(path)
    except LagnetError as error:
        return str(error)
    return "read" if np.isfinite(found.q).all() else "read numbers that are none"


def damaged(data: bytes, k: int, rng: np.random.Generator) -> bytes:
    """One of four kinds of damage."""
    at = int(rng.integers(len(data)))
    if k % 4 == 0:
        return data[:at]
    if k % 4 == 1:
        return data[:at] + rng.bytes(40) + data[at + 40 :]
    if k % 4 == 2:
        return data[:at] + rng.bytes(200) + data[at:]
    return b""


def test_a_folder_of_motions_says_what_to_give(tmp_path: Path) -> None:
    motion = motion_folder(tmp_path)
    assert recordings_in(tmp_path) == (motion,)
    assert recordings_in(motion) == (motion,)
    with pytest.raises(RecordingError, match=r"holds 1 recordings, a folder each; give them, e\.g\. .*swing"):
        load_recording(tmp_path)


@pytest.mark.parametrize("name", ["model.pt", "log.pkl", "log.csv"])
def test_pickles_are_refused_and_not_run(name: str, tmp_path: Path) -> None:
    import pickle

    class Trap:
        def __reduce__(self) -> tuple:
            return (Path.touch, (tmp_path / "trapped",))

    path = tmp_path / name
    path.write_bytes(pickle.dumps(Trap()))
    with pytest.raises(RecordingError, match=r"is a pickle, which is never loaded; .*numpy\.savez"):
        load_recording(path)
    assert not (tmp_path / "trapped").exists()


def test_episodes_are_motions(tmp_path: Path) -> None:
    found = load_recording(lerobot(tmp_path, "v3.0", episodes=3))
    assert found.trajectory_names == ("0", "1", "2")
    assert [len(part) for part in found.parts()] == [N, N, N]


def test_without_rosbags_the_line_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = made_bag(tmp_path, "db3")
    import sys

    monkeypatch.setitem(sys.modules, "rosbags", None)
    with pytest.raises(LagnetError, match=r"needs the package rosbags; pip install 'lagnet\[ros\]'"):
        load_recording(path)


def test_content_goes_before_the_suffix(tmp_path: Path) -> None:
    path = MAKERS["bare mcap"](tmp_path)
    for name in ("log.csv", "log.db3", "log"):
        path = path.rename(tmp_path / name)
        assert load_recording(path).signals == holds("bare mcap")
