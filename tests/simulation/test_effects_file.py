"""A file of effects is held against the catalogue and the robot, and each mistake is named with what would be valid."""

from __future__ import annotations

from pathlib import Path

import pytest

from lagnet.errors import EffectError
from lagnet.rigid_body.robot import Robot
from lagnet.simulation.effects_file import read_effects

GOOD = """
[[effect]]
name = "viscous_friction"
joint = "elbow_joint"
Fv = 2

[[effect]]
name = "gravity_tilt"
theta_1 = 0.02
theta_2 = -0.01
"""
COUPLED = '[[effect]]\nname = "coupled_transmission"\njoint = "elbow_joint"\nFv = 2\nFc = 1\nIa = 0\n'
VISCOUS = '[[effect]]\nname = "viscous_friction"\n'
PER_LOAD = '[[effect]]\nname = "load_dependent_friction"\njoint = "elbow_joint"\nK = 0.1\n'


def test_a_good_file_is_read(ur5: Robot, tmp_path: Path) -> None:
    path = tmp_path / "effects.toml"
    path.write_text(GOOD)
    viscous, tilt = read_effects(path, ur5)
    assert (viscous.effect.name, viscous.joint, viscous.values) == ("viscous_friction", 2, {"Fv": 2.0})
    assert (tilt.effect.name, tilt.joint, tilt.values) == ("gravity_tilt", None, {"theta_1": 0.02, "theta_2": -0.01})


def test_a_file_of_an_older_version_is_read(ur5: Robot, tmp_path: Path) -> None:
    path = tmp_path / "effects.toml"
    path.write_text(COUPLED + "sense = -1\n")
    (coupled,) = read_effects(path, ur5)
    assert coupled.values == {"Fv": 2.0, "Fc": 1.0, "Ia": 0.0, "ratio": -1.0}
    path.write_text(COUPLED + "sense = -1\nratio = -1\n")
    with pytest.raises(EffectError, match="no parameter 'sense'"):
        read_effects(path, ur5)


def test_an_empty_file_hides_nothing(ur5: Robot, tmp_path: Path) -> None:
    (tmp_path / "none.toml").write_text("# nothing\n")
    assert read_effects(tmp_path / "none.toml", ur5) == ()


def test_the_side_of_friction_per_load_is_the_link_unless_it_is_told(tmp_path, ur5) -> None:
    file = tmp_path / "effects.toml"
    for told, side in (("", 0.0), ("side = 1\n", 1.0)):
        file.write_text(PER_LOAD + told)
        (effect,) = read_effects(file, ur5)
        assert dict(effect.values) == {"K": 0.1, "side": side}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('[[effect]]\nname = "viscus_friction"\n', "effect 1.*unknown effect 'viscus_friction'.*did you mean viscous"),
        (VISCOUS + "Fv = 2\n", "needs a joint.*elbow_joint"),
        (VISCOUS + 'joint = "elbow"\nFv = 2\n', "no joint 'elbow'.*did you mean elbow_joint"),
        (VISCOUS + "joint = 2\nFv = 2\n", "the joint is 2, not a name"),
        (VISCOUS + 'joint = "elbow_joint"\n', "lacks Fv"),
        (VISCOUS + 'joint = "elbow_joint"\nFv = 2\nFc = 1\n', "no parameter 'Fc'.*Fv"),
        (VISCOUS + 'joint = "elbow_joint"\nFv = -2\n', "Fv = -2 is out of bounds"),
        (VISCOUS + 'joint = "elbow_joint"\nFv = nan\n', "out of bounds"),
        (VISCOUS + 'joint = "elbow_joint"\nFv = true\n', "Fv is True, not a number"),
        (VISCOUS + 'joint = "elbow_joint"\nFv = "big"\n', "Fv is 'big', not a number"),
        (PER_LOAD + "side = 0.5\n", "side = 0.5 chooses no form of the law.*1: of the motor"),
        ('[[effect]]\nname = "gravity_tilt"\njoint = "elbow_joint"\ntheta_1 = 0.1\ntheta_2 = 0\n', "takes no joint"),
        ("[[effect]]\nFv = 2\n", "name is missing"),
        ('effect = "viscous"\n', "not a list of tables"),
        ('[[effects]]\nname = "x"\n', "unknown table 'effects'.*effect"),
        ("[[effect]\n", "is no TOML"),
        ("x = " + "[" * 100_000, "is no TOML"),
        ("#" * 2_000_000, "too many"),
    ],
)
def test_each_mistake_is_named(ur5: Robot, tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "effects.toml"
    path.write_text(text)
    with pytest.raises(EffectError, match=message) as error:
        read_effects(path, ur5)
    assert str(path) in str(error.value)


def test_a_missing_file_is_named(ur5: Robot, tmp_path: Path) -> None:
    with pytest.raises(EffectError, match="No such file"):
        read_effects(tmp_path / "nowhere.toml", ur5)
