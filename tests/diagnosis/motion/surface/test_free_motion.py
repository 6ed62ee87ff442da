"""Errors over a surface, where only runs that come near it are rolled out, are those of all runs rolled out."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.motion.arm.rollouts import ArmRuns, pieces_of
from lagnet.diagnosis.motion.problem import pose_motion_problem
from lagnet.diagnosis.motion.surface.free_motion import FreeMotion, free_motion
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.kinematic_tree import kinematic_tree
from lagnet.rigid_body.robot import load_description
from lagnet.servos.parameters import law_vector

ARM = """<mujoco><worldbody><body><joint name="a" axis="0 1 0"/>
<inertial pos="0 0 -0.08" mass="0.3" diaginertia="4e-4 4e-4 5e-5"/><body pos="0 0 -0.16"><joint name="b" axis="0 1 0"/>
<inertial pos="0 0 -0.08" mass="0.25" diaginertia="4e-4 4e-4 5e-5"/></body></body></worldbody></mujoco>"""


@pytest.fixture(scope="module")
def free(tmp_path_factory) -> FreeMotion:
    path = tmp_path_factory.mktemp("arm") / "arm.xml"
    path.write_text(ARM, encoding="utf-8")
    tree, time = kinematic_tree(load_description(path)), np.arange(0.0, 24.0, 0.02)
    turns = np.column_stack([np.sin(0.9 * time) + 0.3 * np.sin(0.2 * time), 0.6 * np.sin(1.7 * time)])
    recording = Recording(time, turns, None, ("a", "b"), command=turns, path="turns")
    laws = np.array([law_vector(kp=8.0, kd=0.3, rotor=0.01, coulomb=0.05)] * 2)
    problem = pose_motion_problem([recording], tree, None, None, 0, laws)
    return free_motion(ArmRuns(problem, tuple(pieces_of(problem, problem.runs, 2.0)), (0, 1)), laws, None)


@pytest.mark.parametrize("height", np.linspace(-0.35, -0.2, 7))
def test_they_are_the_same_to_the_last_bit(free, height):
    surface = np.array([1.0, 0.0, 0.0, -0.16, height, 2000.0, 0.3])
    for found, whole in zip(free.errors(surface), free.data.errors(free.laws, None, surface), strict=True):
        assert np.array_equal(found, whole)


def test_runs_that_stay_clear_are_not_rolled_out_again(free, monkeypatch):
    rolled: list[int] = []
    roll = ArmRuns.positions_in
    monkeypatch.setattr(
        ArmRuns, "positions_in", lambda self, which, *args: rolled.extend(which) or roll(self, which, *args)
    )
    free.errors(np.array([1.0, 0.0, 0.0, -0.16, -0.30, 2000.0, 0.3]))
    assert 0 < len(rolled) < len(free.data.runs)
