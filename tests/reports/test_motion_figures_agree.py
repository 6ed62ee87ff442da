"""Report, verdict.json and holdout_motion.parquet of diagnoses of real servos hold the same figures."""

from __future__ import annotations

import json
import re
from html import unescape
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest

from lagnet.diagnosis.motion.diagnose import MotionDiagnosis, diagnose_motion
from lagnet.diagnosis.motion.writing import write_motion_diagnosis
from lagnet.recordings.loading.load import load_recording
from lagnet.reports.motion_report import write_motion_report
from lagnet.reports.wording import number
from lagnet.rigid_body.robot import load_description

SAME = 1e-9  # relative: one sum in another order
PENDULUM = """<robot name="pendulum"><link name="base"/><link name="arm"><inertial><origin xyz="0 0 -0.1"/>
<mass value="0.49"/><inertia ixx="1e-6" ixy="0" ixz="0" iyy="1e-6" iyz="0" izz="1e-6"/></inertial></link>
<joint name="horn" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
<limit lower="-3.2" upper="3.2" effort="10" velocity="100"/></joint></robot>"""

pytestmark = [pytest.mark.slow, pytest.mark.shared_data]


def assert_figures_agree(result: MotionDiagnosis, folder: Path) -> None:
    """Root mean square errors of whole rollouts, as computed from the table: to the last digit that is written."""
    write_motion_diagnosis(result, folder)
    verdict = json.loads((folder / "verdict.json").read_text(encoding="utf-8"))
    page = write_motion_report(result, folder / "report.html").read_text(encoding="utf-8")
    table = {n: np.array(v) for n, v in pq.read_table(folder / "holdout_motion.parquet").to_pydict().items()}
    errors = [[rmse(table, j, kind) for kind in ("nominal", "corrected")] for j in range(len(verdict["fit"]))]
    rows = re.findall(r'<tr><td class="name">(.*?)</tr>', page[page.index("Root mean square error of position") :])
    for (before, after), fit, row in zip(errors, verdict["fit"], rows, strict=False):
        assert fit["rmse_nominal"] == pytest.approx(before, rel=SAME)
        assert fit["rmse_corrected"] == pytest.approx(after, rel=SAME)
        nominal, _, corrected, resolution = re.findall(r'<td class="number">(.*?)</td>', row)
        written = (number(before), number(after), number(fit["rmse_resolution"]))
        assert (unescape(nominal), unescape(corrected), unescape(resolution)) == written
    lead = unescape(re.search(r'<p class="lead">(.*?)</p>', page, flags=re.DOTALL)[1])
    told = [number(float(np.sqrt(np.mean(np.square(kind)))), 3) for kind in zip(*errors, strict=True)]
    assert re.findall(r"by (\S+) rad", lead) == told
    if len(errors) > 1:
        assert f"{number(max(after for _, after in errors), 3)} rad or m" in lead


def rmse(table: dict[str, np.ndarray], joint: int, kind: str) -> float:
    """Of the rolled-out positions of a joint, over every held-out sample."""
    return float(np.sqrt(np.mean((table[f"q_{kind}_{joint}"] - table[f"q_measured_{joint}"]) ** 2)))


def test_a_real_servo_with_a_pendulum(shared_data, tmp_path) -> None:
    (tmp_path / "pendulum.urdf").write_text(PENDULUM)
    robot = load_description(tmp_path / "pendulum.urdf")
    files = sorted((shared_data / "bam_xl330").glob("*.json"))
    logs = [(json.loads(f.read_text())["kp"] / 100.0, load_recording(f, robot=robot)) for f in files]
    fit, held = ([log for log in logs if (log[0] in (1.0, 8.0)) == fitted] for fitted in (True, False))
    gains = [gain for gain, _ in (*fit, *held)]
    result = diagnose_motion([r for _, r in fit[:4]], robot, [r for _, r in held[:2]], gains=gains[:4] + gains[-2:])
    assert_figures_agree(result, tmp_path / "found")


def test_a_real_arm_of_servos(shared_data, tmp_path) -> None:
    robot = load_description(shared_data / "so101" / "so101.xml")
    runs = ("multisine", "lissajous_pattern", "large_amplitude")
    logs = [load_recording(shared_data / "so101" / run, robot=robot) for run in runs]
    assert_figures_agree(diagnose_motion(logs[:2], robot, logs[2:]), tmp_path / "found")
