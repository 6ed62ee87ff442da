"""`lagnet decompose` as a user calls it, held against the published contract."""

from __future__ import annotations

import json
import subprocess
import sys

import numpy as np
import pyarrow.parquet as pq
import pytest

from lagnet.cli.main import main
from lagnet.recordings.recording import Recording
from lagnet.recordings.writing import write_recording
from lagnet.rigid_body.robot import load_description


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    arm = load_description("ur5")
    time = np.arange(1200) / 125
    phase = 2 * np.pi * 0.3 * time[:, None] + np.arange(6)
    q, v, a = 0.5 * np.sin(phase), 0.94 * np.cos(phase), -1.78 * np.sin(phase)
    tau = arm.inverse_dynamics(q, v, a) + 3.0 * v
    folder = tmp_path_factory.mktemp("run")
    return write_recording(Recording(time, q, tau, arm.joints), folder / "run.csv")


def test_outputs_keep_the_contract(run, tmp_path, contracts, capsys):
    out = tmp_path / "out"
    assert main(["decompose", "ur5", str(run), "--reference", "ur5", "--member", "ur10", "--out", str(out)]) == 0
    checker = subprocess.run(
        [sys.executable, str(contracts / "check_outputs.py"), str(out)], capture_output=True, text=True, check=False
    )
    assert checker.returncode == 0, checker.stdout
    assert "report.html" in capsys.readouterr().out
    table = pq.read_table(out / "decomposition.parquet")
    assert table.num_rows == 1200
    assert "spread_gravity_5" in table.column_names
    told = json.loads((out / "decomposition.json").read_text())
    assert told["ensemble_members"] == 2
    page = (out / "report.html").read_text()
    assert "Where the torque goes" in page
    assert "shoulder_pan_joint" in page
    assert "<script src=" not in page


def test_wrong_arm_is_bad_input(run, tmp_path, capsys):
    assert main(["decompose", "panda", str(run), "--out", str(tmp_path / "out")]) == 2
    assert "joints" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
