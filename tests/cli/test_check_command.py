"""`lagnet check` as a user calls it."""

from __future__ import annotations

import json
import subprocess
import sys

import numpy as np
import pytest

from lagnet.cli.main import main
from lagnet.recordings.recording import Recording
from lagnet.recordings.writing import write_recording
from lagnet.rigid_body.random_arm import random_arm, random_arm_urdf


def test_sound_robot_passes(capsys):
    assert main(["check", "asr_twodof"]) == 0
    assert capsys.readouterr().out.startswith("PASS")


def test_faulty_robot_fails_and_the_first_line_says_what_and_where(capsys, tmp_path):
    assert main(["check", "finger_edu", "--out", str(tmp_path / "out")]) == 1
    first = capsys.readouterr().out.splitlines()[0]
    assert first.startswith("FAIL link_pseudo_inertia")
    assert "finger_lower_link" in first
    written = json.loads((tmp_path / "out" / "plausibility.json").read_text())
    failed = [c for c in written if c["status"] == "fail"]
    assert [c["name"] for c in failed] == ["link_pseudo_inertia"]
    assert failed[0]["where"]["link"] == "finger_lower_link"
    page = (tmp_path / "out" / "report.html").read_text()
    assert "finger_lower_link" in page
    assert "<script src=" not in page


def test_exit_code_is_that_of_the_checks_when_the_reader_has_gone():
    for robot, code in (("asr_twodof", 0), ("finger_edu", 1)):
        command = [sys.executable, "-m", "lagnet.cli.main", "check", robot]
        run = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        assert run.stdout is not None
        run.stdout.close()
        assert run.wait() == code
        assert run.stderr is not None
        assert run.stderr.read() == ""
        run.stderr.close()


def test_limits_and_skips_of_ones_own(capsys):
    assert main(["check", "finger_edu", "--limit", "link_pseudo_inertia=-1e-6"]) == 0
    assert main(["check", "finger_edu", "--skip", "link_pseudo_inertia"]) == 0
    assert main(["check", "finger_edu", "--skip", "pseudo_inertia"]) == 2
    assert "valid:" in capsys.readouterr().err
    assert main(["check", "finger_edu", "--limit", "link_pseudo_inertia"]) == 2
    assert "NAME=VALUE" in capsys.readouterr().err


@pytest.mark.parametrize(("scale", "code"), [(1.0, 0), (400.0, 1)])
def test_recording_is_held_to_the_limits(tmp_path, capsys, scale: float, code: int):
    arm = random_arm(3, 11, ("revolute",), fixed=False)
    urdf = tmp_path / "arm.urdf"
    urdf.write_text(random_arm_urdf(3, 11, ("revolute",), fixed=False))
    time = np.arange(400) / 200
    q = 0.5 * np.sin(2 * np.pi * 0.5 * time[:, None] + np.arange(3))
    tau = scale * arm.gravity_torque(q)
    path = write_recording(Recording(time, q, tau, arm.joints), tmp_path / "run.csv")
    assert main(["check", str(urdf), "--reference", str(urdf), "--recording", str(path)]) == code
    first = capsys.readouterr().out.splitlines()[0]
    assert ("recording_within_efforts" in first) == bool(code)
    assert not code or "run.csv" in first


def test_unknown_robot_is_bad_input(capsys):
    assert main(["check", "no_such_robot"]) == 2
    assert "no_such_robot" in capsys.readouterr().err
