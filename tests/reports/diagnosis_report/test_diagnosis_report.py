"""The report of a diagnosis says what the verdict says, for every kind of arm and every kind of verdict."""

from __future__ import annotations

import copy
import html
import json
import re
from dataclasses import replace

import numpy as np
import pytest
from jsonschema import Draft202012Validator

from lagnet.diagnosis.verdict.report_data import JointEvidence, ReportData
from lagnet.reports.diagnosis_report import write_report

pytestmark = pytest.mark.slow

MEGABYTE = 1e6
HOSTILE = "</script><script>document.title='owned'</script><img src=x onerror=\"console.error('owned')\">&amp;"


@pytest.fixture
def page(case, tmp_path):
    return write_report(case.verdict, case.evidence, tmp_path / "report.html").read_text(encoding="utf-8")


def figures_in(page: str) -> dict:
    """The plots' data, read as strictly as a browser reads JSON."""
    text = re.search(r'<script type="application/json" id="figures">(.*?)</script>', page)[1]
    return json.loads(text, parse_constant=lambda word: pytest.fail(f"{word} is no JSON"))


def words_of(page: str) -> str:
    """The words of the page without scripts, styles and tags."""
    body = re.sub(r"<(script|style)\b.*?</\1>", " ", page, flags=re.DOTALL)
    return re.sub(r"\s+", " ", re.sub(r"<wbr>", "", body))


def renamed(node, old: str, new: str):
    """The same verdict with another name for a joint."""
    if isinstance(node, dict):
        return {key: renamed(value, old, new) for key, value in node.items()}
    if isinstance(node, list):
        return [renamed(value, old, new) for value in node]
    return new if node == old else node


def test_cases_are_valid_verdicts(case, contracts):
    schema = json.loads((contracts / "verdict.schema.json").read_text())
    assert [error.message for error in Draft202012Validator(schema).iter_errors(case.verdict)] == []


def test_page_is_small_and_self_contained(page):
    assert len(page.encode()) < 6 * MEGABYTE
    head = page[: page.index('<script type="application/json"')]
    assert not re.findall(r'(?:src|href)="(?!#|data:)', head)
    assert "default-src 'none'" in html.unescape(head)


def test_every_axis_of_numbers_has_a_unit(page):
    for key, figure in figures_in(page).items():
        for name, axis in figure["layout"].items():
            if re.fullmatch(r"[xy]axis\d*", name) and axis.get("type") != "category":
                assert re.fullmatch(r".+ \[.+\]", axis["title"]["text"]), (key, name)


def test_every_plot_has_a_place_and_every_place_a_plot(page):
    assert sorted(re.findall(r'data-figure="([^"]+)"', page)) == sorted(figures_in(page))


def test_every_effect_parameter_and_joint_is_written(case, page):
    words = words_of(page)
    for joint in case.verdict["nominal"]["joints"]:
        assert joint in words
    for effect in case.verdict["effects"]:
        assert effect["effect"] in words
        assert effect["explanation"] in words or effect["joint"] is None
        for parameter in effect["parameters"]:
            assert parameter["name"] in words
            assert parameter["unit"] in words


def test_every_abstention_and_warning_is_written(case, page):
    words = words_of(page)
    for entry in case.verdict["abstentions"]:
        assert entry["reason"] in words
        assert entry["record_next"] in words
    for warning in case.verdict["warnings"]:
        assert warning in words


def test_verdict_opens_the_page(six, tmp_path):
    page = write_report(six.verdict, six.evidence, tmp_path / "report.html").read_text(encoding="utf-8")
    lead = re.search(r'<p class="lead">(.*?)</p>', page)[1]
    assert lead.startswith("The arm differs from the model on 4 of 6 joints. Left out: viscous friction")
    assert "viscous friction and Coulomb friction on each of these" in lead
    assert "payload (tied with torque gain) on the whole arm" in lead
    assert re.search(r"Held-out torque error falls from \d+ % to [\d.]+ %", lead)


def test_a_tie_on_one_joint_is_not_said_of_the_others(six, tmp_path):
    verdict = copy.deepcopy(six.verdict)
    verdict["effects"][0] |= {"status": "tied", "tied_with": ["quadratic_drag"]}
    page = write_report(verdict, six.evidence, tmp_path / "report.html").read_text(encoding="utf-8")
    assert "viscous friction (on shoulder_pan tied with quadratic drag)" in page


def test_paths_are_shown_by_their_last_part_in_the_heading(six, tmp_path):
    verdict = copy.deepcopy(six.verdict)
    verdict["nominal"]["source"] = r"C:\robots\arm.urdf"
    page = write_report(verdict, six.evidence, tmp_path / "report.html").read_text(encoding="utf-8")
    assert '<p class="subtitle">arm.urdf against 4 recordings (240 s, 2 held out)</p>' in page
    assert r"C:\robots\arm.urdf" in page


def test_few_effects_are_given_with_their_values_and_a_slide_in_newtons(one_slide, tmp_path):
    page = write_report(one_slide.verdict, one_slide.evidence, tmp_path / "report.html").read_text(encoding="utf-8")
    assert "viscous friction on slide (203.5 ± 4.1 N s/m)" in page
    layout = figures_in(page)["joint-0-velocity"]["layout"]
    titles = {layout[name]["title"]["text"] for name in ("xaxis", "yaxis")}
    assert titles == {"velocity [m/s]", "residual force [N]"}


def test_absent_parts_leave_no_empty_sections(six, tmp_path):
    page = write_report(six.verdict, ReportData(), tmp_path / "report.html").read_text(encoding="utf-8")
    assert set(figures_in(page)) == {"fit-bars", "rival-bars"}
    assert "geometry of this model is not known" in page


def test_partial_evidence_is_taken_as_far_as_it_goes(six, tmp_path):
    bare = ReportData(joints=(JointEvidence("elbow", noise_rms=0.1),), settings={"nested": {"deep": (1, 2)}})
    page = write_report(six.verdict, bare, tmp_path / "report.html").read_text(encoding="utf-8")
    assert "nested.deep" in page


def test_hostile_names_stay_words_in_page_and_plots(six, tmp_path):
    verdict = renamed(copy.deepcopy(six.verdict), "elbow", HOSTILE)
    verdict["recordings"][0]["path"] = verdict["nominal"]["source"] = HOSTILE
    joints = tuple(
        JointEvidence(HOSTILE, entry.unit, entry.held_out, entry.residual, entry.law)
        if entry.joint == "elbow"
        else entry
        for entry in six.evidence.joints
    )
    evidence = ReportData(
        joints, settings={HOSTILE: HOSTILE}, versions={HOSTILE: HOSTILE}, checksums={HOSTILE: HOSTILE}
    )
    page = write_report(verdict, evidence, tmp_path / "report.html").read_text(encoding="utf-8")
    assert "<script>document" not in page
    assert "<img" not in page
    assert "&lt;img" in json.dumps(figures_in(page)["fit-bars"])


def test_numbers_that_are_not_finite_do_not_break_the_page(six, tmp_path):
    entry = six.evidence.joints[0]
    measured = np.array(entry.held_out.measured)
    measured[10:20] = np.nan
    series = replace(entry.held_out, measured=measured)
    evidence = ReportData((replace(entry, held_out=series, noise_rms=float("nan"), predictable_share=float("nan")),))
    page = write_report(six.verdict, evidence, tmp_path / "report.html").read_text(encoding="utf-8")
    assert "joint-0-time" in figures_in(page)


@pytest.mark.browser
def test_page_opens_without_errors(case, tmp_path, browse):
    seen = browse(write_report(case.verdict, case.evidence, tmp_path / "report.html"))
    assert seen.console == ()
    assert seen.requests == ()
    curves = 2 * any(entry.held_out for entry in case.evidence.joints)
    identified = bool(case.verdict.get("identified"))
    assert seen.drawn == curves + 1 + bool(case.verdict["effects"]) + identified  # one joint is shown; fit; rivals
    assert seen.dom.count('class="main-svg"') >= seen.drawn
    for effect in case.verdict["effects"]:
        assert effect["effect"] in seen.text
        assert effect["effect"].replace("_", " ").lower() in seen.text.lower()


@pytest.mark.browser
def test_every_joint_is_drawn_when_all_are_asked_for(six, tmp_path, browse):
    path = write_report(six.verdict, six.evidence, tmp_path / "report.html")
    page = path.read_text(encoding="utf-8").replace('aria-pressed="true"', 'aria-pressed="false"')
    path.write_text(page.replace('data-show="*" aria-pressed="false"', 'data-show="*" aria-pressed="true"'), "utf-8")
    seen = browse(path)
    assert seen.console == ()
    assert seen.drawn == len(figures_in(page)) == 2 * 6 + 2


@pytest.mark.browser
def test_hostile_page_runs_nothing(six, tmp_path, browse):
    verdict = renamed(copy.deepcopy(six.verdict), "elbow", HOSTILE)
    seen = browse(write_report(verdict, six.evidence, tmp_path / "report.html"))
    assert seen.console == ()
    assert seen.requests == ()
    assert "<title>Simulation against recordings</title>" in seen.dom
