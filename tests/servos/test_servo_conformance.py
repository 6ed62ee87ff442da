"""What every effect of the motion route promises, and the files that describe servos."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from lagnet.errors import LagnetError
from lagnet.rigid_body.mjcf_actuators import position_actuators
from lagnet.rigid_body.robot import load_description
from lagnet.servos.catalogue import SERVO_CATALOGUE, servo_effect
from lagnet.servos.effect import Scales
from lagnet.servos.parameters import INDEX, LAW, NEUTRAL
from lagnet.servos.servo_file import read_servo_file

REFERENCES = (Path(__file__).parents[2] / "docs" / "references.md").read_text(encoding="utf-8")
SCALES = Scales(torque=1.0, speed=0.5, error=0.05, inertia=0.01, sample=0.02, kp=10.0)
OTHER_ROUTE = {"payload"}  # a rival that the whole arm shows


@pytest.mark.parametrize("name", SERVO_CATALOGUE)
def test_an_effect_sets_free_what_it_says(name):
    effect = servo_effect(name)
    assert effect.name == name
    assert effect.shown_by
    assert f'<a id="{effect.source}">' in REFERENCES
    assert len(effect.frees) == len(effect.parameters)
    assert all(free in INDEX for group in effect.frees for free in group)
    assert set(effect.confused_with) <= set(SERVO_CATALOGUE) | OTHER_ROUTE
    for start in effect.starts(SCALES):
        values = dict(zip([p.name for p in effect.parameters], start, strict=True))
        law = effect.apply(NEUTRAL, values)
        assert effect.read(law) == values
        assert not np.array_equal(law, NEUTRAL)
        assert all(p.lower <= x <= p.upper for p, x in zip(LAW, law, strict=True))


@pytest.mark.parametrize("name", SERVO_CATALOGUE)
def test_an_effect_abstains_where_nothing_moves(name):
    still = np.zeros(100)
    assert servo_effect(name).excitation(still, still, np.zeros(100, dtype=bool))


def test_an_unknown_name_says_what_there_is():
    with pytest.raises(LagnetError, match="did you mean dead_band"):
        servo_effect("deadband")


def test_a_servo_file_gives_every_joint_its_law(tmp_path):
    path = tmp_path / "servo.toml"
    path.write_text("[all]\nkp = 17.8\ndelay = 0.02\n[b]\ntorque_limit = 2.9\ndamping = 0.6\n", encoding="utf-8")
    servo = read_servo_file(path, ("a", "b"), np.array([0.1, 0.2]))
    assert servo.known == (True, True)
    assert servo.laws[1, INDEX["torque_limit"]] == 2.9
    assert servo.laws[1, INDEX["viscous"]] == 0.6
    assert list(servo.laws[:, INDEX["rotor"]]) == [0.1, 0.2]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[c]\nkp = 1", "unknown joint"),
        ("[all]\nkq = 1", "unknown parameter"),
        ("[all]\nkp = -1", "kp is -1"),
        ("[", "read"),
        ("kp = " + 5000 * "[", "read"),
    ],
)
def test_a_wrong_servo_file_gets_one_clear_line(tmp_path, text, words):
    path = tmp_path / "servo.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(LagnetError, match=words):
        read_servo_file(path, ("a", "b"), np.zeros(2))


def test_the_actuators_of_an_mjcf_are_read_with_their_classes(tmp_path):
    path = tmp_path / "arm.xml"
    path.write_text(
        '<mujoco><compiler angle="radian"/><default><default class="s"><joint damping="0.6" armature="0.03"/>'
        '<position kp="50" kv="2"/></default></default><worldbody><body childclass="s"><joint name="a" axis="0 1 0"/>'
        '<inertial pos="0.1 0 0" mass="0.4" diaginertia="1e-3 2e-3 2e-3"/></body></worldbody>'
        '<actuator><position class="s" joint="a" forcerange="-3 3"/></actuator></mujoco>',
        encoding="utf-8",
    )
    found, notes = position_actuators(load_description(path))
    assert found["a"] == {"viscous": 0.6, "coulomb": 0.0, "rotor": 0.03, "kp": 50.0, "kd": 2.0, "torque_limit": 3.0}
    assert notes == ()
