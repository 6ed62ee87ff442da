"""Manifests: what they state is read, and what is wrong is told in one line with its place."""

from __future__ import annotations

import os
from datetime import datetime

import pytest

from lagnet.errors import LagnetError
from lagnet.tracking.files import local_copy, matching, stamp
from lagnet.tracking.manifest import read_manifest

MAKE = '[[make]]\nname = "planar"\nrobot = "ur5"\n'


def write(folder, text, files=("a/2026-01-05.csv", "a/2026-01-12.csv", "b.csv")):
    for name in files:
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text("x")
    (folder / "fleet.toml").write_text(text)
    return folder / "fleet.toml"


def test_globs_dates_and_temperatures(tmp_path):
    text = MAKE + '[[robot]]\nname = "one"\n[[robot.recordings]]\nfiles = "a/*.csv"\ndate_in_name = "%Y-%m-%d"\n'
    text += '[[robot]]\nname = "two"\nmake = "planar"\n[[robot.recordings]]\nfiles = "b.csv"\n'
    text += "date = 2026-02-01T08:00:00Z\ntemperature = 31\n"
    manifest = read_manifest(write(tmp_path, text))
    assert [(r.robot, r.date) for r in manifest.recordings] == [
        ("one", datetime(2026, 1, 5)), ("one", datetime(2026, 1, 12)), ("two", datetime(2026, 2, 1, 8)),
    ]  # fmt: skip
    assert manifest.recordings[-1].temperature == 31
    assert manifest.robots == ("one", "two")
    assert manifest.makes["planar"].robot == "ur5"


def test_folders_that_are_recordings_gains_and_servos(tmp_path):
    for name in ("swing", "lift"):
        for file in ("control.csv", "state_motor.csv"):
            (tmp_path / "arm" / name).mkdir(parents=True, exist_ok=True)
            (tmp_path / "arm" / name / file).write_text("x")
    text = MAKE + 'actuator = "servo.toml"\n[[robot]]\nname = "one"\n[[robot.recordings]]\nfiles = "arm/swing"\n'
    text += 'date = 2026-01-05\ngain = 2\n[[robot.recordings]]\nfiles = "arm/l*"\ndate = 2026-01-06\n'
    manifest = read_manifest(write(tmp_path, text))
    assert [(r.file, r.gain) for r in manifest.recordings] == [
        (str(tmp_path / "arm" / "swing"), 2.0),
        (str(tmp_path / "arm" / "lift"), 1.0),
    ]
    assert manifest.makes["planar"].actuator == str(tmp_path / "servo.toml")
    assert matching(tmp_path, "arm", "here") == [str(tmp_path / "arm" / name) for name in ("lift", "swing")]
    before = stamp(str(tmp_path / "arm" / "swing"))
    (tmp_path / "arm" / "swing" / "control.csv").write_text("longer")
    assert stamp(str(tmp_path / "arm" / "swing")) != before


def test_an_index_states_a_large_fleet(tmp_path):
    (tmp_path / "index.csv").write_text(
        "robot,make,file,date,temperature,gain\n"
        "one,planar,b.csv,2026-01-05,,\n"
        "two,planar,a/2026-01-05.csv,2026-01-06,25.5,2\n"
    )
    manifest = read_manifest(write(tmp_path, 'index = "index.csv"\n' + MAKE))
    assert [(r.robot, r.temperature, r.gain) for r in manifest.recordings] == [
        ("one", None, 1.0),
        ("two", 25.5, 2.0),
    ]


ROBOT = MAKE + '[[robot]]\nname = "one"\n[[robot.recordings]]\n'


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x = ", "not valid TOML"),
        ("[[robots]]\n" + MAKE, "did you mean robot?"),
        ("", "states no make"),
        (MAKE, "states no recording"),
        (MAKE.replace('"planar"', '"../up"'), "cannot be the name of a folder"),
        (ROBOT + 'files = "none/*.csv"\ndate = 2026-01-05\n', "no file matches none/*.csv"),
        (ROBOT + 'files = "b.csv"\n', "has no date"),
        (ROBOT + 'files = "b.csv"\ndate = "soon"\n', "the date cannot be read"),
        (ROBOT + 'files = "b.csv"\ndate_in_name = "%Y-%m-%d"\n', "holds no date like"),
        (ROBOT + 'files = "b.csv"\ndate_in_name = "%Q"\n', "%Q is not known"),
        (ROBOT + 'files = "a/*.csv"\ndate = 2026-01-05\n', "one date for 2 files"),
        (ROBOT + 'files = "b.csv"\ndate = 2026-01-05\ntemperature = "warm"\n', "temperature must be a number"),
        (
            ROBOT.replace('name = "one"', 'name = "one"\nmake = "other"') + 'files = "b.csv"\ndate = 2026-01-05\n',
            "not declared",
        ),
        (
            ROBOT + 'files = "b.csv"\ndate = 2026-01-05\n[[robot.recordings]]\nfiles = "b.csv"\ndate = 2026-01-06\n',
            "stated twice",
        ),
        (ROBOT + 'files = "b.csv"\ndate = 2026-01-05\ngain = 0\n', "gain must be a positive number"),
        (ROBOT + 'files = "a"\ndate = 2026-01-05\n', "no file matches a"),
        (ROBOT.replace('"ur5"', '"ur5"\nactuator = 3') + 'files = "b.csv"\ndate = 2026-01-05\n', "actuator is missing"),
        ("[settings]\nsearch = 'all'\n" + ROBOT + 'files = "b.csv"\ndate = 2026-01-05\n', "search = 'all'"),
        ("[settings]\nseed = 1.5\n" + ROBOT + 'files = "b.csv"\ndate = 2026-01-05\n', "seed = 1.5"),
    ],
)
def test_mistakes_are_told(tmp_path, text, words):
    with pytest.raises(LagnetError) as error:
        read_manifest(write(tmp_path, text))
    assert words in str(error.value)
    assert "fleet.toml" in str(error.value)


@pytest.mark.parametrize("gain", ["0", "-1", "1e9", "high"])
def test_a_gain_of_an_index_must_be_a_positive_number(tmp_path, gain):
    (tmp_path / "index.csv").write_text(f"robot,make,file,date,gain\none,planar,b.csv,2026-01-05,{gain}\n")
    with pytest.raises(LagnetError, match=r"index\.csv, line 2.*gain"):
        read_manifest(write(tmp_path, 'index = "index.csv"\n' + MAKE))


@pytest.mark.parametrize(
    ("row", "words"),
    [
        ("one,planar,,2026-01-05", "line 2"),
        ("one,planar,b.csv,someday", "line 2"),
        ("one,other,b.csv,2026-01-05", "not declared"),
    ],
)
def test_mistakes_of_an_index_are_told_with_their_line(tmp_path, row, words):
    (tmp_path / "index.csv").write_text(f"robot,make,file,date\n{row}\n")
    with pytest.raises(LagnetError, match=words):
        read_manifest(write(tmp_path, 'index = "index.csv"\n' + MAKE))


def test_a_store_is_read_through_fsspec(tmp_path):
    fsspec = pytest.importorskip("fsspec")
    store = fsspec.filesystem("memory")
    store.pipe("/fleet/a.csv", b"hello")
    (address,) = matching(tmp_path, "memory://fleet/*.csv", "here")
    assert stamp(address).startswith("5 ")
    with local_copy(address) as path:
        assert path.read_bytes() == b"hello"
    assert not path.exists()
    with pytest.raises(LagnetError, match="cannot be fetched"), local_copy("memory://fleet/none.csv"):
        pass


def test_names_that_no_file_can_have_and_pipes_are_refused(tmp_path):
    with pytest.raises(LagnetError, match="states no recording"):
        read_manifest(write(tmp_path, MAKE.replace("ur5", "a" * 5000 + ".urdf")))
    os.mkfifo(tmp_path / "index.csv")
    with pytest.raises(LagnetError, match="pipe"):
        read_manifest(write(tmp_path, 'index = "index.csv"\n' + MAKE))
    os.mkfifo(tmp_path / "fleet_pipe.toml")
    with pytest.raises(LagnetError, match="pipe"):
        read_manifest(tmp_path / "fleet_pipe.toml")
