"""A tie is broken by recording the motion that the diagnosis suggests; what no motion can break is said to be so."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pybullet")

from lagnet.diagnosis.diagnose import diagnose
from lagnet.experiment_design.suggest_motion import SearchSettings, suggest_motion
from lagnet.experiment_design.writing import words_of, write_suggestion
from lagnet.recordings.loading.load import load_recording
from lagnet.rigid_body.robot import load_description
from lagnet.simulation.follow import follow
from lagnet.simulation.injection import inject
from lagnet.simulation.simulate import SimulationSettings

pytestmark = pytest.mark.slow
RATE = 100.0  # [Hz]
SECONDS = 20.0
QUICK = SearchSettings(draws=40, kept=1, steps=40)
SENSORS = SimulationSettings()
HANDY = {
    "ur5": np.array([0.0, -1.2, 1.0, -1.2, -1.5, 0.0]),
    "panda": np.array([0.0, -0.3, 0.0, -1.8, 0.0, 1.6, 0.5]),
}
SUMS = (1, 2, 3, 5)  # of 0.1 Hz


@dataclass(frozen=True)
class Case:
    """A plant, and a first motion that cannot tell its physics from another."""

    robot: str
    joint: int
    effect: str
    values: dict[str, float]
    sizes: tuple[float, ...]  # [rad] of each joint's first motion
    tied: str


CASES = {
    "load that hardly varies": Case(
        "ur5", 2, "load_dependent_friction", {"K": 0.15}, (0, 0, 0.12, 0.1, 0.1, 0.2), "load_dependent_friction"
    ),
    "load that hardly varies, dry friction": Case(
        "ur5", 2, "coulomb_friction", {"Fc": 2.0}, (0, 0, 0.12, 0.1, 0.1, 0.2), "load_dependent_friction"
    ),
    "torque that hardly varies": Case("panda", 3, "torque_gain", {"g": 1.12}, (0.1,) * 7, "torque_offset"),
    "last joint alone": Case("panda", 6, "rotor_inertia", {"Ia": 0.01}, (0,) * 6 + (0.6,), "link_inertia"),
}


def first_motion(case: Case) -> tuple[np.ndarray, np.ndarray]:
    """Sums of sines about a handy pose, from rest to rest."""
    rng = np.random.default_rng(0)
    time = np.arange(round(SECONDS * RATE)) / RATE
    ramp = np.clip(np.minimum(time, time[-1] - time), 0.0, 1.0)
    q = np.tile(HANDY[case.robot], (time.size, 1))
    for joint, size in enumerate(case.sizes):
        wave = sum(
            rng.normal() * np.sin(0.2 * np.pi * k * time + rng.uniform(0.0, 2.0 * np.pi)) / k for k in SUMS
        ) * np.ones(time.size)
        q[:, joint] += size * ramp**3 * (10 - 15 * ramp + 6 * ramp**2) * wave / np.abs(wave).max()
    return time, q


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_recording_the_suggested_motion_breaks_the_tie(name: str) -> None:
    case = CASES[name]
    robot = load_description(case.robot)
    effects = [inject(robot, case.effect, robot.joints[case.joint], case.values)]
    first = follow(robot, effects, *first_motion(case), SENSORS)
    before = diagnose([first], robot)
    at_joint = {n for e in before.effects if e.joint == robot.joints[case.joint] for n in (e.effect, *e.tied_with)}
    assert {case.effect, case.tied} <= at_joint
    assert any(e.tied_with for e in before.effects)

    suggested = suggest_motion(before, seed=1, settings=QUICK)
    assert suggested is not None
    assert all(s.breaks for s in suggested.expectation.separations)
    motion = suggested.recording
    second = follow(robot, effects, motion.time, motion.q, replace(SENSORS, seed=1))
    after = diagnose([first, second], robot)
    assert [(e.effect, e.joint, e.tied_with) for e in after.effects] == [
        (case.effect, robot.joints[case.joint], ()),
    ]
    assert len(after.verdict.abstentions) < max(1, len(before.verdict.abstentions))


@pytest.mark.slow
def test_laws_that_are_equal_in_motion_are_said_to_be_so(tmp_path: Path) -> None:
    robot = load_description("ur5")
    uneven = inject(robot, "asymmetric_friction", robot.joints[2], {"Fc_plus": 3.0, "Fc_minus": 1.5})
    case = Case("ur5", 2, "asymmetric_friction", {}, (0.5,) * 6, "")
    before = diagnose([follow(robot, [uneven], *first_motion(case), SENSORS)], robot)
    suggested = suggest_motion(before, settings=QUICK)
    assert suggested is not None
    pairs = [{frozenset(t.instead_of), frozenset(t.rivals)} for t in suggested.unbreakable]
    equal = {frozenset({"asymmetric_friction"}), frozenset({"coulomb_friction", "torque_offset"})}
    assert equal in pairs
    assert all({frozenset(t.instead_of), frozenset(t.rivals)} != equal for t in suggested.ties)
    assert any("no motion tells the two apart" in e.explanation for e in before.effects)
    assert any("no motion tells the two apart" in line for line in words_of(suggested, "there.csv"))
    write_suggestion(suggested, tmp_path)
    if suggested.is_of_use:
        told = json.loads((tmp_path / "suggested_motion.json").read_text())
        assert [t["expected_to_break"] for t in told["ties"]][-1] is False


def test_the_suggested_motion_is_a_recording_within_the_limits_of_the_arm(tmp_path: Path) -> None:
    case = CASES["torque that hardly varies"]
    robot = load_description(case.robot)
    effects = [inject(robot, case.effect, robot.joints[case.joint], case.values)]
    before = diagnose([follow(robot, effects, *first_motion(case), SENSORS)], robot)
    suggested, again = (suggest_motion(before, seed=2, settings=replace(QUICK, draws=6, steps=4)) for _ in range(2))
    assert suggested is not None
    assert again is not None
    np.testing.assert_array_equal(suggested.recording.q, again.recording.q)
    motion, expected = write_suggestion(suggested, tmp_path)
    read = load_recording(motion, robot=robot)
    np.testing.assert_array_equal(read.q, suggested.recording.q)
    assert read.v is not None
    assert np.all(read.q >= robot.position_lower)
    assert np.all(read.q <= robot.position_upper)
    assert np.all(np.abs(read.v) <= robot.velocity_limit)
    assert np.all(np.abs(read.tau) <= robot.effort_limit)
    np.testing.assert_allclose(read.v[[0, -1]], 0.0, atol=1e-2 * np.abs(read.v).max())
    told = json.loads(expected.read_text())
    assert told["schema"] == "lagnet-suggested-motion/1"
    assert told["collisions_checked"] is False
    assert [j["joint"] for j in told["joints"]] == list(robot.joints)
    assert {"expected_standard_errors", "expected_to_break", "recording"} <= set(told["ties"][0])
    assert write_suggestion(None, tmp_path) == ()
    assert not motion.exists()
    assert not expected.exists()


@pytest.mark.slow
def test_where_nothing_is_open_nothing_is_suggested() -> None:
    robot = load_description("ur5")
    case = Case("ur5", 0, "", {}, (1.5,) * 6, "")
    moved = [follow(robot, (), *first_motion(replace(case, sizes=s)), SENSORS) for s in ((1.4,) * 6, (0.9,) * 6)]
    result = diagnose(moved, robot)
    assert result.verdict.abstentions == ()
    assert suggest_motion(result, settings=QUICK) is None
    assert "none is suggested" in words_of(None, "there.csv")[0]
