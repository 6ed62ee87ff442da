"""One set fitted to each recording: friction and the share of a tool come back, with intervals that hold the truth."""

from __future__ import annotations

import numpy as np
import pytest
from tests.tracking.fleets import DRY, VISCOUS, record, write_arm

import lagnet
from lagnet.models.corrected.model import NamedEffect
from lagnet.tracking.fixed_fit import SHARE, fit_set
from lagnet.tracking.tracked_set import (
    TrackedSet,
    beyond,
    common_set,
    effect_from_plain,
    new_physics,
    set_from_plain,
)

FRICTION = tuple(
    NamedEffect(effect, joint, {name: 1.0})
    for joint in range(2)
    for effect, name in (("viscous_friction", "Fv"), ("coulomb_friction", "Fc"))
)
TOOL = NamedEffect(
    "payload",
    None,
    {
        "m": 0.4,
        "cx": 0.3,
        "cy": 0.0,
        "cz": 0.0,
        "Ixx": 1e-4,
        "Ixy": 0.0,
        "Iyy": 1e-4,
        "Ixz": 0.0,
        "Iyz": 0.0,
        "Izz": 1e-4,
    },
)
SET = TrackedSet(FRICTION, (), (0.01, 0.01), None, None, 10.0, left=(0.02, 0.02))
WIDE = 2.0  # of a 95 % interval: holds the truth with more than 99.99 %


@pytest.fixture(scope="module")
def arm(tmp_path_factory):
    return write_arm(tmp_path_factory.mktemp("arm"))


def test_friction_and_share_of_a_tool_come_back(arm):
    tracked = SET.with_new([TOOL])
    for tool, share in ((0.4, 1.0), (0.0, 0.0), (0.2, 0.5)):
        fit = fit_set(record(arm, 3, friction=1.3, tool=tool), lagnet.load_robot(str(arm)), tracked)
        rows = {(r.effect, r.joint, r.parameter): r for r in fit.rows}
        truth = {("payload", None, SHARE): share}
        for j, joint in enumerate(("shoulder", "elbow")):
            truth |= {
                ("viscous_friction", joint, "Fv"): 1.3 * VISCOUS[j],
                ("coulomb_friction", joint, "Fc"): 1.3 * DRY[j],
            }
        assert set(rows) == set(truth)
        for key, value in truth.items():
            row = rows[key]
            assert abs(row.value - value) < WIDE * (row.upper - row.lower) / 2 + 0.004 * abs(value) + 1e-3
        assert not tracked.is_unusual(fit.left)


def test_a_share_may_be_negative(arm):
    robot = lagnet.load_robot(str(arm))
    bodies = robot.inertial_parameters().copy()
    bodies[-1] += 0.2 * np.array([1.0, 0.3, 0, 0, 0, 0, 0.09, 0, 0, 0.09])
    fit = fit_set(record(arm, 4), robot.with_inertial_parameters(bodies), SET.with_new([TOOL]))
    assert fit.rows[-1].value == pytest.approx(-0.5, abs=0.02)


def test_what_the_set_does_not_hold_is_unusual(arm):
    fit = fit_set(record(arm, 3, tool=0.4), lagnet.load_robot(str(arm)), SET)
    assert SET.is_unusual(fit.left)


def test_load_is_that_of_the_bodies(arm):
    robot, tracked = lagnet.load_robot(str(arm)), SET.with_new([TOOL])
    with_tool, without = (fit_set(record(arm, 5, tool=t), robot, tracked).load for t in (0.4, 0.0))
    assert np.all(with_tool > without)


def test_a_set_survives_json():
    import json

    tracked = SET.with_new([TOOL])
    assert set_from_plain(json.loads(json.dumps(tracked.plain()))) == tracked


def test_a_coupled_motor_of_an_older_track_keeps_its_ratio() -> None:
    values = {"Fv": 1.0, "Fc": 0.5, "Ia": 0.1}
    held = {"effect": "coupled_transmission", "joint": 1, "values": values | {"sense": -1.0}}
    assert effect_from_plain(held).values == values | {"ratio": -1.0}


def test_names_of_what_is_followed_already_are_not_new():
    stribeck = NamedEffect("stribeck_friction", 0, {"Fc": 1.0, "Fs": 0.2, "vs": 0.1})
    gain = NamedEffect("torque_gain", 0, {"g": 1.1})
    assert beyond(SET, [stribeck, gain, TOOL, FRICTION[0]]) == (gain, TOOL)


def test_new_physics_must_be_named_again_or_at_last():
    gain, offset = NamedEffect("torque_gain", 1, {"g": 1.1}), NamedEffect("torque_offset", 1, {"b": 0.3})
    assert new_physics(SET, [[], [gain], [], []]) == ()
    assert new_physics(SET, [[], [], [], [gain]]) == (gain,)
    assert new_physics(SET, [[], [gain], [offset], [gain], [gain], [gain]]) == (gain,)
    assert new_physics(SET, []) == ()


def test_a_make_follows_what_half_of_its_robots_show():
    lone = SET.with_new([NamedEffect("torque_gain", 1, {"g": 1.1})])
    assert {e.effect for e in common_set([SET, SET, lone]).effects} == {"viscous_friction", "coulomb_friction"}
    assert common_set([SET, SET, lone]).slow == SET.slow
