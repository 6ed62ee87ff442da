"""`lagnet diagnose` on commands and positions: the folder it writes keeps every promise of the contract."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest

from lagnet.cli.main import main
from lagnet.models.files.loading import load_any
from lagnet.recordings.recording import Recording
from lagnet.recordings.writing import write_recording
from lagnet.rigid_body.kinematic_tree import kinematic_tree
from lagnet.rigid_body.robot import load_description
from lagnet.rollout.whole_arm import roll_out_arm
from lagnet.servos.parameters import law_vector

pytestmark = pytest.mark.slow

MJCF = """<mujoco><compiler angle="radian"/><worldbody><body name="arm">
<joint name="servo" axis="0 1 0" range="-3 3" damping="0.2" frictionloss="0.02" armature="0.01"/>
<inertial pos="0 0 -0.1" mass="0.5" diaginertia="1e-4 1e-4 1e-4"/></body></worldbody>
<actuator><position joint="servo" kp="8" kv="0.4" forcerange="-6 6"/></actuator></mujoco>"""
ENCODER = 2.0 * np.pi / 4096.0


@pytest.fixture(scope="module")
def diagnosed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with robot, recordings of a servo with more dry friction, and the diagnosis in `out`."""
    folder = tmp_path_factory.mktemp("on_motion")
    (folder / "robot.xml").write_text(MJCF, encoding="utf-8")
    tree = kinematic_tree(load_description(folder / "robot.xml"))
    law = law_vector(kp=8.0, kd=0.4, viscous=0.2, coulomb=0.12, rotor=0.01, torque_limit=6.0)
    time = np.arange(0.0, 30.0, 0.02)
    for seed in (1, 2, 3):
        rng = np.random.default_rng(seed)
        command = (rng.uniform(-1.0, 1.0, 20)[(time / 1.5).astype(int)] + 0.2 * np.sin(3.0 * time))[:, None]
        q = roll_out_arm(tree, law[None], time, command, np.zeros(1), step=0.001)
        recording = Recording(time, ENCODER * np.round(q / ENCODER), None, ("servo",), command=command)
        write_recording(recording, folder / f"run_{seed}.csv")
    words = ["diagnose", *(str(folder / f"run_{k}.csv") for k in (1, 2)), "--robot", str(folder / "robot.xml")]
    assert main([*words, "--holdout", str(folder / "run_3.csv"), "--out", str(folder / "out")]) == 0
    return folder


def test_every_promise_is_kept(diagnosed, contracts):
    words = [sys.executable, str(contracts / "check_outputs.py"), str(diagnosed / "out"), str(diagnosed / "run_3.csv")]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout


def test_the_verdict_says_the_route_and_names_the_cause(diagnosed):
    verdict = json.loads((diagnosed / "out" / "verdict.json").read_text())
    assert verdict["route"] == "motion"
    assert verdict["servo"]["source"] == "mjcf"
    assert [e["effect"] for e in verdict["effects"]] == ["coulomb_friction"]
    (fit,) = verdict["fit"]
    assert fit["rmse_corrected"] < 0.3 * fit["rmse_nominal"]
    assert fit["rmse_resolution"] == pytest.approx(ENCODER / np.sqrt(12.0), rel=0.01)


def test_the_corrected_model_rolls_out_what_the_table_holds(diagnosed):
    model = load_any(diagnosed / "out")
    table = pq.read_table(diagnosed / "out" / "holdout_motion.parquet").to_pydict()
    read = np.genfromtxt(diagnosed / "run_3.csv", delimiter=",", names=True)
    q = model.rollout(read["command_0"][:, None], read["time"], read["q_0"][:1])
    assert np.abs(q[:, 0] - np.array(table["q_corrected_0"])).max() < 1e-9
    assert set(table["recording"]) == {str(diagnosed / "run_3.csv")}


def test_motion_is_refused_without_commands(diagnosed, capsys):
    path = diagnosed / "torque.csv"
    rows = "\n".join(f"{0.01 * k},{0.1 * np.sin(0.1 * k)},{0.1}" for k in range(200))
    path.write_text("time,q_0,tau_0\n" + rows + "\n", encoding="utf-8")
    words = ["diagnose", str(path), "--robot", str(diagnosed / "robot.xml"), "--route", "motion"]
    assert main([*words, "--out", str(diagnosed / "none")]) == 2
    assert "command_i" in capsys.readouterr().err
    assert not (diagnosed / "none").exists()


@pytest.mark.parametrize("engine", ["mujoco", "pybullet"])
def test_the_users_simulator_is_shown_before_and_after(diagnosed, tmp_path, engine):
    words = ["diagnose", str(diagnosed / "run_1.csv"), "--holdout", str(diagnosed / "run_3.csv")]
    words += ["--robot", str(diagnosed / "robot.xml"), "--replay", engine, "--out", str(tmp_path)]
    assert main(words) == 0
    text = json.loads((tmp_path / "replay.json").read_text(encoding="utf-8"))
    assert (text["engine"], text["mode"]) == (engine, "commands")
    assert text["error_ratio"] < 0.2
    assert "<h2>Your simulator, before and after</h2>" in (tmp_path / "report.html").read_text(encoding="utf-8")


def test_gains_of_the_servo_beside_a_replay_are_refused(diagnosed, tmp_path, capsys):
    words = ["diagnose", str(diagnosed / "run_1.csv"), "--holdout", str(diagnosed / "run_3.csv")]
    words += ["--robot", str(diagnosed / "robot.xml"), "--replay", "mujoco", "--out", str(tmp_path / "out")]
    assert main([*words, "--kp", "8", "--kd", "1"]) == 2
    assert "finds the gains of servos" in capsys.readouterr().err


def test_held_out_recordings_are_replayed_at_their_own_gains(diagnosed, tmp_path):
    tree = kinematic_tree(load_description(diagnosed / "robot.xml"))
    law = law_vector(kp=8.0, kd=0.4, viscous=0.2, coulomb=0.12, rotor=0.01, torque_limit=6.0)
    read = np.genfromtxt(diagnosed / "run_3.csv", delimiter=",", names=True)
    time, command = read["time"], read["command_0"][:, None]
    q = roll_out_arm(tree, law[None], time, command, np.zeros(1), gain=np.full(command.shape, 0.4), step=0.001)
    recording = Recording(time, ENCODER * np.round(q / ENCODER), None, ("servo",), command=command)
    write_recording(recording, tmp_path / "weak.csv")
    words = ["diagnose", str(diagnosed / "run_1.csv"), "--holdout", str(tmp_path / "weak.csv"), "--gains", "1,0.4"]
    words += ["--robot", str(diagnosed / "robot.xml"), "--replay", "mujoco", "--out", str(tmp_path / "out")]
    assert main(words) == 0
    assert json.loads((tmp_path / "out" / "replay.json").read_text(encoding="utf-8"))["error_ratio"] < 0.2
