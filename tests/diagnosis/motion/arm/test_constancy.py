"""A gain that fades through every recording is told from one that is off by its trend."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from lagnet.diagnosis.motion.arm.constancy import Trend, trends_of
from lagnet.diagnosis.motion.joint.cases import joint_case
from lagnet.diagnosis.motion.joint.joint_case import SelectionLimits
from lagnet.diagnosis.motion.problem import pose_motion_problem
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.kinematic_tree import KinematicTree, kinematic_tree
from lagnet.rigid_body.robot import load_description
from lagnet.rollout.whole_arm import roll_out_arm
from lagnet.servos.nominal import NominalServo
from lagnet.servos.parameters import KP, law_vector

ENCODER = 2.0 * np.pi / 4096.0
NOMINAL = law_vector(kp=8.0, kd=0.4, viscous=0.2, coulomb=0.02, rotor=0.01)


def recorded(tree: KinematicTree, seed: int, gain: np.ndarray, time: np.ndarray) -> Recording:
    rng = np.random.default_rng(seed)
    command = (rng.uniform(-1.2, 1.2, 40)[(time / 1.5).astype(int)] + 0.2 * np.sin(3.0 * time))[:, None]
    q = roll_out_arm(tree, NOMINAL[None], time, command, np.zeros(1), gain=gain[:, None], step=0.001)
    return Recording(time, ENCODER * np.round(q / ENCODER), None, ("servo",), command=command)


@pytest.mark.parametrize(("first", "last"), [(1.0, 0.7), (0.7, 1.0), (0.85, 0.85)])
def test_a_trend_is_as_large_as_the_change_where_a_gain_fades_from_nominal(nominal: Path, first, last):
    tree, time = kinematic_tree(load_description(nominal)), np.arange(0.0, 30.0, 0.02)
    gain = np.linspace(first, last, time.size)
    problem = pose_motion_problem([recorded(tree, seed, gain, time) for seed in (1, 2, 3)], tree)
    case = joint_case(problem, 2, 0, NominalServo(NOMINAL[None], (True,), "file"), SelectionLimits(), 1.0)
    law = NOMINAL.copy()
    law[KP] *= 0.5 * (first + last)
    trend = trends_of(problem, 2, 0, case, law, ("gain_error",))["gain_error"]
    share = abs(last - first) / 2.0 / (1.0 - 0.5 * (first + last))
    assert trend.parameter == "kp"
    assert trend.share == pytest.approx(share, abs=0.15)
    assert trend.least <= trend.share
    assert first == last or trend.shown == pytest.approx(1.0, abs=0.2)
    assert trend.is_more_than(SelectionLimits().trend) == (first != last)


@pytest.mark.parametrize(
    ("share", "least", "shown", "more"),
    [(0.5, 0.06, 0.9, True), (0.5, -0.06, 0.9, False), (0.1, 0.06, 0.9, False), (2.5, 1.8, -3.0, False)],
    ids=["a trend", "scatter", "small", "a slope of stick and slip"],
)
def test_a_trend_counts_where_it_is_large_beyond_scatter_and_borne_out(share, least, shown, more):
    assert Trend("kp", share, least, shown).is_more_than(SelectionLimits().trend) == more
