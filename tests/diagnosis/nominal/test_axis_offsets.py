"""An axis that the torque of the bare arm leaves open is found from the load on the real arm."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.nominal.axis_offsets import settle_axis_offsets
from lagnet.models.serial_chain.model import SerialChain, learn_serial_chain
from lagnet.models.serial_chain.open_shape import OpenShape
from lagnet.rigid_body.descriptions.urdf import read_urdf
from lagnet.rigid_body.descriptions.xml_files import checked_xml
from lagnet.rigid_body.robot import Robot

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("axis offsets")]  # what they share is made once

APART = 0.08  # the axes of elbow and wrist [m]
MISSED = np.full(3, 1e-4)  # [N m]
SAME = 1e-5  # of the torque
BALANCED = """<robot name="balanced">
<link name="base"/>
<link name="a"><inertial><origin xyz="0.1 0.02 0.05" rpy="0.3 0.1 0"/><mass value="3"/>
 <inertia ixx="0.02" iyy="0.03" izz="0.025" ixy="0.001" ixz="0.002" iyz="-0.001"/></inertial></link>
<link name="b"><inertial><origin xyz="0.05 -0.03 0.1"/><mass value="2"/>
 <inertia ixx="0.01" iyy="0.012" izz="0.009" ixy="0" ixz="0.001" iyz="0"/></inertial></link>
<link name="c"><inertial><origin xyz="0 0 0.05"/><mass value="0.8"/>
 <inertia ixx="0.003" iyy="0.003" izz="0.002" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="pan" type="continuous"><parent link="base"/><child link="a"/><origin xyz="0 0 0.3" rpy="0.4 0.2 0"/>
 <axis xyz="0 0 1"/><limit effort="100" velocity="5"/></joint>
<joint name="elbow" type="continuous"><parent link="a"/><child link="b"/><origin xyz="0.3 0 0.1" rpy="1.2 0 0"/>
 <axis xyz="0 0 1"/><limit effort="100" velocity="5"/></joint>
<joint name="wrist" type="continuous"><parent link="b"/><child link="c"/><origin xyz="0.08 0.12 0" rpy="0.9 0 0"/>
 <axis xyz="0 0 1"/><limit effort="100" velocity="5"/></joint>
</robot>"""


@pytest.fixture(scope="module")
def balanced() -> Robot:
    return Robot(read_urdf(checked_xml(BALANCED.encode(), "balanced")))


@pytest.fixture(scope="module")
def learned(balanced: Robot) -> SerialChain:
    q, v, a = _states(balanced)
    tau = balanced.inverse_dynamics(q, v, a)
    return learn_serial_chain(q, v, a, tau, balanced.joints, balanced.joint_types, seed=0)[0]


@pytest.fixture(scope="module")
def misplaced(learned: SerialChain) -> SerialChain:
    """The same torque with the wrist's axis centimetres off, as an unlucky search might leave it."""
    shape = OpenShape(learned, MISSED)
    moved = (shape.moved(np.full(shape.sureness.size, by)) for by in (0.15, -0.15))  # the search left it on either side
    return max(moved, key=lambda chain: abs(_apart(chain) - APART))


def _states(robot: Robot, n: int = 300) -> tuple[np.ndarray, ...]:
    rng = np.random.default_rng(5)
    return rng.uniform(-np.pi, np.pi, (n, robot.n_dof)), *rng.normal(size=(2, n, robot.n_dof))


def _loaded(balanced: Robot) -> Robot:
    return balanced.with_payload(0.7, np.array([0.06, 0.01, 0.1]), 0.002 * np.eye(3))


def _apart(chain: SerialChain) -> float:
    """Distance between the axes of elbow and wrist [m]: along the common normal, whatever the choice of frames."""
    geometry = chain.dynamics.lagrangian.geometry
    turn = float(geometry.angles[1, 0])
    return abs(float(np.asarray(geometry.offsets)[1] @ [np.cos(turn), np.sin(turn)]))


@pytest.mark.slow
def test_an_axis_moved_along_an_open_direction_leaves_the_torque_of_the_bare_arm(
    balanced: Robot, misplaced: SerialChain
) -> None:
    assert abs(_apart(misplaced) - APART) > 0.02
    states = _states(balanced)
    torque = balanced.inverse_dynamics(*states)
    error = misplaced.inverse_dynamics(*states) - torque
    assert np.all(np.std(error, axis=0) < SAME * np.std(torque, axis=0))


def test_a_load_shows_where_the_axis_is(plant, balanced: Robot, misplaced: SerialChain) -> None:
    loaded = plant(robot=_loaded(balanced))
    settled = settle_axis_offsets(misplaced, [loaded.record(1)], [loaded.record(2)], MISSED, 0)
    assert _apart(settled) == pytest.approx(APART, abs=0.005)
    states = _states(balanced)
    torque = balanced.inverse_dynamics(*states)
    assert np.all(np.std(settled.inverse_dynamics(*states) - torque, axis=0) < 100 * SAME * np.std(torque, axis=0))


def test_a_load_on_a_learned_arm_is_told_as_payload_alone(
    plant, at, names, balanced: Robot, misplaced: SerialChain
) -> None:
    loaded = plant(at(1, lambda q, v, a, t: 0.5 * v), robot=_loaded(balanced))
    found = diagnose([loaded.record(1), loaded.record(2)], misplaced, [loaded.record(3)], nominal_error=MISSED)
    assert names(found) == {("payload", None), ("viscous_friction", "elbow")}
    (load,) = (e for e in found.effects if e.effect == "payload")
    assert load.value("m") == pytest.approx(0.7, rel=0.05)


def test_without_a_load_the_arm_stays_as_it_is(plant, at, balanced: Robot, misplaced: SerialChain) -> None:
    bare = plant(at(1, lambda q, v, a, t: 0.5 * v), robot=balanced)
    assert settle_axis_offsets(misplaced, [bare.record(1)], [bare.record(2)], MISSED, 0) is misplaced


def test_a_robot_from_a_file_has_no_open_axes(plant, balanced: Robot) -> None:
    loaded = plant(robot=_loaded(balanced))
    assert settle_axis_offsets(balanced, [loaded.record(1)], [loaded.record(2)], None, 0) is balanced
