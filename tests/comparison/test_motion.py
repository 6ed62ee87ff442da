"""Sets of bodies and servos against recorded motion: the right one wins, and what motion cannot show stays open."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from lagnet.cli.main import BAD_INPUT, DONE, main
from lagnet.comparison.motion import MotionComparison, compare_motion, servo_driven
from lagnet.comparison.writing import lines, to_json
from lagnet.errors import LagnetError
from lagnet.models.corrected.servo_driven import ServoDrivenModel
from lagnet.recordings.recording import Recording
from lagnet.recordings.writing import write_recording
from lagnet.rigid_body.random_arm import random_arm
from lagnet.servos.parameters import law_vector

pytestmark = pytest.mark.xdist_group("comparison of motion")  # what they share is made once

ARM = random_arm(2, seed=3, kinds=("revolute",), fixed=False)
TRUE = {"kp": 18.0, "kd": 0.5, "viscous": 0.6, "coulomb": 0.05, "rotor": 0.03}


def driven(**changed: float) -> ServoDrivenModel:
    return ServoDrivenModel(ARM, np.tile(law_vector(**TRUE | changed), (2, 1)), (True, True))


def recorded(seconds: float = 40.0, moving: tuple[float, float] = (1.0, 1.0)) -> Recording:
    """Sines and steps commanded to the true arm; positions with the noise of an encoder."""
    time = np.arange(round(seconds * 50)) / 50
    wave = 0.3 * np.sin(np.outer(time, [1.3, 2.1])) + 0.2 * np.sign(np.sin(np.outer(time, [1.9, 1.1])))
    command = wave * np.array(moving)
    q = driven().rollout(command, time, command[0])
    step = 2 * np.pi / 4096
    return Recording(time, np.round(q / step) * step, None, ARM.joints, command=command)


@pytest.fixture(scope="module")
def result() -> MotionComparison:
    return compare_motion(
        [driven(kp=900.0), driven(), driven(viscous=0.012)], ["stiff", "right", "slick"], [recorded()]
    )


def test_the_right_servos_win_on_every_joint(result: MotionComparison) -> None:
    for joint in result.joints:
        assert result.names[joint.best] == "right"
        assert joint.also == ()


def test_the_recordings_agree_with_the_right_values(result: MotionComparison) -> None:
    told = {d.parameter: d for d in result.differences}
    for joint in ARM.joints:
        for name in ("kp", "viscous"):
            entry = told[f"{name}({joint})"]
            if not entry.resolved:
                continue
            assert entry.nearest is not None
            assert entry.values[entry.nearest] == TRUE[name]
    assert sum(d.resolved for d in result.differences) >= 2


def test_the_file_and_the_terminal_name_the_route(result: MotionComparison) -> None:
    text = json.loads(json.dumps(to_json(result), allow_nan=False))
    assert text["route"] == "motion"
    assert text["joints"][0]["best"] == "right"
    assert any(line.startswith("best: right on") for line in lines(result))


def test_a_joint_that_stands_still_is_not_compared_and_what_it_hides_is_not_told() -> None:
    sets = [driven(kp=900.0), driven()]
    found = compare_motion(sets, ["stiff", "right"], [recorded(moving=(1.0, 0.0))])
    names = {joint.joint for joint in found.joints}
    assert set(found.still) == set(ARM.joints) - names
    assert all(d.parameter.endswith(f"({n})") for d in found.differences for n in names if n in d.parameter)


def test_values_that_no_recording_tells_get_a_command_that_would() -> None:
    slow = recorded(40.0)
    sets = [driven(rotor=0.03), driven(rotor=0.0301)]
    found = compare_motion(sets, ["a", "b"], [slow])
    assert not any(d.resolved for d in found.differences)
    assert len(found.to_record) == len(found.differences) > 0
    assert not any(entry.is_enough for entry in found.to_record)


def test_recordings_at_another_gain_are_compared_at_it() -> None:
    twice = ServoDrivenModel(ARM, np.tile(law_vector(**TRUE | {"kp": 36.0, "kd": 1.0}), (2, 1)), (True, True))
    time = np.arange(1500) / 50
    command = 0.4 * np.sin(np.outer(time, [1.3, 2.1]))
    again = Recording(time, twice.rollout(command, time, command[0]), None, ARM.joints, command=command)
    sets = [driven(kp=36.0, kd=1.0), driven()]
    told = compare_motion(sets, ["stiff", "right"], [again, recorded(30.0)], gains=[2.0, 1.0])
    assert {joint.best for joint in told.joints} == {1}
    assert {j.best for j in compare_motion(sets, ["stiff", "right"], [again]).joints} == {0}


@pytest.mark.parametrize("gains", [[1.0], [1.0, 0.0], [1.0, -2.0], [1.0, float("inf")]])
def test_gains_that_are_not_one_positive_number_a_recording_are_refused(gains: list[float]) -> None:
    with pytest.raises(LagnetError, match="2 positive numbers"):
        compare_motion([driven(), driven(kp=9.0)], ["a", "b"], [recorded(5.0)] * 2, gains=gains)


def test_a_set_without_gains_is_refused() -> None:
    with pytest.raises(LagnetError, match="gives no position gain"):
        servo_driven(ARM, "arm.urdf")


def test_the_command_pairs_robots_and_servos(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_recording(recorded(), tmp_path / "run.csv")
    ARM.write_urdf(tmp_path / "arm.urdf")
    for name, kp in (("soft", 18.0), ("stiff", 900.0)):
        values = "".join(f"{k} = {v}\n" for k, v in (TRUE | {"kp": kp}).items())
        (tmp_path / f"{name}.toml").write_text(f"[all]\n{values}", encoding="utf-8")
    words = ["compare", str(tmp_path / "run.csv"), "--robot", str(tmp_path / "arm.urdf"), "--out", str(tmp_path)]
    files = [w for n in ("soft", "stiff") for w in ("--actuator", str(tmp_path / f"{n}.toml"))]
    assert main(words + files) == DONE
    assert f"best: soft.toml on {', '.join(ARM.joints)}" in capsys.readouterr().out
    assert main(words + ["--robot", "ur5"] * 2 + files) == BAD_INPUT
    assert main([*words, *files, "--gains", "1,2"]) == BAD_INPUT
    assert "the gains 1, 2 do not fit" in capsys.readouterr().err
    assert main(words) == BAD_INPUT
    assert "gives no position gain" in capsys.readouterr().err
