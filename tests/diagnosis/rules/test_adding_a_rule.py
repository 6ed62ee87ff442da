"""The page on adding a rule, followed to the letter in a copy: one file and one line, and all else knows the rule."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow
ROOT = Path(__file__).resolve().parents[3]
NAME, CLASS = "heavier_than_arm", "HeavierThanArm"
COPIED = ("src", "docs", "tests", "validation", "pyproject.toml", "CHANGELOG.md", "README.md")
DIAGNOSED = """
import sys
from pathlib import Path
import numpy as np
from tests.diagnosis.conftest import Plant
from lagnet import diagnose
from lagnet.diagnosis.writing import write_diagnosis
from lagnet.reports.diagnosis_report import write_report
from lagnet.rigid_body.random_arm import random_arm
robot, out = random_arm(2, seed=3, kinds=("revolute",), fixed=False), Path(sys.argv[1])
mass = 2.0 * float(robot.inertial_parameters()[:, 0].sum())
real = Plant(robot.with_payload(mass, np.array([0.0, 0.1, 0.0]), 0.01 * mass * np.eye(3)))
result = diagnose([real.record(1, 10.0)], robot, [real.record(2, 10.0)])
write_diagnosis(result, out)
write_report(result.verdict.to_dict(), result.evidence, out / "report.html")
"""
NAMES = "from validation.ablations.plan import EVERY; print(*(a.name for a in EVERY), sep=chr(10))"


@pytest.fixture(scope="module")
def copy(tmp_path_factory) -> Path:
    """The repository with the rule of the page, its line in `RULES`, and nothing else."""
    home = tmp_path_factory.mktemp("copy")
    for name in COPIED:
        one = ROOT / name
        ignored = shutil.ignore_patterns("__pycache__", "out", "*.png", "*.npz")
        shutil.copytree(one, home / name, ignore=ignored) if one.is_dir() else shutil.copy(one, home / name)
    rule, _, line, _, _ = blocks()
    rooms = home / "src" / "lagnet" / "diagnosis" / "rules"
    (rooms / f"{NAME}.py").write_text(rule, encoding="utf-8")
    within(rooms / "catalogue.py", "    NotSignificant(),\n", f"    NotSignificant(),\n{line}")
    module = "from lagnet.diagnosis.rules.impossible_density"
    within(rooms / "catalogue.py", module, f"from lagnet.diagnosis.rules.{NAME} import {CLASS}\n{module}")
    return home


def blocks() -> list[str]:
    """Rule, trial, line in RULES, cases, line in CASES."""
    page = (ROOT / "docs" / "adding_a_rule.md").read_text(encoding="utf-8")
    return re.findall(r"^```(?:python|text)\n(.*?)^```", page, re.DOTALL | re.MULTILINE)


def within(file: Path, old: str, new: str) -> None:
    """Puts a text in the place of another that stands there once."""
    text = file.read_text(encoding="utf-8")
    assert text.count(old) == 1
    file.write_text(text.replace(old, new), encoding="utf-8")


def run(home: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Python in the copy."""
    kept = {k: v for k, v in os.environ.items() if not k.startswith("COV")}
    own = kept | {"PYTHONPATH": os.pathsep.join((str(home / "src"), str(home)))}
    return subprocess.run([sys.executable, *words], cwd=home, env=own, capture_output=True, text=True, check=False)


def test_the_conformance_test_asks_for_cases_and_then_asks_the_rule(copy: Path) -> None:
    conformance = ("-m", "pytest", "-q", "-p", "no:cacheprovider", "tests/diagnosis/rules/test_rule_conformance.py")
    chosen = ("-k", f"{NAME} or every_rule_has_its_cases")
    without = run(copy, *conformance, *chosen)
    assert "test_every_rule_has_its_cases" in without.stdout
    assert without.returncode == 1
    *_, cases, entry = blocks()
    table = "\nCase = Callable[[Bench], Candidate]\n"
    file = copy / "tests" / "diagnosis" / "rules" / "cases.py"
    within(file, table, f"\n{cases}\n{table}")
    within(file, '    "not_significant": (', f'{entry}    "not_significant": (')
    found = run(copy, *conformance, *chosen)
    assert found.returncode == 0, found.stdout[-2000:]
    assert "7 passed" in found.stdout


def test_the_ablation_study_takes_it_out_and_changes_its_limit(copy: Path) -> None:
    names = run(copy, "-c", NAMES).stdout.splitlines()
    assert {NAME, f"{NAME}.most_of_arm at half", f"{NAME}.most_of_arm at twice"} <= {*names}


def test_the_page_of_limits_is_outdated_until_it_is_written_anew(copy: Path) -> None:
    assert run(copy, "docs/make_limits.py", "--check").returncode == 1
    assert run(copy, "docs/make_limits.py").returncode == 0
    page = (copy / "docs" / "limits.md").read_text(encoding="utf-8")
    assert f"### {NAME}" in page
    assert "| `most_of_arm` | 1 |" in page


def test_the_verdict_and_the_report_tell_what_it_rejects(copy: Path, tmp_path: Path) -> None:
    done = run(copy, "-c", DIAGNOSED, str(tmp_path))
    assert done.returncode == 0, done.stderr[-2000:]
    verdict = json.loads((tmp_path / "verdict.json").read_text(encoding="utf-8"))
    (found,) = (r for r in verdict["rejected"] if r["rule"] == NAME)
    assert (found["effect"], found["limit"]) == ("payload", 1.0)
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert found["detail"] in page
    assert "a payload is lighter than the arm that carries it" in page
