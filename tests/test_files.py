"""Files and folders appear whole or not at all."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterator

import pytest

from lagnet.files import PART, finite_json, read_bounded, write_folder_whole, write_together, write_whole


def fail(*_: object) -> None:
    raise OSError(28, "No space left on device")


def test_a_failed_write_leaves_the_old_file_and_no_other(tmp_path, monkeypatch) -> None:
    path = write_whole(tmp_path / "a.txt", "old")
    monkeypatch.setattr("lagnet.files.os.fsync", fail)
    with pytest.raises(OSError, match="No space") as told:
        write_whole(path, "new")
    assert told.value.filename == str(path)
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


def two_files(draft) -> None:
    write_whole(draft / "verdict.json", "new")
    write_whole(draft / "corrected" / "corrected.json", "new")


@pytest.fixture
def results(tmp_path):
    """A folder with a result, and with a file that is none of it."""
    write_together(tmp_path / "found", lambda draft: write_whole(draft / "verdict.json", "old"))
    write_whole(tmp_path / "found" / "corrected" / "gone.json", "old")
    write_whole(tmp_path / "found" / "notes.txt", "mine")
    return tmp_path / "found"


def standing(folder) -> dict[str, str]:
    return {str(p.relative_to(folder)): p.read_text() for p in folder.rglob("*") if p.is_file()}


def test_files_that_belong_together_are_replaced_together(results) -> None:
    write_together(results, two_files, last="verdict.json")
    assert standing(results) == {"verdict.json": "new", "corrected/corrected.json": "new", "notes.txt": "mine"}


@pytest.mark.parametrize("error", [KeyboardInterrupt(), OSError(28, "No space left on device")])
def test_where_one_cannot_be_written_all_old_ones_stay(results, error) -> None:
    before = standing(results)

    def fill(draft) -> None:
        two_files(draft)
        raise error

    with pytest.raises(type(error)):
        write_together(results, fill)
    assert standing(results) == before
    assert not [p for p in results.iterdir() if p.name.startswith(".")]


@pytest.mark.parametrize("write", [write_together, write_folder_whole])
def test_an_error_names_the_place_and_not_the_draft(tmp_path, monkeypatch, write) -> None:
    monkeypatch.setattr("lagnet.files.os.fsync", fail)
    with pytest.raises(OSError, match="No space") as told:
        write(tmp_path / "found", two_files)
    assert told.value.filename == str(tmp_path / "found" / "verdict.json")


@pytest.fixture
def control_c() -> Iterator[Callable]:
    """Sets who takes Ctrl-C; a process in the background ignores it from its start."""
    before = signal.getsignal(signal.SIGINT)
    yield lambda handler: signal.signal(signal.SIGINT, handler)
    signal.signal(signal.SIGINT, before)


def test_control_c_that_is_ignored_stays_ignored(results, control_c) -> None:
    control_c(signal.SIG_IGN)

    def fill(draft) -> None:
        write_whole(draft / "a.txt", "new")
        signal.raise_signal(signal.SIGINT)

    write_together(results, fill, last="a.txt")
    assert standing(results)["a.txt"] == "new"
    assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN


def test_control_c_waits_until_all_have_taken_their_places(results, monkeypatch, control_c) -> None:
    control_c(signal.default_int_handler)
    replace, moved = os.replace, []

    def pressed(source, target) -> None:
        replace(source, target)
        if PART not in os.path.basename(source):  # not of a draft of one file, but of all together
            moved.append(os.path.basename(source))
            signal.raise_signal(signal.SIGINT)

    def fill(draft) -> None:
        for name in ("a.txt", "b.txt"):
            write_whole(draft / name, "new")
        monkeypatch.setattr("lagnet.files.os.replace", pressed)

    with pytest.raises(KeyboardInterrupt):
        write_together(results, fill, last="a.txt")
    assert moved == ["b.txt", "a.txt"]
    assert standing(results)["a.txt"] == standing(results)["b.txt"] == "new"
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


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
