"""Every figure in words, verdict.json and report, computed anew from holdout_torque.parquet and compared as written."""

from __future__ import annotations

import json
import re
from html import unescape
from pathlib import Path
from statistics import median

import numpy as np
import pyarrow.parquet as pq
import pytest

from lagnet.diagnosis.diagnose import Diagnosis
from lagnet.diagnosis.writing import write_diagnosis
from lagnet.percent import percent as verdict_percent
from lagnet.recordings.conditioning.smoothing import SETTLING, SHORTEST, even_clock, low_pass, resample
from lagnet.reports.diagnosis_report import write_report
from lagnet.reports.wording import number, percent

LAYERS = {"nominal": "nominal", "named": "named", "identified": "identified", "full": "corrected"}
SAME = 1e-9  # relative: one sum in another order
FIGURE = re.compile(r"(?:(?:less than|<) )?[\d.]+ %")
LEFT = re.compile(r"named physics[a-z ]* leaves (?:most at \S+: )?((?:less than )?[\d.]+ %)")


def assert_figures_agree(result: Diagnosis, folder: Path) -> None:
    """One diagnosis, written into a folder."""
    verdict, table, page = written(result, folder)
    fits = [recomputed(result, table, fit, joint) for joint, fit in enumerate(verdict["fit"])]
    for fit, again in zip(verdict["fit"], fits, strict=True):
        for layer in LAYERS:
            assert fit[f"nmse_{layer}"] == pytest.approx(again[f"nmse_{layer}"], rel=SAME)
    assert_words_of_effects(verdict, fits)
    assert_headline(verdict, fits, page)
    assert_table_of_the_report(fits, page)


def written(result: Diagnosis, folder: Path) -> tuple[dict, dict[str, np.ndarray], str]:
    """verdict.json, the columns of holdout_torque.parquet, and the report."""
    write_diagnosis(result, folder)
    verdict = json.loads((folder / "verdict.json").read_text(encoding="utf-8"))
    page = write_report(verdict, result.evidence, folder / "report.html").read_text(encoding="utf-8")
    table = pq.read_table(folder / "holdout_torque.parquet").to_pydict()
    return verdict, {name: np.array(values) for name, values in table.items()}, page


def recomputed(result: Diagnosis, table: dict[str, np.ndarray], fit: dict, joint: int) -> dict:
    """The entry of a joint in `fit`, its errors computed from the table."""
    errors = {f"nmse_{layer}": nmse_of(result, table, joint, column) for layer, column in LAYERS.items()}
    return {**fit, **errors}


def nmse_of(result: Diagnosis, table: dict[str, np.ndarray], joint: int, layer: str) -> float:
    """nMSE as the verdict takes it: each stretch without a gap low-passed, without the ends of the filter."""
    rate, bandwidth = result.conditioned_holdout.rate, result.verdict.conditioning["bandwidth_hz"]
    settle = int(np.ceil(SETTLING * rate / bandwidth))
    used = ~table.get("set_aside", np.zeros(len(table["time"]), dtype=bool))
    begins = np.cumsum([0, *(len(r) for r in result.holdout_recordings)])
    parts = []
    for stretch in result.conditioned_holdout.stretches:
        rows = np.arange(stretch.first, stretch.last + 1) + begins[stretch.recording]
        rows = rows[used[rows]]
        time, measured, modelled = (table[n][rows] for n in ("time", f"tau_measured_{joint}", f"tau_{layer}_{joint}"))
        both = np.column_stack([measured, measured - modelled])
        smooth = low_pass(resample(time, both, even_clock(time, rate)), rate, bandwidth)
        parts.append(smooth[settle:-settle] if len(smooth) > 2 * settle + SHORTEST else smooth)
    measured, error = np.concatenate(parts).T
    return float(np.mean(error**2) / np.var(measured))


def assert_words_of_effects(verdict: dict, fits: list[dict]) -> None:
    """What an effect's sentence says that named physics leaves is of the table; its other figures, of its evidence."""
    of_table = {verdict_percent(fit["nmse_named"]) for fit in fits}
    for effect in verdict["effects"]:
        evidence, words = effect["evidence"], effect["explanation"]
        assert set(LEFT.findall(words)) <= of_table
        own = {verdict_percent(evidence[f"holdout_nmse_{which}"]) for which in ("without", "with")}
        assert set(FIGURE.findall(words)) <= of_table | own


def assert_headline(verdict: dict, fits: list[dict], page: str) -> None:
    """The opening sentence and the tiles: errors of layers, their median and their worst."""
    lead = unescape(re.search(r'<p class="lead">(.*?)</p>', page, flags=re.DOTALL)[1])
    tiles = unescape(re.search(r'<ul class="tiles">(.*?)</ul>', page, flags=re.DOTALL)[1])
    differing = {entry["joint"] for entry in verdict["mismatch"]["joints"] if entry["significant"]}
    shown = [fit for fit in fits if fit["joint"] in differing]
    keys = [f"nmse_{layer}" for layer in LAYERS]
    if "Held-out torque error" in lead:
        sentence = lead[lead.index("Held-out torque error") :]
        told = {percent(median(fit[key] for fit in shown)) for key in keys}
        told |= {percent(max(fit[key] for fit in fits)) for key in keys}
        told |= {percent(fit["nmse_noise_floor"]) for fit in fits}
        figures = FIGURE.findall(sentence)
        assert figures
        assert set(figures) <= told
        if len(fits) > 1:
            assert f"worst: {max(fits, key=lambda fit: fit['nmse_named'])['joint']}," in sentence
    of_joints = {f"{percent(fit['nmse_nominal'])} → {percent(fit['nmse_named'])}" for fit in fits}
    of_joints |= {percent(fit["nmse_nominal"]) for fit in fits}
    errors = re.findall(r"<strong>([^<]*)</strong> <span>held-out torque error of", tiles)
    assert len(errors) == 1
    assert set(errors) <= of_joints


def assert_table_of_the_report(fits: list[dict], page: str) -> None:
    """Every cell of the table of errors."""
    body = page[page.index("Torque error on held-out recordings (nMSE") :]
    rows = re.findall(r"<tr><td class=\"name\">(.*?)</tr>", body[: body.index("</table>")], flags=re.DOTALL)
    assert len(rows) == len(fits)
    for fit, row in zip(fits, rows, strict=True):
        *errors, floor = (unescape(cell) for cell in re.findall(r'<td class="number">(.*?)</td>', row))
        assert floor == number(fit["nmse_noise_floor"])
        assert errors[0] == number(fit["nmse_nominal"])
        assert set(errors) <= {number(fit[f"nmse_{layer}"]) for layer in LAYERS}
        assert errors[-1] == number(fit["nmse_full"])
