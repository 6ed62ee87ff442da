"""Laws fitted to rollouts of a coupled arm: values come back, intervals hold them, one rollout gives many slopes."""

from __future__ import annotations

import numpy as np
import pytest
from tests.tolerances import IDENTITY, RECOVERY

from lagnet.diagnosis.motion.arm.arm_laws import ArmLaws
from lagnet.diagnosis.motion.arm.fitting import fit_values, sensitivities_of
from lagnet.diagnosis.motion.arm.intervals import half_widths
from lagnet.diagnosis.motion.arm.rollouts import PIECE, SAMPLES, STEP, ArmRuns, runs_to_fit
from lagnet.diagnosis.motion.joint.fitting import Coordinates
from lagnet.diagnosis.motion.problem import MotionProblem, pose_motion_problem
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.kinematic_tree import kinematic_tree
from lagnet.rigid_body.robot import load_description
from lagnet.rollout.whole_arm import roll_out_arm
from lagnet.servos.parameters import COULOMB, KP, LAW, law_vector

ENCODER = 2.0 * np.pi / 4096.0
NOMINAL = law_vector(kp=8.0, kd=0.3, viscous=0.15, coulomb=0.03, rotor=0.01)
GAIN, FRICTION = 5.0, 0.12  # true ones of the second joint
ARM = """<mujoco><compiler angle="radian"/><worldbody><body><joint name="upper" axis="0 1 0"/>
<inertial pos="0 0 -0.08" mass="0.3" diaginertia="4e-4 4e-4 5e-5"/><body pos="0 0 -0.16">
<joint name="lower" axis="0 1 0"/><inertial pos="0 0 -0.08" mass="0.25" diaginertia="4e-4 4e-4 5e-5"/></body></body>
</worldbody></mujoco>"""


def true_laws() -> np.ndarray:
    laws = np.array([NOMINAL, NOMINAL])
    laws[1, [KP, COULOMB]] = GAIN, FRICTION
    return laws


def posed(tmp_path, step: float, seconds: float = 16.0) -> MotionProblem:
    """Two joints that step and sweep, with an encoder of so many radians a step."""
    path = tmp_path / "arm.xml"
    path.write_text(ARM, encoding="utf-8")
    tree = kinematic_tree(load_description(path))
    time = np.arange(0.0, seconds, 0.02)
    jumps = np.random.default_rng(0).uniform(-1.0, 1.0, (int(seconds / 2.0) + 1, 2))[(time / 2.0).astype(int)]
    command = np.where(time[:, None] % 16.0 < 8.0, jumps, 0.6 * np.sin(0.12 * time**2)[:, None] * np.array([1.0, 0.7]))
    q = roll_out_arm(tree, true_laws(), time, command, command[0], step=STEP)
    q = step * np.round(q / step) if step else q
    recording = Recording(time, q, None, ("upper", "lower"), command=command, path="run")
    return pose_motion_problem([recording], tree)


def arm_of(problem: MotionProblem) -> ArmLaws:
    """Gain and dry friction of both joints free, from the nominal ones."""
    free = Coordinates((("kp",), ("coulomb",)), np.array([8.0, 0.1]))
    return ArmLaws(ArmRuns(problem, problem.runs, (0, 1)), np.array([NOMINAL, NOMINAL]), {0: free, 1: free})


@pytest.mark.slow
def test_values_come_back_from_rollouts_of_the_whole_arm(tmp_path):
    arm = arm_of(posed(tmp_path, 0.0))
    values = fit_values(arm.errors, arm.sensitivities, arm.read(), arm.sizes, np.full(2, 1e-5), nearest=arm.nearest)
    assert values == pytest.approx([8.0, 0.03, GAIN, FRICTION], rel=100.0 * RECOVERY)


@pytest.mark.slow
def test_intervals_hold_the_values_behind_an_encoder(tmp_path):
    arm, floors = arm_of(posed(tmp_path, ENCODER)), np.full(2, 0.5 * ENCODER)
    values = fit_values(arm.errors, arm.sensitivities, arm.read(), arm.sizes, floors, nearest=arm.nearest)
    here, coupled = arm.errors(values), sensitivities_of(arm.errors, arm.sizes, arm.nearest)
    half, unseen = half_widths(here, coupled(values, here), floors, np.diag(arm.sizes))
    assert unseen.shape == (4, 0)
    assert np.all(np.abs(values - np.array([8.0, 0.03, GAIN, FRICTION])) <= half)
    assert np.all(half < [0.4, 0.03, 0.25, 0.03])


@pytest.mark.slow
def test_slopes_at_once_are_those_one_by_one_where_one_joint_alone_is_free(tmp_path):
    both = arm_of(posed(tmp_path, 0.0, 8.0))
    arm = ArmLaws(both.runs, both.laws, {1: both.free[1]})
    values = arm.read()
    here = arm.errors(values)
    at_once = arm.sensitivities(values, here)
    each = sensitivities_of(arm.errors, arm.sizes, arm.nearest)(values, here)
    assert np.abs(at_once[1] - each[1]).max() < IDENTITY
    assert not at_once[0].any()
    assert each[0].any()  # the other joint feels it


def test_slopes_at_a_bound_are_taken_inwards(tmp_path):
    arm = arm_of(posed(tmp_path, 0.0, 8.0))
    values = np.array([LAW[KP].upper, 0.03, 8.0, 0.03])
    assert all(np.isfinite(s).all() for s in arm.sensitivities(values, arm.errors(values)))
    assert np.array_equal(arm.nearest(values), values)


@pytest.mark.slow
def test_long_recordings_are_fitted_in_pieces_from_all_parts(tmp_path):
    problem = posed(tmp_path, ENCODER, 400.0)
    pieces = runs_to_fit(problem, 1)
    time = problem.series[0].time
    assert 0.5 * SAMPLES < sum(p.last - p.first + 1 for p in pieces) <= SAMPLES
    assert all(0.4 * PIECE < time[p.last] - time[p.first] < 1.6 * PIECE for p in pieces)
    assert pieces[0].first == 0
    assert time[pieces[-1].first] > 380.0
    (run,) = runs_to_fit(posed(tmp_path, ENCODER), 1)
    assert (run.first, run.last) == (0, 799)  # a short one is fitted whole
