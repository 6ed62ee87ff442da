"""Friction that a file declares is read as it stands there, from URDF and MJCF."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from lagnet.rigid_body.declared_friction import declared_friction
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import load_description

ARM = random_arm(2, seed=3, kinds=("revolute",), fixed=False)


def test_urdf(tmp_path: Path) -> None:
    path = ARM.write_urdf(tmp_path / "arm.urdf") or tmp_path / "arm.urdf"
    text = (tmp_path / "arm.urdf").read_text(encoding="utf-8")
    first, second, rest = text.partition("</joint>")
    (tmp_path / "arm.urdf").write_text(first + '<dynamics damping="0.7" friction="0.2"/>' + second + rest)
    robot = load_description(path)
    np.testing.assert_array_equal(declared_friction(robot), [[0.7, 0.2], [0.0, 0.0]])


def test_mjcf_with_defaults(tmp_path: Path) -> None:
    path = tmp_path / "arm.xml"
    ARM.write_mjcf(path)
    text = path.read_text(encoding="utf-8").replace("<joint ", '<joint damping="0.4" ', 1)
    default = '<default><joint damping="0.1" frictionloss="0.05"/></default><worldbody>'
    path.write_text(text.replace("<worldbody>", default, 1), encoding="utf-8")
    np.testing.assert_allclose(declared_friction(load_description(path)), [[0.4, 0.05], [0.1, 0.05]])


def test_none_is_zero() -> None:
    np.testing.assert_array_equal(declared_friction(load_description("ur5")), np.zeros((6, 2)))
