"""`--hold`: a recording without columns of the fingers, against the arm with fingers."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.cli.main import main
from lagnet.cli.shared.robots import held_joints
from lagnet.errors import LagnetError
from lagnet.recordings.recording import Recording
from lagnet.recordings.writing import write_recording
from lagnet.rigid_body.random_arm import random_arm


@pytest.fixture
def case(tmp_path):
    """A three-joint arm's file, and a recording of its first two joints."""
    arm = random_arm(3, 5, ("revolute",), fixed=False)
    arm.write_urdf(tmp_path / "arm.urdf")
    time = np.arange(0, 12, 0.01)
    q = np.stack([np.sin(1.3 * time + k) * np.cos(0.4 * time) for k in (0.0, 1.0)], axis=1)
    v, a = (np.gradient(x, 0.01, axis=0) for x in (q, np.gradient(q, 0.01, axis=0)))
    whole = [np.column_stack([x, np.full(len(time), still)]) for x, still in ((q, 0.4), (v, 0.0), (a, 0.0))]
    tau = arm.inverse_dynamics(*whole)[:, :2]
    tau += 0.01 * tau.std(axis=0) * np.random.default_rng(0).normal(size=tau.shape)
    recording = Recording(time=time, q=q, tau=tau, joints=arm.joints[:2])
    write_recording(recording, tmp_path / "run.csv")
    return tmp_path, arm.joints[2]


@pytest.mark.parametrize("command", ["decompose", "check"])
def test_the_joint_is_held_where_it_stood(command, case, capsys):
    folder, still = case
    words = {
        "decompose": [str(folder / "run.csv"), "--out", str(folder / "out")],
        "check": ["--recording", str(folder / "run.csv")],
    }
    assert main([command, str(folder / "arm.urdf"), *words[command]]) == 2
    assert f"--hold {still}=0" in capsys.readouterr().err
    assert main([command, str(folder / "arm.urdf"), *words[command], "--hold", f"{still}=0.4"]) == 0


@pytest.mark.slow
def test_a_diagnosis_finds_nothing_where_the_joint_is_held_right(case, capsys):
    folder, still = case
    words = ["diagnose", str(folder / "run.csv"), "--robot", str(folder / "arm.urdf"), "--out", str(folder / "out")]
    assert main([*words, "--hold", f"{still}=0.4"]) == 0
    assert "No left-out physics was found." in capsys.readouterr().out
    assert f"joint {still} is held at 0.4" in (folder / "out" / "verdict.json").read_text()
    assert main([*words[:3], str(folder / "out"), "--hold", f"{still}=0.4"]) == 2
    assert "none can be held" in capsys.readouterr().err


def test_a_simulated_arm_can_have_joints_held(case):
    folder, still = case
    words = ["simulate", "--robot", str(folder / "arm.urdf"), "--out", str(folder / "sim"), "--trajectories", "1"]
    assert main([*words, "--duration", "4", "--hold", f"{still}=0.4"]) == 0
    header = next((folder / "sim").glob("*.csv")).read_text().splitlines()[0]
    assert len([name for name in header.split(",") if name.startswith("q_")]) == 2


def test_no_joints_of_a_simulator_that_is_known_by_its_log_alone(case, capsys):
    run = str(case[0] / "run.csv")
    assert main(["diagnose", run, "--simulated", run, "--hold", "a=0"]) == 2
    assert "--hold holds joints of --robot" in capsys.readouterr().err


def test_words_of_the_option():
    assert held_joints("a=1, b=-2e-3") == {"a": 1.0, "b": -2e-3}
    assert held_joints(None) == {}
    for text in ("a", "=1", "a=x", "a=1,"):
        with pytest.raises(LagnetError, match="NAME=POSITION"):
            held_joints(text)
