"""Parameter sets against recordings: the right one wins where they can tell, and is not claimed where they cannot."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from lagnet.comparison.compare import Comparison, compare
from lagnet.comparison.writing import lines, short_names, to_json, write_comparison
from lagnet.errors import LagnetError
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import Robot, load_description

ARM = random_arm(3, seed=5, kinds=("revolute",), fixed=False)
RATE = 100.0


def heavier(robot: Robot, joint: int, share: float) -> Robot:
    parameters = robot.inertial_parameters().copy()
    parameters[joint] *= 1.0 + share
    return robot.with_inertial_parameters(parameters)


def recorded(
    robot: Robot, seconds: float = 40.0, moving: tuple[float, ...] = (1.0, 1.0, 1.0), seed: int = 0
) -> Recording:
    """Sines with friction and noise; joints whose factor is 0 stand still."""
    rng = np.random.default_rng(seed)
    time = np.arange(round(seconds * RATE)) / RATE
    omega = np.array([[1.1, 2.3], [1.7, 2.9], [2.1, 3.7]])
    size, factor = np.array([[0.5, 0.2], [0.4, 0.2], [0.5, 0.15]]), np.array(moving)
    phase = omega * time[:, None, None]
    q = (size * np.sin(phase)).sum(axis=2) * factor
    v = (size * omega * np.cos(phase)).sum(axis=2) * factor
    a = -(size * omega**2 * np.sin(phase)).sum(axis=2) * factor
    tau = robot.inverse_dynamics(q, v, a) + 0.5 * v + 0.3 * np.tanh(v / 1e-3)
    noisy = tau + 0.02 * rng.standard_normal(tau.shape)
    return Recording(time, q + 1e-6 * rng.standard_normal(q.shape), noisy, robot.joints)


@pytest.fixture(scope="module")
def result() -> Comparison:
    return compare([heavier(ARM, 2, 0.3), ARM], ["heavy", "right"], [recorded(ARM)])


def test_the_right_set_wins_on_every_joint_that_feels_the_difference(result: Comparison) -> None:
    for joint in result.joints:
        assert result.names[joint.best] == "right"
        assert joint.also == ()
        assert joint.interval[1, 0] <= joint.nmse[1] <= joint.interval[1, 1]
        assert joint.against_best[0, 0] > 0.0


def test_base_parameters_say_where_the_sets_stand(result: Comparison) -> None:
    found = result.parameters
    assert found is not None
    assert found.resolved.size >= 3
    off = np.abs(found.estimate - found.values[1])[found.resolved] / found.error[found.resolved]
    assert np.mean(off < 2.5) >= 0.7
    wrong = np.abs(found.estimate - found.values[0])[found.resolved] / found.error[found.resolved]
    assert np.max(wrong) > 5.0


def test_equal_sets_are_not_told_apart() -> None:
    same = compare([ARM, ARM.with_inertial_parameters(ARM.inertial_parameters())], ["a", "b"], [recorded(ARM, 10.0)])
    assert all(len(joint.also) == 1 for joint in same.joints)
    assert same.parameters is not None
    assert same.parameters.differing.size == 0
    assert same.to_record == ()


def test_what_a_standing_joint_hides_stays_open_and_gets_advice() -> None:
    hidden = compare([heavier(ARM, 0, 0.3), ARM], ["heavy", "right"], [recorded(ARM, 20.0, (0.0, 1.0, 1.0))])
    found = hidden.parameters
    assert found is not None
    assert found.open.size > 0
    assert any(entry.is_enough for entry in hidden.to_record)
    best = hidden.to_record[0]
    still = np.zeros((1, 3))
    pose = np.array([best.pose])
    a = 5.0 * np.eye(3)[[ARM.joints.index(best.joint)]] if best.motion == "swing" else still
    torque = [m.inverse_dynamics(pose, still, a) for m in (ARM, heavier(ARM, 0, 0.3))]
    assert np.max(np.abs(torque[0] - torque[1])) > best.noise


def test_the_file_is_plain_data(result: Comparison, tmp_path: Path) -> None:
    text = json.loads(write_comparison(result, tmp_path).read_text(encoding="utf-8"))
    assert text == json.loads(json.dumps(to_json(result)))
    assert text["joints"][0]["best"] == "right"
    assert all(entry["resolved"] in (True, False) for entry in text["parameters"])


def test_one_model_or_other_joints_are_refused() -> None:
    recording = recorded(ARM, 5.0)
    with pytest.raises(LagnetError, match="nothing to compare"):
        compare([ARM], ["a"], [recording])
    with pytest.raises(LagnetError, match="given twice"):
        compare([ARM, ARM], ["a", "a"], [recording])
    with pytest.raises(LagnetError, match="other joints"):
        compare([ARM, random_arm(2, seed=1)], ["a", "b"], [recording])


def test_other_kinematics_are_compared_by_torque_alone() -> None:
    tilted = ARM.with_gravity(np.array([1.0, 0.0, -9.6]))
    result = compare([ARM, tilted], ["level", "tilted"], [recorded(ARM, 10.0)])
    assert result.parameters is None
    assert "kinematics, gravity" in result.reason
    assert {result.names[j.best] for j in result.joints} == {"level"}


def with_friction(path: Path, viscous: float, dry: float, rotor: float = 0.0) -> Robot:
    """The arm as MJCF with one declared friction and rotor at every joint."""
    ARM.write_mjcf(path)
    text = path.read_text(encoding="utf-8")
    declared = f'<joint damping="{viscous}" frictionloss="{dry}" armature="{rotor}" '
    path.write_text(text.replace("<joint ", declared), encoding="utf-8")
    return load_description(path)


@pytest.fixture(scope="module")
def published(tmp_path_factory: pytest.TempPathFactory) -> Comparison:
    """Two files with the same bodies whose friction disagrees by a factor of fifty; that of the first is true."""
    folder = tmp_path_factory.mktemp("published")
    sets = [with_friction(folder / "near.xml", 0.5, 0.3), with_friction(folder / "far.xml", 25.0, 0.006, 0.4)]
    return compare(sets, ["near", "far"], [recorded(ARM)])


def test_friction_that_the_files_declare_is_compared(published: Comparison) -> None:
    assert published.as_published is not None
    for joint in published.as_published:
        assert published.names[joint.best] == "near"
        assert joint.also == ()
        assert joint.nmse[0] < 0.05 < 1.0 < joint.nmse[1]


def test_the_recordings_say_what_friction_and_rotor_are(published: Comparison) -> None:
    assert published.differences is not None
    said = {d.parameter: d for d in published.differences}
    truth = {"viscous friction": 0.5, "dry friction": 0.3, "rotor inertia": 0.0}
    for joint in ARM.joints:
        for kind, value in truth.items():
            entry = said.get(f"{kind}({joint})")
            if entry is None:  # a rotor on the first, upright joint is told with the bodies
                assert kind == "rotor inertia"
                continue
            assert entry.resolved
            assert entry.nearest == 0
            assert abs(entry.estimate - value) < max(4.0 * entry.error, 0.02)


def test_the_terminal_says_which_set_the_recordings_agree_with(published: Comparison) -> None:
    said = "\n".join(lines(published))
    assert "as published, with the friction that each set declares instead" in said
    assert f"best as published: near on {', '.join(ARM.joints)}" in said
    line = next(line for line in said.splitlines() if line.startswith(f"  viscous friction({ARM.joints[1]})"))
    assert "near 0.5, far 25 N m s/rad" in line
    assert line.endswith(": near")


def test_sets_that_a_standing_joint_cannot_tell_are_not_told() -> None:
    sets = [heavier(ARM, 0, 0.3), ARM]
    said = list(lines(compare(sets, ["heavy", "right"], [recorded(ARM, 20.0, (0.0, 1.0, 1.0))])))
    assert any(line.startswith("to record: ") for line in said)
    assert any("best: " in line and "alike on" in line for line in said)


def test_names_are_as_short_as_they_stay_apart() -> None:
    assert short_names(["x/a/arm.urdf", "x/b/arm.urdf"]) == ("a/arm.urdf", "b/arm.urdf")
    assert short_names(["x/a.urdf", "ur5"]) == ("a.urdf", "ur5")
