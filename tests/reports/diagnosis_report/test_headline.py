"""The top of the page speaks of remainders that matter; the table further down holds all."""

from __future__ import annotations

import copy
from types import SimpleNamespace

import pytest

from lagnet.diagnosis.verdict.wording import BESIDE_FREE_LINKS
from lagnet.reports.contents.findings import Findings
from lagnet.reports.held_out_error import error_falls
from lagnet.reports.sections import headline


def test_a_remainder_that_the_page_writes_as_nothing_is_not_in_the_headline() -> None:
    left = [
        {"joint": "wrist", "above_noise": True, "share_of_mismatch": 1.0},
        {"joint": "elbow", "above_noise": True, "share_of_mismatch": 0.2},
        {"joint": "base", "above_noise": False, "share_of_mismatch": 0.9},
    ]
    error = {"wrist": 5e-5, "elbow": 0.1, "base": 0.1}
    findings = SimpleNamespace(verdict={"unexplained": left}, fit=lambda joint: {"nmse_nominal": error[joint]})
    assert [entry["joint"] for entry in headline._remainder(findings)] == ["elbow"]


def findings_of(case, **errors) -> Findings:
    """The findings with other held-out errors, one for each joint."""
    verdict = copy.deepcopy(case.verdict)
    for key, values in errors.items():
        for fit, value in zip(verdict["fit"], values, strict=True):
            fit[key] = value
    return Findings(verdict, case.evidence)


def test_a_median_is_told_with_the_worst_joint_of_the_whole_arm(six) -> None:
    nominal, named = [0.8, 0.6, 0.7, 0.5, 0.01, 0.02], [0.01, 0.03, 0.02, 0.04, 0.01, 1.65]
    findings = findings_of(six, nmse_nominal=nominal, nmse_named=named, nmse_noise_floor=[1e-6] * 6)
    assert error_falls(findings) == (
        "Held-out torque error falls from 65 % to 2.5 % (median of the joints that differ; worst: wrist_3, 165 %)."
    )


def test_all_layers_are_told_beside_the_named_physics_with_a_worst_joint_of_their_own(six) -> None:
    named, full = [0.04, 0.04, 0.04, 0.04, 0.1, 0.02], [0.02, 0.02, 0.02, 0.03, 0.01, 0.02]
    findings = findings_of(
        six, nmse_nominal=[0.5] * 6, nmse_named=named, nmse_identified=full, nmse_full=full, nmse_noise_floor=[1e-6] * 6
    )
    assert error_falls(findings) == (
        "Held-out torque error falls from 50 % to 4.0 % (median of the joints that differ; worst: wrist_2, 10 %) "
        "and to 2.0 % with all layers (worst: wrist_1, 3.0 %)."
    )


def test_a_worst_joint_that_is_mostly_noise_is_said_to_be(six) -> None:
    findings = findings_of(six, nmse_named=[0.01] * 5 + [0.9], nmse_noise_floor=[0.001] * 5 + [0.88])
    assert "worst: wrist_3, 90 %, noise alone 88 %" in error_falls(findings)


def test_one_joint_has_neither_median_nor_worst(one_slide) -> None:
    findings = findings_of(one_slide, nmse_nominal=[0.4], nmse_named=[0.02])
    assert error_falls(findings) == "Held-out torque error falls from 40 % to 2.0 %."


def test_a_layer_that_makes_the_median_worse_does_not_let_it_fall(one_slide) -> None:
    assert "changes from 1.0 % to 2.0 %" in error_falls(findings_of(one_slide, nmse_nominal=[0.01], nmse_named=[0.02]))


def test_what_an_arm_has_less_of_than_its_model_is_not_told_as_left_out(six) -> None:
    findings = findings_of(six)
    joints = findings.joints[:2]
    signs = {("coulomb_friction", joints[0]): -0.2, ("coulomb_friction", joints[1]): 0.3}
    findings.verdict["effects"] = [
        {
            "effect": effect,
            "joint": joint,
            "tied_with": [],
            "explanation": "",
            "parameters": [{"name": "Fc", "value": value, "unit": "N m", "ci95": [value - 0.01, value + 0.01]}],
        }
        for (effect, joint), value in signs.items()
    ]
    sentences = headline._left_out(findings)
    assert [s.split(":")[0] for s in sentences] == ["Left out", "Less than modelled"]
    assert joints[1] in sentences[0]
    assert joints[0] in sentences[1]
    assert [cause["less"] for cause in headline._causes(findings)] == [True, False]


@pytest.mark.parametrize("beside", [False, True])
def test_links_that_differ_are_told_before_the_names_that_were_judged_beside_them(six, beside: bool) -> None:
    findings = findings_of(six)
    findings.verdict["warnings"] = [BESIDE_FREE_LINKS] if beside else []
    sentences = headline._sentences(findings)
    assert (headline.LINKS in sentences) == beside
    assert sentences[1] == headline.LINKS or sentences[1].startswith("Left out")


@pytest.mark.parametrize(("side", "told"), [(0.0, False), (1.0, True)])
def test_the_torque_that_friction_follows_is_told_in_words(side: float, told: bool) -> None:
    parameters = [
        {"name": name, "value": value, "unit": "–", "ci95": [value, value]}
        for name, value in (("K", 0.1), ("side", side))
    ]
    words = headline._values({"effect": "load_dependent_friction", "parameters": parameters})
    assert not any("side" in w for w in words)
    assert any("torque of the motor" in w for w in words) == told
