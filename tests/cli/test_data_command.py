"""`lagnet data`."""

from __future__ import annotations

from pathlib import Path

import pytest

from lagnet.cli.main import main


def test_list_shows_every_set_and_address(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["data", "list"]) == 0
    shown = capsys.readouterr().out
    for name in ("ur10e:", "staubli_tx40:", "emps:", "sarcos:", "delan_characters:"):
        assert name in shown
    assert "161a59b5c3b4f4b404584323f181607b2acbe620eb134dc720760dc3f38f5cec" in shown
    assert "http://www.gaussianprocess.org/gpml/data/sarcos_inv_test.mat" in shown


@pytest.mark.shared_data
def test_fetch_uses_local_copies(
    shared_data: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("LAGNET_DATA_DIR", str(shared_data))
    assert main(["data", "fetch", "emps", "--out", str(tmp_path)]) == 0
    shown = capsys.readouterr()
    assert f"{tmp_path}/emps/fit.csv.gz" in shown.out
    assert shown.err == ""
    assert (tmp_path / "emps" / "fit.csv.gz").read_bytes() == (shared_data / "emps" / "fit.csv.gz").read_bytes()


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["data", "fetch", "emp"], "did you mean 'emps'?"),
        (["data", "fetch"], "Missing argument 'name'"),
        (["data", "fly"], "No such command"),
        (["data", "fetch", "delan_characters"], "LAGNET_DATA_DIR"),
    ],
)
def test_bad_requests_are_one_line_and_code_2(
    words: list[str],
    line: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.delenv("LAGNET_DATA_DIR", raising=False)
    out = [*words, "--out", str(tmp_path)] if len(words) == 3 else words
    assert main(out) == 2
    told = capsys.readouterr().err
    assert line in told
    assert told.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_bare_data_shows_its_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["data"]) in (0, 2)
    told = capsys.readouterr()
    assert "fetch" in told.out
    assert told.err == ""
