"""Files and folders appear whole or not at all."""

from __future__ import annotations

import os

import pytest

from lagnet.files import finite_json, read_bounded, write_folder_whole, write_whole


def fail(*_: object) -> None:
    raise OSError(28, "No space left on device")


def test_a_failed_write_leaves_the_old_file_and_no_other(tmp_path, monkeypatch) -> None:
    path = write_whole(tmp_path / "a.txt", "old")
    monkeypatch.setattr("lagnet.files.os.fsync", fail)
    with pytest.raises(OSError, match="No space"):
        write_whole(path, "new")
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["a.txt"]


@pytest.mark.parametrize("exists", [False, True])
def test_a_folder_is_exchanged_whole(tmp_path, exists) -> None:
    folder = tmp_path / "result"
    if exists:
        write_whole(folder / "old.txt", "old")
    write_folder_whole(folder, lambda made: write_whole(made / "new.txt", "new"))
    assert [p.name for p in folder.iterdir()] == ["new.txt"]
    assert [p.name for p in tmp_path.iterdir()] == ["result"]


def test_an_interrupted_folder_leaves_the_old_one(tmp_path) -> None:
    folder = tmp_path / "result"
    write_whole(folder / "old.txt", "old")

    def fill(made) -> None:
        write_whole(made / "new.txt", "new")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_folder_whole(folder, fill)
    assert [p.name for p in folder.iterdir()] == ["old.txt"]
    assert [p.name for p in tmp_path.iterdir()] == ["result"]


def test_numbers_that_are_none_are_refused_with_their_place() -> None:
    with pytest.raises(ValueError, match=r"fit\[1\]\.nmse is nan"):
        finite_json({"fit": [{"nmse": 0.1}, {"nmse": float("nan")}]})
    assert finite_json({"a": 1.5}) == '{\n "a": 1.5\n}\n'


def test_pipes_and_large_files_are_not_read(tmp_path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(OSError, match="pipe"):
        read_bounded(tmp_path / "pipe", 10)
    with pytest.raises(OSError, match="larger than 3 bytes"):
        read_bounded(write_whole(tmp_path / "a", "four"), 3)
