"""The documentation knows every check, and its example is one that runs."""

from __future__ import annotations

import re
import subprocess
import sys
from importlib.metadata import entry_points
from pathlib import Path

import pytest

from lagnet.plausibility.checks import CHECKS

MODULE = "lagnet.plausibility.pytest_plugin"
PAGE = (Path(__file__).resolve().parents[2] / "docs" / "plausibility.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("kind", CHECKS, ids=lambda kind: kind.name)
def test_every_check_is_documented_as_it_is(kind):
    assert f"| `{kind.name}` | {kind.title} | {kind.meaning} | {kind.justification} |" in PAGE
    assert not kind.stays_because or f"- `{kind.name}`: {kind.stays_because}." in PAGE


def test_the_example_to_copy_runs(tmp_path):
    example = next(block for block in re.findall(r"```python\n(.*?)```", PAGE, re.S) if "class Pendulum" in block)
    (tmp_path / "test_my_arm.py").write_text(example)
    registered = any(e.value == MODULE for e in entry_points(group="pytest11"))
    plugin = [] if registered else ["-p", MODULE]
    command = [sys.executable, "-m", "pytest", *plugin, "-q", "-W", "error", "-p", "no:cacheprovider"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
    assert " passed" in done.stdout


def test_names_are_unique_words():
    names = [kind.name for kind in CHECKS]
    assert len(set(names)) == len(names)
    assert all(re.fullmatch(r"[a-z_]+", name) for name in names)
