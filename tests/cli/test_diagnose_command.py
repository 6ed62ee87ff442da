"""`lagnet diagnose` from the outside: what it writes, what it promises, and how it refuses."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pyarrow.parquet as pq
import pytest

import lagnet
from lagnet.cli.diagnose import _say_what_differs
from lagnet.cli.main import main
from lagnet.diagnosis.diagnose import Diagnosis
from lagnet.diagnosis.verdict.wording import BESIDE_FREE_LINKS
from lagnet.rigid_body.random_arm import random_arm, random_arm_urdf

pytestmark = pytest.mark.xdist_group("diagnose_command")  # what they share is made once

RATE = 100.0  # [Hz]
ARM = {"n_joints": 2, "seed": 4, "kinds": ("revolute",)}


def write_recording(path: Path, seed: int, n: int = 1500, friction: float = 4.0) -> Path:
    """Two joints in motion, viscous friction on the first."""
    rng, robot = np.random.default_rng(seed), random_arm(**ARM)
    time = np.arange(n) / RATE
    omega = 2.0 * np.pi * np.array([0.2, 0.5, 0.9])[:, None]
    angle = omega * time[:, None, None] + rng.uniform(0.0, 6.0, (3, 2))
    size = rng.uniform(0.15, 0.4, (3, 2))
    q, v = (size * np.sin(angle)).sum(axis=1), (size * omega * np.cos(angle)).sum(axis=1)
    tau = robot.inverse_dynamics(q, v, -(size * omega**2 * np.sin(angle)).sum(axis=1))
    tau[:, 0] += friction * v[:, 0]
    tau += 0.01 * np.std(tau, axis=0) * rng.standard_normal(tau.shape)
    with path.open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["time", "q_0", "q_1", "tau_0", "tau_1"])
        table.writerows(np.column_stack([time, q, tau]).tolist())
    return path


@pytest.fixture(scope="module")
def files(tmp_path_factory) -> dict[str, str]:
    folder = tmp_path_factory.mktemp("recordings")
    (folder / "arm.urdf").write_text(random_arm_urdf(**ARM))
    names = {"fit": write_recording(folder / "fit.csv", 1), "holdout": write_recording(folder / "holdout.csv", 2, 800)}
    return {k: str(p) for k, p in names.items()} | {"robot": str(folder / "arm.urdf")}


@pytest.fixture(scope="module")
def diagnosed(files, tmp_path_factory) -> Path:
    out = tmp_path_factory.mktemp("diagnosis") / "out"
    arguments = ["diagnose", files["fit"], "--holdout", files["holdout"], "--robot", files["robot"], "--out", str(out)]
    assert main(arguments) == 0
    return out


def test_it_writes_what_was_promised(diagnosed, files, contracts) -> None:
    command = [sys.executable, str(contracts / "check_outputs.py"), str(diagnosed), files["holdout"]]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_verdict_names_what_was_left_out(diagnosed) -> None:
    verdict = json.loads((diagnosed / "verdict.json").read_text())
    assert [(e["effect"], e["joint"]) for e in verdict["effects"]] == [("viscous_friction", "joint_0")]
    value = verdict["effects"][0]["parameters"][0]
    assert value["value"] == pytest.approx(4.0, rel=0.02)
    assert [r["role"] for r in verdict["recordings"]] == ["fit", "holdout"]
    assert all(len(r["sha256"]) == 64 for r in verdict["recordings"])


def test_every_held_out_sample_is_in_the_table_as_given(diagnosed, files) -> None:
    table = pq.read_table(diagnosed / "holdout_torque.parquet").to_pydict()
    given = np.genfromtxt(files["holdout"], delimiter=",", names=True)
    np.testing.assert_array_equal(table["time"], given["time"])
    np.testing.assert_array_equal(table["tau_measured_1"], given["tau_1"])
    before, after = (np.std(np.array(table[f"tau_{k}_0"]) - given["tau_0"]) for k in ("nominal", "corrected"))
    assert after < 0.2 * before


def test_the_corrected_folder_is_a_robot(diagnosed) -> None:
    robot = lagnet.load_robot(diagnosed)
    assert robot.joints == ("joint_0", "joint_1")
    assert [e.effect for e in robot.effects] == ["viscous_friction"]


def test_the_page_names_the_effect_and_asks_nothing_of_the_network(diagnosed) -> None:
    page = (diagnosed / "report.html").read_text()
    assert "iscous friction" in page
    assert "joint_0" in page
    assert "<script src=" not in page


def test_the_page_opens_in_a_browser_without_complaint(diagnosed, chromium, tmp_path) -> None:
    command = [
        chromium,
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--disable-dev-shm-usage",
        "--no-first-run",
        "--disable-background-networking",
        "--host-resolver-rules=MAP * ~NOTFOUND",
        f"--user-data-dir={tmp_path / 'profile'}",
        "--enable-logging=stderr",
        "--virtual-time-budget=8000",
        "--dump-dom",
        (diagnosed / "report.html").as_uri(),
    ]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    assert "iscous friction" in done.stdout
    assert "js-plotly-plot" in done.stdout
    assert not [line for line in done.stderr.splitlines() if "CONSOLE" in line]


def refuse(arguments: list[str], out: Path, capsys) -> str:
    """Exit code 2, one line on standard error, nothing written."""
    assert main(["diagnose", *arguments, "--out", str(out)]) == 2
    complaint = capsys.readouterr().err.strip()
    assert complaint
    assert "\n" not in complaint
    assert "Traceback" not in complaint
    assert not out.exists()
    return complaint


def test_a_recording_of_another_arm_is_refused(files, tmp_path, capsys) -> None:
    (tmp_path / "three.urdf").write_text(random_arm_urdf(3, seed=4, kinds=("revolute",)))
    complaint = refuse([files["fit"], "--robot", str(tmp_path / "three.urdf")], tmp_path / "out", capsys)
    assert "fit.csv" in complaint


def test_a_held_out_recording_of_another_arm_is_refused(files, tmp_path, capsys) -> None:
    lines = Path(files["holdout"]).read_text().splitlines()
    short = tmp_path / "one_joint.csv"
    short.write_text("\n".join(",".join(line.split(",")[k] for k in (0, 1, 3)) for line in lines))
    arguments = [files["fit"], "--holdout", str(short), "--robot", files["robot"]]
    assert "one_joint.csv" in refuse(arguments, tmp_path / "out", capsys)


@pytest.mark.parametrize("robot", ["no_such_robot", "missing.urdf"])
def test_an_unknown_robot_is_refused(robot, files, tmp_path, capsys) -> None:
    assert robot in refuse([files["fit"], "--robot", robot], tmp_path / "out", capsys)


@pytest.mark.parametrize("option", [("--gains", "2"), ("--actuator", "servo.toml")])
def test_what_concerns_servos_is_refused_beside_torque(option, files, tmp_path, capsys) -> None:
    told = refuse([files["fit"], "--robot", files["robot"], *option], tmp_path / "out", capsys)
    assert f"{option[0]}: the recordings hold torque" in told
    assert "--route motion" in told


def test_a_missing_recording_is_refused(files, tmp_path, capsys) -> None:
    complaint = refuse([str(tmp_path / "gone.csv"), "--robot", files["robot"]], tmp_path / "out", capsys)
    assert "gone.csv" in complaint


def test_too_short_a_recording_is_refused(files, tmp_path, capsys) -> None:
    short = write_recording(tmp_path / "short.csv", 3, n=40)
    assert refuse([str(short), "--robot", files["robot"]], tmp_path / "out", capsys)


def test_no_recording_is_bad_usage(tmp_path, capsys) -> None:
    assert refuse(["--robot", "ur5"], tmp_path / "out", capsys)


def test_a_damaged_corrected_folder_is_refused(diagnosed, files, tmp_path, capsys) -> None:
    folder = tmp_path / "corrected"
    folder.mkdir()
    (folder / "corrected.json").write_text("{")
    assert "corrected.json" in refuse([files["fit"], "--robot", str(folder)], tmp_path / "out", capsys)


@pytest.mark.parametrize("beside", [False, True])
def test_links_that_differ_are_told_before_the_causes_that_were_judged_beside_them(capsys, beside: bool) -> None:
    verdict = SimpleNamespace(warnings=(BESIDE_FREE_LINKS,) if beside else (), found=True)
    _say_what_differs(cast(Diagnosis, SimpleNamespace(verdict=verdict, effects=(SimpleNamespace(explanation="Dry."),))))
    told = capsys.readouterr()
    lines = (told.out + told.err).splitlines()
    assert lines[-1] == "Dry."
    assert [line.startswith("Several links differ from the model") for line in lines[:-1]] == [True] * beside
