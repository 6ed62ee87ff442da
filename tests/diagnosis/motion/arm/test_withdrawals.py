"""Rules that withdraw names by rollouts of the whole arm: where a size is open, or most of the error is left."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from lagnet.diagnosis.motion.arm.withdrawals import undetermined, unexplained
from lagnet.diagnosis.motion.joint.joint_case import SelectionLimits
from lagnet.diagnosis.motion.joint.selection import REMAINDER, WITHIN_INTERVAL
from lagnet.diagnosis.motion.problem import MotionProblem, pose_motion_problem
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.kinematic_tree import kinematic_tree
from lagnet.rigid_body.robot import load_description
from lagnet.rollout.whole_arm import roll_out_arm
from lagnet.servos.parameters import COULOMB, KP, law_vector

NOMINAL = law_vector(kp=8.0, kd=0.3, viscous=0.15, coulomb=0.03, rotor=0.01)
GAIN, FRICTION = 5.0, 0.12
PENDULUM = """<mujoco><compiler angle="radian"/><worldbody><body><joint name="lower" axis="0 1 0"/>
<inertial pos="0 0 -0.08" mass="0.3" diaginertia="4e-4 4e-4 5e-5"/></body></worldbody></mujoco>"""
NEVER, ONCE, OFTEN = 0.0, 1.0, 20.0  # [s] for which the joint does what no law says
AWAY = 0.19  # [rad], which in one second is most of the error of its recording
FAR = 1.0  # [rad], which in one second is most of the error of all recordings


def law_of(gain: float, friction: float) -> np.ndarray:
    law = NOMINAL.copy()
    law[[KP, COULOMB]] = gain, friction
    return law


def moved(tmp_path: Path, away: float, far: float = AWAY) -> MotionProblem:
    """Steps of a joint with a weak gain, in the second recording for so long away from where it leads."""
    path = tmp_path / "arm.xml"
    path.write_text(PENDULUM, encoding="utf-8")
    tree, time, recordings = kinematic_tree(load_description(path)), np.arange(0.0, 20.0, 0.02), []
    for seed, seconds in enumerate((NEVER, away)):
        command = np.random.default_rng(seed).uniform(-1.0, 1.0, (11, 1))[(time / 2.0).astype(int)]
        q = roll_out_arm(tree, law_of(GAIN, 0.03)[None], time, command, command[0])
        q[time < seconds] += far
        recordings.append(Recording(time, q, None, ("lower",), command=command, path=f"run {seed}"))
    return pose_motion_problem(recordings, tree)


def diagnosis(law: np.ndarray, *effects: str) -> SimpleNamespace:
    case = SimpleNamespace(law=NOMINAL, base=(), floor=0.002, limits=SelectionLimits())
    return SimpleNamespace(case=case, named=SimpleNamespace(effects=effects), named_law=law, law=law)


@pytest.mark.parametrize(
    ("away", "gain", "withdrawn"),
    [(NEVER, GAIN, False), (NEVER, 7.5, True), (ONCE, GAIN, False), (OFTEN, GAIN, True)],
    ids=["the true gain", "a gain that leaves most", "one event beside the true gain", "errors all along"],
)
def test_a_name_that_leaves_most_of_the_error_goes_unless_one_event_alone_is_left(
    tmp_path: Path, away: float, gain: float, withdrawn: bool
):
    found = {0: diagnosis(law_of(gain, 0.03), "gain_error")}
    rejected = unexplained(moved(tmp_path, away), 1, NOMINAL[None], found)  # pyright: ignore[reportArgumentType]
    assert [r.rule for r in rejected.get(0, ())] == [REMAINDER] * withdrawn


def test_one_event_withdraws_no_name_even_where_it_is_most_of_all_error(tmp_path: Path):
    found = {0: diagnosis(law_of(GAIN, 0.03), "gain_error")}
    assert unexplained(moved(tmp_path, ONCE, FAR), 1, NOMINAL[None], found) == {}  # pyright: ignore[reportArgumentType]


def test_an_effect_whose_interval_holds_the_nominal_value_is_not_known():
    law = NOMINAL.copy()
    law[[KP, COULOMB]] = GAIN, FRICTION
    intervals = {"kp": (4.9, 5.1), "kd": (0.2, 0.4), "coulomb": (0.02, 0.22)}
    case = SimpleNamespace(law=NOMINAL, base=())
    named = SimpleNamespace(effects=("gain_error", "coulomb_friction"))
    found = SimpleNamespace(case=case, named=named, named_law=law, intervals=intervals)
    (open_,) = undetermined(found)
    assert (open_.effect, open_.rule) == ("coulomb_friction", WITHIN_INTERVAL)
    assert open_.value == pytest.approx(0.9)
    case.base = (("kp",),)
    assert undetermined(found) == ()
