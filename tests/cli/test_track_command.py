"""`lagnet track` tells mistakes in one line and exit code 2, before any worker is started."""

from __future__ import annotations

from lagnet.cli.main import BAD_INPUT, main
from lagnet.cli.shared.progress import Bar


def test_a_missing_manifest_is_one_line(tmp_path, capsys):
    assert main(["track", str(tmp_path / "none.toml"), "--out", str(tmp_path / "out")]) == BAD_INPUT
    told = capsys.readouterr().err.strip().splitlines()
    assert len(told) == 1
    assert "none.toml" in told[0]
    assert not (tmp_path / "out").exists()


def test_a_manifest_without_recordings_is_one_line(tmp_path, capsys):
    manifest = tmp_path / "fleet.toml"
    manifest.write_text('[[make]]\nname = "planar"\nrobot = "ur5"\n')
    assert main(["track", str(manifest), "--out", str(tmp_path / "out")]) == BAD_INPUT
    assert "states no recording" in capsys.readouterr().err


def test_progress_elsewhere_than_a_terminal_is_a_few_lines(capsys):
    import sys

    with Bar(sys.stderr) as bar:
        for done in range(101):
            bar.show("diagnoses", done, 100)
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "diagnoses: 0 of 100"
    assert lines[-1] == "diagnoses: 100 of 100"
    assert len(lines) == 11
