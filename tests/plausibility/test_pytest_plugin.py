"""The plugin in a pytest run of its own, as users meet it."""

from __future__ import annotations

import os
import subprocess
import sys
import xml.etree.ElementTree as ET
from importlib.metadata import entry_points
from pathlib import Path

import pytest

MODULE = "lagnet.plausibility.pytest_plugin"
REGISTERED = any(e.value == MODULE for e in entry_points(group="pytest11"))

USER_TEST = """
import numpy as np
import pytest
from lagnet.plausibility.pytest_plugin import PlausibilityTests


class Pendulum:
    joints, n_dof, joint_types = ("hinge",), 1, ("revolute",)

    def mass_matrix(self, q):
        return np.full((len(q), 1, 1), 0.5)

    def coriolis_torque(self, q, v):
        return DRAG * v

    def gravity_torque(self, q):
        return 4.0 * np.sin(q)

    def inverse_dynamics(self, q, v, a):
        return 0.5 * a + self.coriolis_torque(q, v) + self.gravity_torque(q)


MARK
class TestPendulum(PlausibilityTests):
    def model(self):
        return Pendulum()
"""


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess:
    plugin = [] if REGISTERED else ["-p", MODULE]
    command = [sys.executable, "-m", "pytest", *plugin, "-q", "-p", "no:cacheprovider", "-W", "error", *arguments]
    environment = os.environ | {"OMP_NUM_THREADS": "1"}
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, env=environment, check=False)


def properties(report: Path) -> dict[str, dict[str, str]]:
    cases = ET.parse(report).iter("testcase")
    told = [{p.get("name", ""): p.get("value", "") for p in case.iter("property")} for case in cases]
    return {case["lagnet_check"]: case for case in told if "lagnet_check" in case}


def test_model_of_the_command_line_is_one_test_a_check(tmp_path: Path):
    done = run(tmp_path, "--lagnet-model", "asr_twodof", "--lagnet-reference", "asr_twodof", "--junitxml=out.xml")
    assert done.returncode == 0, done.stdout + done.stderr
    told = properties(tmp_path / "out.xml")
    assert told["mass_matrix_symmetric"]["lagnet_status"] == "pass"
    assert float(told["mass_matrix_symmetric"]["lagnet_value"]) < 1e-9
    assert told["reference_total"]["lagnet_status"] == "pass"


@pytest.mark.slow
def test_vertical_base_is_checked_where_asked_for(tmp_path: Path):
    for asked, status in (((), "not_applicable"), (("--lagnet-vertical-base",), "pass")):
        done = run(tmp_path, "--lagnet-model", "ur5", *asked, "-k", "base_angle", "--junitxml=out.xml")
        assert done.returncode == 0, done.stdout + done.stderr
        assert properties(tmp_path / "out.xml")["base_angle_independence"]["lagnet_status"] == status


def test_faulty_model_of_the_command_line_fails_with_the_place(tmp_path: Path):
    done = run(tmp_path, "--lagnet-model", "finger_edu")
    assert done.returncode == 1
    assert "link_pseudo_inertia" in done.stdout
    assert "finger_lower_link" in done.stdout
    assert "Traceback" not in done.stdout
    assert "CheckResult" not in done.stdout, "the sentence says it all"


@pytest.mark.parametrize(("drag", "code"), [("0.0", 0), ("0.3", 1)])
def test_base_class_checks_a_users_model(tmp_path: Path, drag: str, code: int):
    (tmp_path / "test_arm.py").write_text(USER_TEST.replace("DRAG", drag).replace("MARK", ""))
    done = run(tmp_path, "--junitxml=out.xml")
    assert done.returncode == code, done.stdout
    status = properties(tmp_path / "out.xml")["coriolis_quadratic"]["lagnet_status"]
    assert status == ("fail" if code else "pass")


def test_marker_sets_limits_and_skips(tmp_path: Path):
    names = ["coriolis_from_mass_matrix", "coriolis_skew_symmetric", "energy_along_rollout", "energy_along_motion"]
    mark = f'@pytest.mark.lagnet(limits={{"coriolis_quadratic": 100.0}}, skip={names})'
    (tmp_path / "test_arm.py").write_text(USER_TEST.replace("DRAG", "0.3").replace("MARK", mark))
    done = run(tmp_path, "--strict-markers")
    assert done.returncode == 0, done.stdout


def test_misspelt_marker_is_an_error(tmp_path: Path):
    mark = '@pytest.mark.lagnet(limit={"coriolis_quadratic": 1.0})'
    (tmp_path / "test_arm.py").write_text(USER_TEST.replace("DRAG", "0.0").replace("MARK", mark))
    done = run(tmp_path)
    assert done.returncode != 0
    assert "valid: limits" in done.stdout + done.stderr


def test_fixture_serves_where_no_class_is_wanted(tmp_path: Path):
    text = USER_TEST.replace("DRAG", "0.0").replace("MARK", "").split("class TestPendulum")[0]
    text += """
@pytest.fixture(scope="module")
def lagnet_model():
    return Pendulum()


def test_physics(lagnet_check):
    assert lagnet_check.assert_holds().status == "pass"
"""
    (tmp_path / "test_arm.py").write_text(text)
    done = run(tmp_path)
    assert done.returncode == 0, done.stdout


def test_importing_the_plugin_loads_nothing_of_weight():
    code = (
        f"import sys, {MODULE}; "
        "print([m for m in ('numpy', 'jax', 'pinocchio', 'scipy', 'plotly', 'pyarrow') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
