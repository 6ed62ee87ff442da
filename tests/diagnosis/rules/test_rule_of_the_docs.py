"""The rule that the documentation adds as an example: its code runs, and rejects what it should and nothing else."""

from __future__ import annotations

import importlib.util
import re
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from lagnet.rigid_body.inertia import parameters_of_body
from lagnet.rigid_body.random_arm import random_arm

PAGE = Path(__file__).resolve().parents[3] / "docs" / "adding_a_rule.md"
LINES = 60  # of a rule's file
REACH = 0.1  # [m] of the load's centre of mass off the last joint


@pytest.fixture(scope="module")
def example(tmp_path_factory) -> ModuleType:
    """The code blocks of the page, as one module."""
    rule, use, *_ = re.findall(r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    assert len(rule.splitlines()) <= LINES
    file = tmp_path_factory.mktemp("rule") / "heavier_than_arm.py"
    file.write_text(f"{rule}\n\n{use}", encoding="utf-8")
    spec = importlib.util.spec_from_file_location("heavier_than_arm", file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize(("of_arm", "rejected"), [(2.0, True), (0.5, False)])
def test_a_payload_heavier_than_the_arm_is_rejected_with_its_figures(example, plant, of_arm, rejected, capsys) -> None:
    robot = random_arm(2, seed=3, kinds=("revolute",), fixed=False)
    mass = of_arm * float(robot.inertial_parameters()[:, 0].sum())
    body = parameters_of_body(mass, np.array([0.0, REACH, 0.0]), 0.01 * mass * REACH**2 * np.eye(3))
    real = plant(lambda q, v, a, nominal: robot.link_regressor(1, q, v, a) @ body, robot=robot)
    rule = example.HeavierThanArm()
    result = example.diagnose_with(rule, [real.record(1, 10.0)], robot, [real.record(2, 10.0)])
    found = [r for r in result.state.rejected if r.rule == rule.name]
    assert bool(found) == rejected
    assert ("payload" in {e.effect for e in result.effects}) != rejected
    for r in found:
        assert r.effect == "payload"
        assert r.limit == rule.most_of_arm
        assert r.value == pytest.approx(of_arm, rel=0.02)
        assert f"payload: {rule.name}" in capsys.readouterr().out
