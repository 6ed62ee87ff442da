"""`lagnet diagnose --suggest-motion` from the outside, and `lagnet simulate --motion` that tries what it suggests."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from lagnet.cli.main import main
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.recording import Recording
from lagnet.recordings.writing import write_recording
from lagnet.rigid_body.random_arm import random_arm_urdf
from lagnet.rigid_body.robot import load_description

pytestmark = pytest.mark.slow

RATE = 100.0  # [Hz]
FRICTION = 2.0  # [N m]
SHARP = 1e-3  # [rad/s] over which it changes sign


@pytest.fixture(scope="module")
def urdf(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("robot") / "arm.urdf"
    path.write_text(random_arm_urdf(n_joints=2, seed=4, kinds=("revolute",)))
    return path


@pytest.fixture(scope="module")
def narrow(urdf: Path, tmp_path_factory) -> Path:
    """Dry friction on the second joint, moved a little about one pose; the first stands still."""
    robot, rng = load_description(urdf), np.random.default_rng(1)
    time = np.arange(1500) / RATE
    omega = 2.0 * np.pi * 0.4
    q, v, a = np.zeros((3, time.size, 2))
    q[:, 1] = 0.3 + 0.03 * np.sin(omega * time)
    v[:, 1], a[:, 1] = 0.03 * omega * np.cos(omega * time), -0.03 * omega**2 * np.sin(omega * time)
    tau = robot.inverse_dynamics(q, v, a)
    tau[:, 1] += FRICTION * np.tanh(v[:, 1] / SHARP)
    tau += 0.02 * rng.standard_normal(tau.shape)
    recording = Recording(time, q + 1e-5 * rng.standard_normal(q.shape), tau, robot.joints)
    return write_recording(recording, tmp_path_factory.mktemp("narrow") / "narrow.csv")


@pytest.fixture(scope="module")
def diagnosed(urdf: Path, narrow: Path, tmp_path_factory) -> Path:
    out = tmp_path_factory.mktemp("found") / "out"
    assert main(["diagnose", str(narrow), "--robot", str(urdf), "--out", str(out), "--suggest-motion"]) == 0
    return out


def test_a_motion_is_written_that_the_robot_can_be_sent_along(diagnosed: Path, urdf: Path) -> None:
    robot = load_description(urdf)
    motion = load_recording(diagnosed / "suggested_motion.csv", robot=robot)
    assert motion.rate == pytest.approx(RATE)
    assert 20.0 <= motion.duration <= 30.0
    assert motion.v is not None
    told = json.loads((diagnosed / "suggested_motion.json").read_text())
    assert told["collisions_checked"] is False
    assert [a["effect"] for a in told["abstentions"] if a["expected_to_show"]]


def test_the_verdict_says_which_recording_breaks_its_ties(diagnosed: Path) -> None:
    verdict = json.loads((diagnosed / "verdict.json").read_text())
    assert [e for e in verdict["effects"] if e["tied_with"]]
    for effect in verdict["effects"]:
        assert ("What would: " in effect["explanation"]) == bool(effect["tied_with"])


def test_without_the_option_no_motion_is_written(urdf: Path, narrow: Path, tmp_path: Path) -> None:
    assert main(["diagnose", str(narrow), "--robot", str(urdf), "--out", str(tmp_path)]) == 0
    assert (tmp_path / "verdict.json").exists()
    assert not (tmp_path / "suggested_motion.csv").exists()


def test_the_suggested_motion_can_be_simulated(diagnosed: Path, urdf: Path, tmp_path: Path) -> None:
    pytest.importorskip("pybullet")
    motion, out = diagnosed / "suggested_motion.csv", tmp_path / "run"
    assert main(["simulate", "--robot", str(urdf), "--motion", str(motion), "--out", str(out)]) == 0
    robot = load_description(urdf)
    wanted, run = load_recording(motion, robot=robot), load_recording(out / "trajectory_0.csv", robot=robot)
    n = min(len(wanted), len(run))
    np.testing.assert_allclose(run.q[:n], wanted.q[:n], atol=5e-3)
    assert json.loads((out / "truth.json").read_text())["motion"]["sha256"] == wanted.sha256
