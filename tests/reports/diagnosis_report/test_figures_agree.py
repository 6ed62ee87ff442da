"""Words, report, verdict.json and holdout_torque.parquet of one diagnosis hold the same figures."""

from __future__ import annotations

import json
import re
from pathlib import Path
from statistics import median

import numpy as np
import pyarrow.parquet as pq
import pytest
from tests.diagnosis.conftest import Plant

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.verdict.wording import percent as verdict_percent
from lagnet.diagnosis.writing import write_diagnosis
from lagnet.recordings.conditioning.smoothing import SETTLING, even_clock, low_pass, resample
from lagnet.recordings.loading.load import load_recording
from lagnet.reports.diagnosis_report import write_report
from lagnet.reports.wording import percent
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import load_description

LAYERS = {"nominal": "nominal", "named": "named", "identified": "identified", "full": "corrected"}
SAME = 1e-9  # relative: one sum in another order
FIGURE = re.compile(r"(?:(?:less than|<) )?[\d.]+ %")


def written(result, folder: Path) -> tuple[dict, dict[str, np.ndarray], str]:
    """verdict.json, the columns of holdout_torque.parquet, and the report's opening sentences."""
    write_diagnosis(result, folder)
    verdict = json.loads((folder / "verdict.json").read_text(encoding="utf-8"))
    page = write_report(verdict, result.evidence, folder / "report.html").read_text(encoding="utf-8")
    table = pq.read_table(folder / "holdout_torque.parquet").to_pydict()
    lead = re.search(r'<p class="lead">(.*?)</p>', page, flags=re.DOTALL)[1]
    return verdict, {name: np.array(values) for name, values in table.items()}, lead.replace("&lt;", "<")


def nmse_of(table: dict[str, np.ndarray], verdict: dict, joint: int, layer: str) -> float:
    """nMSE of one unbroken held-out recording as the verdict takes it: low-passed, without the ends of the filter."""
    (rate,) = (r["rate_hz"] for r in verdict["recordings"] if r["role"] == "holdout")
    bandwidth = verdict["conditioning"]["bandwidth_hz"]
    used = ~table.get("set_aside", np.zeros(len(table["time"]), dtype=bool))
    time, measured, modelled = (table[n][used] for n in ("time", f"tau_measured_{joint}", f"tau_{layer}_{joint}"))
    both = np.column_stack([measured, measured - modelled])
    smooth = low_pass(resample(time, both, even_clock(time, rate)), rate, bandwidth)
    settle = int(np.ceil(SETTLING * rate / bandwidth))
    measured, error = smooth[settle:-settle].T
    return float(np.mean(error**2) / np.var(measured))


def assert_figures_agree(result, folder: Path) -> None:
    verdict, table, lead = written(result, folder)
    for joint, fit in enumerate(verdict["fit"]):
        for layer, column in LAYERS.items():
            assert fit[f"nmse_{layer}"] == pytest.approx(nmse_of(table, verdict, joint, column), rel=SAME)
    fits = verdict["fit"]
    for effect in verdict["effects"]:
        evidence = effect["evidence"]
        figures = [evidence["holdout_nmse_without"], evidence["holdout_nmse_with"], *(f["nmse_named"] for f in fits)]
        assert set(FIGURE.findall(effect["explanation"])) <= {verdict_percent(value) for value in figures}
    sentence = lead[lead.index("Held-out torque error") :]
    differing = {entry["joint"] for entry in verdict["mismatch"]["joints"] if entry["significant"]}
    shown = [fit for fit in fits if fit["joint"] in differing]
    keys = [key for key in ("nmse_nominal", "nmse_named", "nmse_full") if any(fit[key] for fit in fits)]
    told = {percent(median(fit[key] for fit in shown)) for key in keys}
    told |= {percent(max(fit[key] for fit in fits)) for key in keys}
    told |= {percent(fit["nmse_noise_floor"]) for fit in fits}
    assert set(FIGURE.findall(sentence)) <= told
    if len(fits) > 1:
        assert f"worst: {max(fits, key=lambda fit: fit['nmse_named'])['joint']}," in sentence


@pytest.mark.slow
def test_a_small_arm(tmp_path) -> None:
    arm = random_arm(2, seed=12, kinds=("revolute",), fixed=False)
    plant = Plant(arm, [lambda q, v, a, load: np.array([1.2, 0.5]) * v, lambda q, v, a, load: 0.2 * np.sin(3.0 * q)])
    result = diagnose([plant.record(1, 20.0)], arm, [plant.record(2, 20.0)])
    assert result.effects
    assert_figures_agree(result, tmp_path)


@pytest.mark.shared_data
@pytest.mark.slow
def test_a_real_slide(shared_data, tmp_path) -> None:
    folder = shared_data / "emps"
    robot = load_description(folder / "emps.urdf")
    fit, held = (load_recording(folder / f"{name}.csv.gz", robot=robot) for name in ("fit", "holdout"))
    assert_figures_agree(diagnose([fit], robot, [held]), tmp_path)
