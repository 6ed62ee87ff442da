"""`lagnet diagnose --replay`: the user's simulator before and after, in the diagnosis report."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pyarrow.parquet as pq
import pytest
from tests.cli.test_diagnose_command import ARM, write_recording

from lagnet.cli.main import BAD_INPUT, DONE, main
from lagnet.rigid_body.random_arm import random_arm_urdf

TITLE = "<h2>Your simulator, before and after</h2>"


@pytest.fixture(scope="module")
def words(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """An arm with friction on the first joint, one recording fitted and one held out."""
    folder = tmp_path_factory.mktemp("recordings")
    (folder / "arm.urdf").write_text(random_arm_urdf(**ARM))
    fit, holdout = write_recording(folder / "fit.csv", 1), write_recording(folder / "holdout.csv", 2, 800)
    return ["diagnose", str(fit), "--holdout", str(holdout), "--robot", str(folder / "arm.urdf")]


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["mujoco", "pybullet"])
def test_the_report_shows_the_simulator_mended(
    engine: str, words: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*words, "--replay", engine, "--out", str(tmp_path)]) == DONE
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert page.count(TITLE) == 1
    text = json.loads((tmp_path / "replay.json").read_text(encoding="utf-8"))
    assert text["engine"] == engine
    assert [r["recording"] for r in text["recordings"]] == ["holdout.csv"]
    assert text["error_ratio"] < 0.1
    assert text["after"]["horizon_median_s"] > 5.0 * text["before"]["horizon_median_s"]
    table = pq.read_table(tmp_path / "replay.parquet").to_pydict()
    assert max(len(v) for v in table.values()) <= 200 * 8 + 1
    assert re.search(r"torques alone stay within 0.05 rad for \S+ s before, \S+ s after", capsys.readouterr().out)


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (["--replay", "gazebo"], "unknown engine 'gazebo'"),
        (["--replay", "mujoco", "--kp", "1,1"], "a servo has both gains"),
        (["--kp", "1,1", "--kd", "1,1"], "--replay"),
    ],
)
def test_what_cannot_be_replayed_is_said_before_the_diagnosis(
    more: list[str], said: str, words: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert main([*words, *more, "--out", str(out)]) == BAD_INPUT
    lines = capsys.readouterr().err.strip().splitlines()
    assert len(lines) == 1
    assert said in lines[0]
    assert not out.exists()
