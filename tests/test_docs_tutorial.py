"""The tutorial's commands, in its order, on shorter recordings: what a newcomer types must work."""

from __future__ import annotations

import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

TUTORIAL = Path(__file__).resolve().parents[1] / "docs" / "tutorial.md"
SHORT = ["--duration", "8"]  # [s] of the tutorial's 20: enough for its two large effects
BLOCK = re.compile(r"^```(sh|python|toml)\n(.*?)^```", re.DOTALL | re.MULTILINE)


def run(words: list[str], folder: Path) -> str:
    """Run a command in a folder and give back what it printed."""
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, env=environment, check=False)
    assert done.returncode == 0, f"{shlex.join(words)}\n{done.stdout}\n{done.stderr}"
    return done.stdout


@pytest.mark.slow
@pytest.mark.xdist_group("tutorial")
def test_the_tutorial_works_as_written(tmp_path: Path) -> None:
    said: list[str] = []
    for language, code in BLOCK.findall(TUTORIAL.read_text(encoding="utf-8")):
        if language == "toml":
            (tmp_path / "left_out.toml").write_text(code, encoding="utf-8")
        elif language == "python":
            said.append(run([sys.executable, "-c", code], tmp_path))
        else:
            for line in code.strip().splitlines():
                words = shlex.split(line)
                assert words[0] == "lagnet"
                short = SHORT if words[1] == "simulate" else []
                said.append(run([sys.executable, "-m", "lagnet.cli.main", *words[1:], *short], tmp_path))
    found = {e["effect"]: e for e in json.loads((tmp_path / "found" / "verdict.json").read_text())["effects"]}
    assert set(found) == {"payload", "coulomb_friction"}
    values = {p["name"]: p["value"] for e in found.values() for p in e["parameters"]}
    assert abs(values["m"] - 1.0) < 0.05
    assert abs(values["Fc"] - 4.0) < 0.2
    assert found["coulomb_friction"]["joint"] == "elbow_joint"
    again = json.loads((tmp_path / "again" / "verdict.json").read_text())
    assert again["effects"] == []
    assert any("payload" in text and "95 %" in text for text in said)
