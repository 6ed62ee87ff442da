"""The layers of the correction: bars of those that change something, and the identified one in words and plots."""

from __future__ import annotations

import copy
import html
import re

import pytest

from lagnet.reports.contents.findings import Findings
from lagnet.reports.diagnosis_report import write_report
from lagnet.reports.sections import fit, identified


def findings_of(case, **changes) -> Findings:
    return Findings({**copy.deepcopy(case.verdict), **changes}, case.evidence)


def keys_of(fits: list[dict]) -> list[str]:
    return [key for key, *_ in fit.layers_of(fits)]


def test_every_layer_that_changes_an_error_has_bars(all_layers) -> None:
    fits = copy.deepcopy(all_layers.verdict["fit"])
    assert keys_of(fits) == ["nmse_nominal", "nmse_named", "nmse_identified", "nmse_full"]
    for entry in fits:
        entry["nmse_full"] = entry["nmse_identified"]  # nothing was learned
    assert keys_of(fits) == ["nmse_nominal", "nmse_named", "nmse_identified"]
    for entry in fits:
        entry["nmse_named"] = entry["nmse_nominal"]  # nothing was named
    assert keys_of(fits) == ["nmse_nominal", "nmse_identified"]
    for entry in fits:
        entry["nmse_identified"] = entry["nmse_full"] = None  # a verdict without layers
    assert keys_of(fits) == ["nmse_nominal"]


def test_bars_hold_the_figures_of_the_verdict(all_layers) -> None:
    part = fit.build(findings_of(all_layers))
    bars = {trace["name"]: trace["x"] for trace in part.figures[0].traces if trace["type"] == "bar"}
    for key, words, _ in fit.KINDS:
        assert bars[words] == [entry[key] for entry in all_layers.verdict["fit"]]


def test_what_differs_is_told_with_interval_and_share(all_layers) -> None:
    body = html.unescape(str(identified.build(findings_of(all_layers)).body))
    assert "0.410 ± 0.040" in body
    assert "12 %" in body
    assert all_layers.verdict["identified"]["words"] in body
    assert "wrist_1 and wrist_2: viscous friction of what turns with both" in re.sub(r"<[^>]+>", "", body)
    assert "0.80 ± 0.10 N m" in body


def test_long_combinations_are_shortened_to_their_largest_factors_and_kept_whole_in_their_title(all_layers) -> None:
    text = all_layers.verdict["identified"]["bodies"][0]["combination"]
    short = identified._combination(text)
    assert short["short"] == "I_zz(elbow) + 0.31 mc_x(wrist_1) - 0.2 m(wrist_1) + 1 I_yy(wrist_1)"
    assert short["left_out"] == 2
    assert f'title="{text}"' in str(identified.build(findings_of(all_layers)).body)


def test_weaker_combinations_are_folded_and_none_is_lost(all_layers) -> None:
    body = html.unescape(str(identified.build(findings_of(all_layers)).body))
    n = len(all_layers.verdict["identified"]["bodies"])
    assert f"{n - identified.SHOWN} weaker combinations" in body
    assert body.count("kg m") >= n


def test_one_curve_a_joint_on_axes_of_its_own_within_the_figure(all_layers) -> None:
    (figure,) = identified.build(findings_of(all_layers)).figures
    joints = [entry["joint"] for entry in all_layers.verdict["identified"]["joints"]]
    assert len(joints) == 4
    assert [trace["name"] for trace in figure.traces] == joints
    assert len({trace["xaxis"] for trace in figure.traces}) == len(joints)
    boxes = []
    for trace in figure.traces:
        x, y = (figure.layout[f"{a}axis{trace[f'{a}axis'][1:]}"] for a in "xy")
        assert x["title"]["text"] == "speed [rad/s]"
        assert y["title"]["text"] == "torque [N m]"
        boxes.append((*x["domain"], *y["domain"]))
        assert all(0 <= edge <= 1 for edge in boxes[-1])
    for n, a in enumerate(boxes):
        for b in boxes[:n]:
            assert a[1] < b[0] or b[1] < a[0] or a[3] < b[2] or b[3] < a[2]


def test_what_changes_over_the_range_of_a_joint_has_a_plot_over_position(all_layers) -> None:
    found = copy.deepcopy(all_layers.verdict["identified"])
    found["joints"][1]["curve_over_position"] = {
        "position": [-1.0, 0.0, 1.0], "torque": [0.0, 5.0, 9.0], "friction": [40.0, 20.0, 30.0], "at_speed": 0.5,
    }  # fmt: skip
    part = identified.build(findings_of(all_layers, identified=found))
    _, figure = part.figures
    assert figure.layout["xaxis"]["title"]["text"] == "position [rad]"
    assert figure.layout["yaxis"]["title"]["text"] == "torque [N m]"
    assert [trace["name"] for trace in figure.traces] == [found["joints"][1]["joint"]] * 2
    assert [trace["line"]["dash"] for trace in figure.traces] == ["solid", "dash"]
    assert "Torque and friction over position" in str(part.body)


def test_a_curve_that_is_nothing_beside_the_joints_torque_is_not_drawn(all_layers) -> None:
    found = copy.deepcopy(all_layers.verdict["identified"])
    tiny = found["joints"][1]
    tiny["friction_curve"]["torque"] = [1e-3 * t for t in tiny["friction_curve"]["torque"]]
    (figure,) = identified.build(findings_of(all_layers, identified=found)).figures
    assert tiny["joint"] not in [trace["name"] for trace in figure.traces]
    assert len(figure.traces) == len(found["joints"]) - 1


@pytest.mark.parametrize(
    "found", [{}, {"bodies": [], "undetermined": [], "joints": [], "ties": [], "words": "Nothing."}]
)
def test_an_empty_layer_has_no_section(all_layers, found) -> None:
    assert identified.build(findings_of(all_layers, identified=found)) is None


def test_the_section_stands_between_what_was_rejected_and_what_is_left(all_layers, tmp_path) -> None:
    page = write_report(all_layers.verdict, all_layers.evidence, tmp_path / "report.html").read_text(encoding="utf-8")
    sections = re.findall(r'<section id="([^"]+)"', page)
    assert sections.index("rivals") < sections.index("identified") < sections.index("unexplained")
