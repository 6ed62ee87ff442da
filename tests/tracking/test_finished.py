"""Folders appear whole or not at all, and are read only for the inputs from which they were made."""

from __future__ import annotations

import pytest

from lagnet.tracking.finished import FILE, fingerprint, read_finished, remove_parts, write_finished


def test_a_folder_is_read_for_its_inputs_alone(tmp_path):
    folder, key = tmp_path / "a" / "b", fingerprint("x", 1)
    write_finished(folder, key, {"rows": [1]}, lambda part: (part / "more").write_text("hello"))
    assert read_finished(folder, key) == {"fingerprint": key, "rows": [1]}
    assert (folder / "more").read_text() == "hello"
    assert read_finished(folder, fingerprint("x", 2)) is None
    assert read_finished(tmp_path / "none", key) is None


def test_what_fails_half_way_leaves_nothing(tmp_path):
    def broken(part):
        (part / "more").write_text("hello")
        raise OSError("disk full")

    with pytest.raises(OSError, match="disk full"):
        write_finished(tmp_path / "a", "key", {}, broken)
    assert list(tmp_path.iterdir()) == []


def test_half_written_folders_are_not_read_and_removed(tmp_path):
    (tmp_path / ".a.123.part").mkdir()
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / FILE).write_text('{"fingerprint": "key", "rows": [')
    assert read_finished(tmp_path / "b", "key") is None
    remove_parts(tmp_path)
    assert [p.name for p in tmp_path.iterdir()] == ["b"]


def test_an_older_folder_is_replaced(tmp_path):
    write_finished(tmp_path / "a", "old", {}, lambda part: (part / "old").touch())
    write_finished(tmp_path / "a", "new", {}, lambda part: (part / "new").touch())
    assert sorted(p.name for p in (tmp_path / "a").iterdir()) == ["new", FILE]
    assert [p.name for p in tmp_path.iterdir()] == ["a"]
