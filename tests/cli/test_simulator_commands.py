"""`lagnet export`, `lagnet replay` and `lagnet compare` from files to files."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from lagnet.cli.main import BAD_INPUT, DONE, main
from lagnet.models.corrected.folder import save_corrected
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.model import CorrectedModel, NamedEffect
from lagnet.models.corrected.motion_terms import MotionTerm, Rest
from lagnet.models.corrected.servo_driven import FoundCause, ServoDrivenModel
from lagnet.models.corrected.servo_files import load_servo_driven, save_servo_driven
from lagnet.models.files.loading import load_any
from lagnet.recordings.recording import Recording
from lagnet.recordings.writing import write_recording
from lagnet.rigid_body.random_arm import random_arm
from lagnet.servos.parameters import law_vector
from lagnet.simulators.corrected_arm.arm_physics import arm_physics
from lagnet.simulators.corrected_arm.driven_arm import DrivenArm
from lagnet.simulators.round_trips.reference_cases import case_values
from lagnet.simulators.round_trips.round_trip import smooth_motion
from lagnet.simulators.round_trips.tracking_control import tracking

pytestmark = pytest.mark.slow

ARM = random_arm(2, seed=3, kinds=("revolute",), fixed=False)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A corrected model, and a recording of the arm that it describes."""
    out = tmp_path_factory.mktemp("simulators")
    effects = [("viscous_friction", 0), ("coulomb_friction", 1), ("time_delay", 1)]
    values = {"time_delay": {"T": 0.004}}
    named = tuple(NamedEffect(n, j, values.get(n, case_values(n))) for n, j in effects)
    model = CorrectedModel(ARM, named, np.full(2, 1e-3))
    save_corrected(model, out / "corrected")
    ARM.write_urdf(out / "arm.urdf")
    heavy = ARM.inertial_parameters() * np.array([[1.0], [1.3]])
    ARM.with_inertial_parameters(heavy).write_urdf(out / "heavy.urdf")
    time, motion = smooth_motion(3.0, 2)
    control = tracking(ARM, time, motion, 20.0)
    q, tau = control.run(DrivenArm(arm_physics(model), 1e-3, control.q[0], control.v[0]))
    late = np.vstack([np.repeat(tau[:1], 4, axis=0), tau[:-4]])[:, 1]
    tau = np.column_stack([tau[:, 0], late])
    write_recording(Recording(time[::4], q[::4], tau[::4], ARM.joints), out / "run.csv")
    return out


def test_export_verifies_in_the_engine(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["export", str(folder / "corrected"), "--to", "mjcf", "--out", str(tmp_path)]
    assert main([*words, "--verify", str(folder / "run.csv")]) == DONE
    text = json.loads((tmp_path / "export.json").read_text(encoding="utf-8"))
    before, after = (np.array(text["verify"][side]["rmse"]) for side in ("before", "after"))
    assert np.linalg.norm(after) < 0.1 * np.linalg.norm(before)
    assert np.max(text["verify"]["engine_against_corrected_rmse"]) < 0.1 * np.max(before)
    said = capsys.readouterr().out
    assert "coulomb_friction (joint_1): exact: joint frictionloss" in said
    assert (tmp_path / "model.xml").is_file()


def test_what_was_identified_is_told_once_a_kind(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    terms = tuple(MotionTerm(kind, j) for j in range(2) for kind in ("viscous", "dry", "lag"))
    layer = IdentifiedLayer(None, terms, np.array([0.3, 0.2, 0.1, 0.4, -0.2, 0.1]), Rest(np.full(2, 1e-3), np.zeros(2)))
    save_corrected(CorrectedModel(ARM, (), np.full(2, 1e-3), identified=layer), tmp_path / "corrected")
    assert main(["export", str(tmp_path / "corrected"), "--to", "urdf", "--out", str(tmp_path / "out")]) == DONE
    said = capsys.readouterr().out
    assert "identified viscous (every joint): exact: joint dynamics damping" in said
    assert "identified dry (joint_0): approximate, 0.823 % off in mujoco, 100 % off in pybullet: joint" in said
    assert "identified dry (joint_1): not representable: the sum with what is named would be below zero" in said
    assert "identified lag (every joint): not representable: no law of a simulator" in said


def test_recordings_of_current_are_replayed_with_their_constants(folder: Path, tmp_path: Path) -> None:
    header, *rows = (folder / "run.csv").read_text(encoding="utf-8").splitlines()
    (tmp_path / "run.csv").write_text("\n".join([header.replace("tau_", "current_"), *rows]), encoding="utf-8")
    found = {}
    for name, file, more in (
        ("torque", folder / "run.csv", []),
        ("current", tmp_path / "run.csv", ["--torque-constant", "1,1"]),
    ):
        words = ["replay", str(file), "--robot", str(folder / "arm.urdf"), "--longest", "1", *more]
        assert main([*words, "--out", str(tmp_path / name)]) == DONE
        found[name] = json.loads((tmp_path / name / "replay.json").read_text(encoding="utf-8"))["before"]["rmse"]
    assert found["current"] == found["torque"]


def test_replay_writes_before_and_after(folder: Path, tmp_path: Path) -> None:
    words = ["replay", str(folder / "run.csv"), "--robot", str(folder / "corrected"), "--out", str(tmp_path)]
    assert main(words) == DONE
    text = json.loads((tmp_path / "replay.json").read_text(encoding="utf-8"))
    assert text["error_ratio"] < 0.1
    assert text["after"]["horizon_median_s"] >= text["before"]["horizon_median_s"]
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "Your simulator, before and after" in page
    assert (tmp_path / "replay.parquet").is_file()


def test_compare_finds_the_right_set(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["compare", str(folder / "run.csv"), "--out", str(tmp_path)]
    assert main([*words, "--robot", str(folder / "arm.urdf"), "--robot", str(folder / "heavy.urdf")]) == DONE
    text = json.loads((tmp_path / "compare.json").read_text(encoding="utf-8"))
    assert all(joint["best"].endswith("arm.urdf") for joint in text["joints"])
    assert "base parameters" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["export", "X", "--to", "gazebo"], "no exporter writes for 'gazebo'"),
        (["export", "X", "--to", "sdf", "--verify", "R"], "no engine here runs sdf"),
        (["export", "X", "--to", "mjcf", "--verify", "R", "--kp", "1,1"], "a servo has both gains"),
        (["replay", "R", "--robot", "X", "--engine", "gazebo"], "unknown engine 'gazebo'"),
        (["replay", "R", "--robot", "X", "--tolerance", "0"], "above zero"),
        (["compare", "R", "--robot", "X"], "one model is nothing to compare"),
    ],
)
def test_what_cannot_be_is_one_line(
    words: list[str], said: str, folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    named = {"X": str(folder / "corrected"), "R": str(folder / "run.csv")}
    assert main([named.get(w, w) for w in words] + ["--out", str(tmp_path)]) == BAD_INPUT
    lines = capsys.readouterr().err.strip().splitlines()
    assert len(lines) == 1
    assert said in lines[0]


@pytest.fixture(scope="module")
def servos(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A servo-driven arm that a diagnosis corrected, and a recording of its commands and motion."""
    out = tmp_path_factory.mktemp("servos")
    before = ServoDrivenModel(ARM, np.tile(law_vector(kp=30.0, kd=3.0, rotor=0.05), (2, 1)), (True, True))
    laws = np.tile(law_vector(kp=18.0, kd=3.0, rotor=0.05, coulomb=0.3, load_driving=0.1, delay=0.02), (2, 1))
    cause = FoundCause("gain_error", 0, "named", {"kp": 18.0, "kd": 3.0})
    model = ServoDrivenModel(ARM, laws, (True, True), causes=(cause,), before=before)
    save_servo_driven(model, out / "corrected")
    time = np.arange(0.0, 3.0, 0.01)
    command = np.column_stack([0.6 * np.sin(2.0 * time), 0.4 * np.sin(3.0 * time)])
    q = model.rollout(command, time, np.zeros(2), step=1e-3)
    write_recording(Recording(time, q, None, ARM.joints, command=command), out / "run.csv")
    return out


@pytest.mark.parametrize(("to", "engine"), [("mjcf", "mujoco"), ("pybullet", "pybullet")])
def test_a_correction_on_motion_is_exported_and_verified(servos: Path, tmp_path: Path, to: str, engine: str) -> None:
    words = ["export", str(servos / "corrected"), "--to", to, "--out", str(tmp_path)]
    assert main([*words, "--verify", str(servos / "run.csv")]) == DONE
    text = json.loads((tmp_path / "export.json").read_text(encoding="utf-8"))
    verified = text["verify"]
    before, after = (np.array(verified[side]["rmse"]) for side in ("before", "after"))
    assert verified["engine"] == engine
    assert verified["mode"] == "commands"
    assert np.all(after < 0.1 * before)
    assert np.max(verified["engine_against_corrected_rmse"]) < 2e-3
    assert [(e["effect"], e["status"]) for e in text["effects"]] == [("gain_error", "exact")]
    assert {"coulomb", "delay", "load_driving"} <= {e["identified"] for e in text["identified"]}


def test_a_correction_on_motion_is_replayed_before_and_after(
    servos: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["replay", str(servos / "run.csv"), "--robot", str(servos / "corrected"), "--out", str(tmp_path)]
    assert main(words) == DONE
    text = json.loads((tmp_path / "replay.json").read_text(encoding="utf-8"))
    assert text["error_ratio"] < 0.1
    assert (tmp_path / "report.html").is_file()
    assert "commands alone stay within 0.05 rad" in capsys.readouterr().out


@pytest.mark.parametrize(("command", "engine"), [("replay", "mujoco"), ("replay", "pybullet"), ("export", "mujoco")])
def test_recordings_are_replayed_each_at_its_own_gain(
    servos: Path, tmp_path: Path, command: str, engine: str, capsys: pytest.CaptureFixture[str]
) -> None:
    model = load_servo_driven(servos / "corrected", load_any)
    read = np.genfromtxt(servos / "run.csv", delimiter=",", names=True)
    time, commands = read["time"], np.column_stack([read["command_0"], read["command_1"]])
    q = model.rollout(commands, time, np.zeros(2), gain=0.5, step=1e-3)
    write_recording(Recording(time, q, None, ARM.joints, command=commands), tmp_path / "weak.csv")
    runs, folder = [str(tmp_path / "weak.csv"), str(servos / "run.csv")], str(servos / "corrected")
    words = {
        "replay": ["replay", *runs, "--robot", folder, "--engine", engine],
        "export": ["export", folder, "--to", "mjcf", "--verify", runs[0], "--verify", runs[1]],
    }[command]
    assert main([*words, "--out", str(tmp_path / "out"), "--gains", "0.5,1"]) == DONE
    name = {"replay": "replay.json", "export": "export.json"}[command]
    text = json.loads((tmp_path / "out" / name).read_text(encoding="utf-8"))
    assert text.get("verify", text)["error_ratio"] < 0.1
    assert main([*words, "--out", str(tmp_path / "again"), "--gains", "0.5"]) == BAD_INPUT
    assert "0.5 for 2 recordings" in capsys.readouterr().err


def test_a_robot_without_servos_has_no_gains(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["replay", str(folder / "run.csv"), "--robot", str(folder / "arm.urdf"), "--out", str(tmp_path)]
    assert main([*words, "--gains", "0.5"]) == BAD_INPUT
    assert "no servos" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (["--kp", "1,1", "--kd", "1,1"], "holds the gains of its servos"),
        (["--engine", "gazebo"], "unknown engine 'gazebo'"),
    ],
)
def test_what_cannot_be_replayed_on_motion_is_told(
    servos: Path, tmp_path: Path, more: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["replay", str(servos / "run.csv"), "--robot", str(servos / "corrected"), "--out", str(tmp_path)]
    assert main([*words, *more]) == BAD_INPUT
    assert said in capsys.readouterr().err


def test_torque_alone_does_not_drive_servos(
    folder: Path, servos: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["replay", str(folder / "run.csv"), "--robot", str(servos / "corrected"), "--out", str(tmp_path)]
    assert main(words) == BAD_INPUT
    assert "holds no commands" in capsys.readouterr().err
