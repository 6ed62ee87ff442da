"""Diagnoses to write about: verdicts on made-up arms whose torque was made with known friction."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from scipy.signal import butter, sosfiltfilt

from lagnet.diagnosis.verdict.report_data import (
    Comparison,
    FrictionLaw,
    HeldOutSeries,
    JointEvidence,
    ReportData,
    ResidualByVelocity,
    SelectionStep,
    Skeleton,
)

RATE, BANDWIDTH = 100.0, 5.0
SHA = "3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855e"
UR_JOINTS = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")
UR_POINTS = np.array(
    [[0, 0, 0], [0, 0, 0.18], [0, -0.17, 0.18], [0.35, -0.17, 0.62], [0.8, -0.17, 0.42], [0.8, -0.29, 0.42],
     [0.8, -0.29, 0.30], [0.8, -0.37, 0.30]]
)  # fmt: skip
UR_AXES = np.array([[0, 0, 1], [0, 1, 0], [0, 1, 0], [0, 1, 0], [0, 0, -1], [0, 1, 0]], dtype=float)


@dataclass(frozen=True)
class Case:
    """A verdict and the arrays behind it."""

    verdict: dict[str, Any]
    evidence: ReportData


@dataclass(frozen=True)
class Joint:
    """A made-up joint: what its friction really is (none if zero) and how much torque the model rightly foresees."""

    name: str
    viscous: float = 0.0
    coulomb: float = 0.0
    size: float = 30.0
    unit: str = "N m"


def low_passed(values: np.ndarray) -> np.ndarray:
    return sosfiltfilt(butter(4, BANDWIDTH, fs=RATE, output="sos"), values, axis=0)


def joint_case(joint: Joint, rng: np.random.Generator, n: int) -> tuple[JointEvidence, dict[str, float]]:
    """The evidence on one joint that moves by a sum of sines, and its nMSE before, after and of noise alone."""
    time = np.arange(n) / RATE
    pace, phase = rng.uniform(0.2, 0.9, (4, 1)), rng.uniform(0, 6, (4, 1))
    v = np.cos(2 * np.pi * pace * time + phase).sum(axis=0) * 0.4
    a = np.gradient(v, time)
    nominal = joint.size * (np.sin(np.cumsum(v) / RATE) + 0.1 * a)
    friction = joint.viscous * v + joint.coulomb * np.tanh(v / 0.01)
    noise = 0.15 * joint.size * rng.standard_normal(n)
    corrected = low_passed(nominal + friction * (1 + 0.01 * rng.standard_normal()))
    measured, nominal = low_passed(nominal + friction + noise), low_passed(nominal)
    share = {
        "nominal": float(np.mean((measured - nominal) ** 2) / np.var(measured)),
        "named": float(np.mean((measured - corrected) ** 2) / np.var(measured)),
        "noise": float(np.var(low_passed(noise)) / np.var(measured)),
        "residual_rms": float(np.sqrt(np.mean((measured - nominal) ** 2))),
        "noise_rms": float(np.std(low_passed(noise))),
    }
    half = n // 2
    grid = np.linspace(v.min(), v.max(), 201)
    law = joint.viscous * grid + joint.coulomb * np.tanh(grid / 0.01)
    evidence = JointEvidence(
        joint.name,
        joint.unit,
        HeldOutSeries(
            np.r_[time[:half], time[: n - half]], measured, nominal, corrected, ((0, half), (half, n)),
            ("holdout_a.csv", "holdout_b.csv"),
        ),
        ResidualByVelocity(v, measured - nominal, measured - corrected),
        FrictionLaw(("viscous_friction", "coulomb_friction"), grid, law) if joint.viscous or joint.coulomb else None,
        share["noise_rms"],
        0.97,
    )  # fmt: skip
    return evidence, share


def mismatch_entry(joint: Joint, share: dict[str, float], found: bool) -> dict[str, Any]:
    where = [
        {"regime": "high_speed", "rule": f"|v_{joint.name}| > 0.81 rad/s", "share_of_residual": 0.52,
         "share_of_time": 0.21, "lift": 2.48},
        {"regime": "velocity_reversal", "rule": f"|v_{joint.name}| < 0.05 rad/s", "share_of_residual": 0.02,
         "share_of_time": 0.09, "lift": 0.22},
    ]  # fmt: skip
    return {
        "joint": joint.name, "significant": found, "residual_rms": share["residual_rms"],
        "noise_rms": share["noise_rms"], "nmse_nominal": share["nominal"], "where": where if found else [],
    }  # fmt: skip


def effect_entry(name: str, joint: str, value: float, unit: str, share: dict[str, float]) -> dict[str, Any]:
    word = {"viscous_friction": "Fv", "coulomb_friction": "Fc"}[name]
    return {
        "effect": name, "joint": joint, "status": "named", "tied_with": [],
        "parameters": [{"name": word, "value": value, "unit": unit, "ci95": [0.98 * value, 1.02 * value]}],
        "evidence": {
            "holdout_nmse_without": share["nominal"], "holdout_nmse_with": share["named"],
            "share_of_mismatch": 0.48, "best_rival": "quadratic_drag", "log10_odds_over_best_rival": 61.2,
        },
        "interval_s": None,
        "explanation": f"Torque of {joint} grows with its speed as the model does not foresee; add {value:.3g} {unit}.",
    }  # fmt: skip


def empty_verdict(joints: list[Joint], shares: list[dict[str, float]]) -> dict[str, Any]:
    """A verdict that names nothing yet, with every entry that the schema asks for."""
    recordings = [
        {
            "path": f"runs/{name}.csv",
            "role": role,
            "sha256": SHA,
            "n_samples": 6000,
            "duration_s": 60.0,
            "rate_hz": RATE,
        }
        for name, role in (("fit_0", "fit"), ("fit_1", "fit"), ("holdout_a", "holdout"), ("holdout_b", "holdout"))
    ]  # fmt: skip
    found = [bool(joint.viscous or joint.coulomb) for joint in joints]
    return {
        "schema": "lagnet-verdict/1", "lagnet_version": "0.1.0", "seed": 0,
        "nominal": {"kind": "urdf", "source": "arm.urdf", "sha256": SHA, "joints": [joint.name for joint in joints]},
        "recordings": recordings,
        "conditioning": {"rate_hz": RATE, "bandwidth_hz": BANDWIDTH, "velocity_from": "recorded",
                         "acceleration_from": "differentiated"},
        "mismatch": {"found": any(found), "joints": list(map(mismatch_entry, joints, shares, found))},
        "effects": [],
        "unexplained": [
            {"joint": joint.name, "above_noise": False, "share_of_mismatch": 0.004, "depends_on": []}
            for joint in joints
        ],
        "fit": [
            {"joint": joint.name, "nmse_nominal": share["nominal"], "nmse_named": share["named"],
             "nmse_named_and_residual_network": None, "nmse_noise_floor": share["noise"]}
            for joint, share in zip(joints, shares, strict=True)
        ],
        "abstentions": [], "warnings": [],
    }  # fmt: skip


def diagnosis_of(joints: list[Joint], n: int = 12000, skeleton: Skeleton | None = None) -> Case:
    """The verdict that names each joint's friction, and its evidence."""
    rng = np.random.default_rng(7)
    entries, shares = zip(*[joint_case(joint, rng, n) for joint in joints], strict=True)
    verdict = empty_verdict(joints, list(shares))
    for joint, share in zip(joints, shares, strict=True):
        speed = "m" if joint.unit == "N" else "rad"
        for name, value, unit in (
            ("viscous_friction", joint.viscous, f"{joint.unit} s/{speed}"),
            ("coulomb_friction", joint.coulomb, joint.unit),
        ):
            if value:
                verdict["effects"].append(effect_entry(name, joint.name, value, unit, share))
    comparisons = tuple(
        Comparison(
            e["effect"], e["joint"], (("quadratic_drag", 61.2), ("time_delay", 118.0), ("stribeck_friction", 3.4))
        )
        for e in verdict["effects"]
    )
    steps = tuple(
        SelectionStep(e["effect"], e["joint"], 0.5 * 0.6**i + 0.004) for i, e in enumerate(verdict["effects"])
    )
    settings = {"seed": 0, "blocks": 8, "bandwidth_hz": BANDWIDTH, "limits": {"odds": 1.0, "share": 0.01}}
    evidence = ReportData(
        entries, comparisons, skeleton, steps, settings, {"lagnet": "0.1.0", "numpy": "2.4.6"}, {"runs/fit_0.csv": SHA}
    )
    return Case(verdict, evidence)


def six_joints() -> Case:
    frictions = ((14.2, 9.1), (11.0, 8.0), (9.3, 6.4), (2.4, 1.7), (0, 0), (0, 0))
    sizes = (12.0, 60.0, 35.0, 6.0, 4.0, 1.0)
    joints = [Joint(name, *f, size) for name, f, size in zip(UR_JOINTS, frictions, sizes, strict=True)]
    case = diagnosis_of(joints, skeleton=Skeleton(UR_POINTS, UR_AXES))
    verdict = case.verdict
    payload = effect_entry("viscous_friction", "wrist_3", 1.84, "kg", {"nominal": 0.01, "named": 0.004})
    centre = {"name": "com_x", "value": 0.0031, "unit": "m", "ci95": [-0.002, 0.0082]}
    payload |= {
        "effect": "payload",
        "joint": None,
        "parameters": [{**payload["parameters"][0], "name": "mass"}, centre],
    }
    payload |= {"status": "tied", "tied_with": ["torque_gain"]}
    payload["evidence"] |= {"best_rival": "torque_gain", "log10_odds_over_best_rival": 0.31}
    payload["explanation"] = "A load of 1.8 kg at the flange is missing, or the gain of the current sensor is wrong."
    verdict["effects"].append(payload)
    verdict["unexplained"][3] |= {"above_noise": True, "share_of_mismatch": 0.12, "depends_on": ["q_3", "v_4", "time"]}
    for joint in ("wrist_2", "wrist_3"):
        verdict["abstentions"].append(
            {"effect": "backlash", "joint": joint, "reason": "the torque never changes sign while the joint moves",
             "record_next": "slow motion of the joint through the pose where gravity changes sides"}
        )  # fmt: skip
    verdict["warnings"].append("runs/fit_1.csv: a gap of 0.4 s at t = 31.2 s splits the recording")
    return case


def layered() -> Case:
    """An arm of six joints with all layers: friction named, bodies and curves identified, a remainder learned."""
    case = six_joints()
    for number, fit in enumerate(case.verdict["fit"]):
        fit["nmse_identified"] = fit["nmse_named"] * (0.5 if number < 4 else 1.0)
        fit["nmse_full"] = fit["nmse_identified"] * (0.8 if number == 2 else 1.0)
        fit["nmse_named_and_residual_network"] = fit["nmse_full"]
    long = "I_zz(elbow) + 0.31 mc_x(wrist_1) - 0.2 m(wrist_1) + 1 I_yy(wrist_1) + 0.02 m(wrist_2) - 0.01 m(wrist_3)"
    bodies = [
        {"combination": long, "link": "elbow", "change": 0.41, "unit": "kg m²", "ci95": [0.37, 0.45],
         "share_of_torque": 0.12},
        *({"combination": f"mc_x({joint})", "link": joint, "change": -0.2, "unit": "kg m", "ci95": [-0.25, -0.15],
           "share_of_torque": 0.05} for joint in UR_JOINTS),
        *({"combination": f"mc_y({joint})", "link": joint, "change": 0.1, "unit": "kg m", "ci95": [0.05, 0.15],
           "share_of_torque": 0.03} for joint in UR_JOINTS),
    ]  # fmt: skip
    speed = np.r_[-1.0, -0.5, -0.1, 0.1, 0.5, 1.0]
    own = [
        {"joint": joint,
         "terms": [{"term": "dry", "scale": 1.0, "weight": 0.8, "ci95": [0.7, 0.9]},
                   {"term": "rotor", "scale": 1.0, "weight": 0.03, "ci95": [0.01, 0.05]}],
         "friction_curve": {"speed": speed.tolist(), "torque": (0.8 * np.sign(speed) + 0.3 * speed**3).tolist()}}
        for joint in UR_JOINTS[:4]
    ]  # fmt: skip
    case.verdict["identified"] = {
        "bodies": bodies, "undetermined": ["m(shoulder_pan)", long], "joints": own,
        "ties": [{"joints": ["wrist_1", "wrist_2"], "term": "cross_viscous", "weight": 0.7}],
        "samples_that_count_as_one": 12.0,
        "words": "The inertia of the links behind elbow and wrist_1 differs from the model's.",
    }  # fmt: skip
    return case


def slide() -> Case:
    return diagnosis_of([Joint("slide", 203.5, 20.4, 60.0, "N")])


def eight_long_names() -> Case:
    joints = [
        Joint(f"left_manipulator_segment_{i}_actuated_rotary_joint_with_a_long_name", 3.0 + i, 1.0 + 0.2 * i)
        for i in range(8)
    ]
    points = np.c_[np.linspace(0, 0.5, 10), 0.1 * np.sin(np.arange(10)), np.linspace(0, 1.1, 10)]
    return diagnosis_of(joints, 6000, Skeleton(points, np.tile([0.0, 1.0, 0.0], (8, 1))))


def no_mismatch() -> Case:
    return diagnosis_of([Joint(name) for name in UR_JOINTS], 6000, Skeleton(UR_POINTS, UR_AXES))


def abstentions_only() -> Case:
    case = diagnosis_of([Joint(name) for name in UR_JOINTS[:2]], 6000)
    case.verdict["mismatch"]["found"] = case.verdict["mismatch"]["joints"][0]["significant"] = True
    case.verdict["unexplained"][0] |= {"above_noise": True, "share_of_mismatch": 1.0, "depends_on": ["q_0"]}
    for name in ("coulomb_friction", "asymmetric_friction"):
        case.verdict["abstentions"].append(
            {"effect": name, "joint": "shoulder_pan", "reason": "the joint moves in one direction only",
             "record_next": "the same motion forth and back"}
        )  # fmt: skip
    return case


def verdict_alone() -> Case:
    """A verdict without any of the arrays."""
    return Case(six_joints().verdict, ReportData())


CASES: dict[str, Callable[[], Case]] = {
    "six_joints": six_joints,
    "layered": layered,
    "slide": slide,
    "eight_long_names": eight_long_names,
    "no_mismatch": no_mismatch,
    "abstentions_only": abstentions_only,
    "verdict_alone": verdict_alone,
}


@pytest.fixture(scope="session", params=CASES, ids=list(CASES))
def case(request: pytest.FixtureRequest) -> Case:
    """Every kind of diagnosis in turn."""
    return CASES[request.param]()


@pytest.fixture(scope="session")
def six() -> Case:
    """An arm of six joints with friction on four of them, a tie, an abstention and a remainder."""
    return six_joints()


@pytest.fixture(scope="session")
def all_layers() -> Case:
    """The same arm with something in every layer of the correction."""
    return layered()


@pytest.fixture(scope="session")
def one_slide() -> Case:
    """A single prismatic joint with friction."""
    return slide()
