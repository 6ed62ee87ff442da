"""Files that nobody vouches for: refused in one clear line, never opened further, never in endless work."""

from __future__ import annotations

import codecs
import re
import tracemalloc

import numpy as np
import pytest

from lagnet.errors import RobotError
from lagnet.rigid_body.robot import load_description

LINK = (
    '<link name="{0}"><inertial><mass value="1"/>'
    '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>'
)
JOINT = (
    '<joint name="{0}" type="{1}"><parent link="{2}"/><child link="{3}"/><axis xyz="0 0 1"/>'
    '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
)


def turn(name, parent, child):
    return JOINT.format(name, "revolute", parent, child)


def arm(*, joint=JOINT.format("j1", "revolute", "a", "b"), link=LINK.format("b"), more=""):
    return f'<robot name="r">{LINK.format("a")}{link}{joint}{more}</robot>'


def refusal(text, tmp_path, name="arm.urdf"):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(RobotError) as caught:
        load_description(path)
    message = str(caught.value)
    assert message.startswith(str(path)), "the file is named first"
    assert "\n" not in message
    return message


BAD = {
    "empty": ("", "broken XML"),
    "not xml": ("hello", "broken XML"),
    "cut off": (arm()[:-30], "broken XML in line 1"),
    "other root": ("<html/>", "expected <robot>"),
    "xacro": ('<robot xmlns:xacro="http://ros.org/wiki/xacro"><xacro:arm/></robot>', "run xacro"),
    "substitution": (arm(link=LINK.format("b").replace('value="1"', 'value="${m}"')), "run xacro"),
    "no joint": (f'<robot name="r">{LINK.format("a")}</robot>', "no moving joint"),
    "nothing": ('<robot name="r"/>', "closed loop|no moving joint"),
    "only fixed": (arm(joint=JOINT.format("j1", "fixed", "a", "b")), "no moving joint"),
    "floating": (arm(joint=JOINT.format("j1", "floating", "a", "b")), "joint j1 is of type 'floating'"),
    "planar": (arm(joint=JOINT.format("j1", "planar", "a", "b")), "joint j1 is of type 'planar'"),
    "spherical": (arm(joint=JOINT.format("j1", "spherical", "a", "b")), "joint j1 is of type 'spherical'"),
    "no type": (arm().replace('type="revolute"', ""), "joint j1"),
    "no parent": (arm().replace('<parent link="a"/>', ""), "joint j1 has no parent"),
    "unknown child": (arm().replace('<child link="b"/>', '<child link="ghost"/>'), "ghost, which does not exist"),
    "loop of two": (arm(more=JOINT.format("j2", "revolute", "b", "a")), "closed loop"),
    "two parents": (
        arm(more=LINK.format("c") + turn("j2", "a", "c") + turn("j3", "c", "b")),
        "hangs on two joints",
    ),
    "island": (
        arm(more=LINK.format("c") + LINK.format("d") + turn("j2", "c", "d") + turn("j3", "d", "c")),
        "closed loop",
    ),
    "two bases": (arm(more=LINK.format("c")), "2 links hang on nothing"),
    "self": (arm(joint=JOINT.format("j1", "revolute", "b", "b")), "closed loop"),
    "twin links": (arm(more=LINK.format("b")), "2 links are named b"),
    "twin joints": (arm(more=LINK.format("c") + JOINT.format("j1", "revolute", "b", "c")), "2 joints are named j1"),
    "nameless": (arm().replace('name="j1"', ""), "a joint has no name"),
    "mass is text": (arm(link=LINK.format("b").replace('value="1"', 'value="heavy"')), "link b: mass value='heavy'"),
    "mass is nan": (arm(link=LINK.format("b").replace('value="1"', 'value="nan"')), "not finite"),
    "mass is infinite": (arm(link=LINK.format("b").replace('value="1"', 'value="1e999"')), "not finite"),
    "mass of a planet": (arm(link=LINK.format("b").replace('value="1"', 'value="6e24"')), "larger than any robot's"),
    "no mass": (arm(link=LINK.format("b").replace('<mass value="1"/>', "")), "link b has no <mass>"),
    "mass without value": (arm(link=LINK.format("b").replace('mass value="1"', "mass")), "mass of link b has no value"),
    "inertia is nan": (arm(link=LINK.format("b").replace('ixx="1"', 'ixx="nan"')), "link b: inertia ixx"),
    "no ixx": (arm(link=LINK.format("b").replace('ixx="1"', "")), "inertia of link b has no ixx"),
    "unbound prefix": (arm(more="<gz:plugin/>"), "broken XML in line 1, column .*: unbound prefix"),
    "two inertials": (arm(link=LINK.format("b").replace("<inertial>", "<inertial/><inertial>")), "2 inertials"),
    "axis of zero": (arm().replace('xyz="0 0 1"', 'xyz="0 0 0"'), "joint j1 has an axis of length zero"),
    "axis of two": (arm().replace('xyz="0 0 1"', 'xyz="0 1"'), "has 2 numbers, expected 3"),
    "origin is text": (arm().replace("<parent", '<origin xyz="0 0 x"/><parent'), "joint j1: origin xyz"),
    "origin is nan": (arm().replace("<parent", '<origin rpy="0 0 nan"/><parent'), "not finite"),
    "limit is text": (arm().replace('lower="-1"', 'lower="low"'), "joint j1: limit lower='low'"),
    "limits swapped": (arm().replace('lower="-1"', 'lower="2"'), "lower limit above"),
    "damping is text": (arm().replace("</joint>", '<dynamics damping="much"/></joint>'), "joint j1: dynamics damping"),
    "mimic is text": (arm().replace("</joint>", '<mimic joint="x" offset="far"/></joint>'), "joint j1: mimic offset"),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_bad_content_is_named(case, tmp_path):
    text, expected = BAD[case]
    assert re.search(expected, refusal(text, tmp_path))


LAUGHS = '<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa">' + "".join(
    f'<!ENTITY {chr(98 + i)} "{f"&{chr(97 + i)};" * 10}">' for i in range(12)
)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
@pytest.mark.parametrize(
    "head",
    [LAUGHS + "]>", '<!DOCTYPE r SYSTEM "file:///etc/passwd">', '<!DOCTYPE r [<!ENTITY x SYSTEM "/etc/passwd">]>'],
)
def test_document_types_are_refused_in_any_encoding(head, encoding, tmp_path):
    text = f'<?xml version="1.0" encoding="{encoding}"?>' + head + arm().replace('name="r"', 'name="&m;"')
    data = text.encode("utf-8") if encoding == "utf-8" else codecs.BOM_UTF16_LE + text.encode("utf-16-le")
    assert "document type" in refusal(data, tmp_path)


def test_large_and_deep_files_are_refused_in_bounded_memory(tmp_path):
    tracemalloc.start()
    assert "20 MB" in refusal(b" " * 20_000_001, tmp_path)
    assert "nested deeper" in refusal("<a>" * 100_000, tmp_path)
    assert "elements" in refusal("<robot>" + "<link/>" * 300_000, tmp_path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 100e6


def test_long_chains_are_refused(tmp_path):
    parts = "".join(
        LINK.format(f"l{i}") + JOINT.format(f"j{i}", "revolute", "a" if i == 0 else f"l{i - 1}", f"l{i}")
        for i in range(2001)
    )
    assert "2001 joints" in refusal(f'<robot name="r">{LINK.format("a")}{parts}</robot>', tmp_path)


def test_meshes_are_never_opened(tmp_path):
    mesh = '<{0}><geometry><mesh filename="file:///dev/zero"/></geometry></{0}>'
    shape = mesh.format("visual") + mesh.format("collision")
    path = tmp_path / "arm.urdf"
    path.write_text(arm(link=LINK.format("b").replace("</link>", shape + "</link>")))
    assert load_description(path).n_dof == 1


def loaded(text, tmp_path):
    path = tmp_path / "arm.urdf"
    path.write_text(text)
    return load_description(path)


def test_what_can_be_survived_is_warned_of(tmp_path):
    more = LINK.format("c") + JOINT.format("j2", "revolute", "b", "c")
    robot = loaded(arm(link='<link name="b"/>', more=more), tmp_path)
    assert any("behind joint j1 has a mass of 0" in warning for warning in robot.warnings)
    robot = loaded(arm(link=LINK.format("b").replace('value="1"', 'value="-1"')), tmp_path)
    assert any("mass of -1" in warning for warning in robot.warnings)
    no_limit = arm().replace('<limit lower="-1" upper="1" effort="1" velocity="1"/>', "")
    robot = loaded(no_limit, tmp_path)
    assert any("no limit" in warning for warning in robot.warnings)
    assert robot.position_upper[0] == np.inf
    robot = loaded(arm().replace("</joint>", '<dynamics damping="2" friction="0"/></joint>'), tmp_path)
    assert any("damping or friction declared on j1" in warning for warning in robot.warnings)


def test_mimic_joints_are_held_where_they_follow_to(tmp_path):
    finger = LINK.format("c") + JOINT.format("j2", "prismatic", "b", "c").replace(
        "</joint>", '<mimic joint="j1" multiplier="2" offset="0.25"/></joint>'
    )
    robot = loaded(arm(more=finger), tmp_path)
    assert robot.joints == ("j1",)
    assert any("j2 mimics j1: held at 0.25" in warning for warning in robot.warnings)
    still = LINK.format("c") + JOINT.format("j2", "fixed", "b", "c").replace(
        "<parent", '<origin xyz="0 0 0.25"/><parent'
    )
    expected = loaded(arm(more=still), tmp_path)
    assert np.allclose(robot.inertial_parameters(), expected.inertial_parameters(), atol=1e-12)


def test_axes_need_no_unit_length(tmp_path):
    q, v, a = np.random.default_rng(0).normal(size=(3, 5, 1))
    long = loaded(arm().replace('xyz="0 0 1"', 'xyz="0 3 4"'), tmp_path).inverse_dynamics(q, v, a)
    unit = loaded(arm().replace('xyz="0 0 1"', 'xyz="0 0.6 0.8"'), tmp_path).inverse_dynamics(q, v, a)
    assert np.allclose(long, unit, atol=1e-12)


def test_a_robot_of_two_thousand_joints_is_refused_before_its_tables_are_made(tmp_path) -> None:
    links = "".join(LINK.format(f"l{i}") for i in range(2001))
    joints = "".join(JOINT.format(f"j{i}", "revolute", f"l{i}", f"l{i + 1}") for i in range(2000))
    path = tmp_path / "chain.urdf"
    path.write_text(f'<robot name="chain">{links}{joints}</robot>')
    with pytest.raises(RobotError, match="2000 moving joints, more than 256"):
        load_description(path)
