"""Where there is little motion, every window is for validation once; no torque was limited below full duty."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lagnet.diagnosis.motion.joint.cases import EVERY, joint_case
from lagnet.diagnosis.motion.joint.joint_case import SelectionLimits
from lagnet.diagnosis.motion.problem import pose_motion_problem
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.kinematic_tree import kinematic_tree
from lagnet.rigid_body.robot import load_description
from lagnet.servos.nominal import NominalServo
from lagnet.servos.parameters import law_vector


def case_of(nominal, seconds: float, duty: float | None = None):
    time = np.arange(0.0, seconds, 0.02)
    command = np.where(time % 4.0 < 2.0, 1.0, -1.0)[:, None] * (1.0 + 0.1 * np.sin(time))[:, None]
    q = 0.9 * np.roll(command, 3, axis=0)
    recording = Recording(time, q, None, ("servo",), command=command, path="run")
    if duty is not None:
        recording = replace(recording, duty=duty * np.ones_like(q))
    problem = pose_motion_problem([recording], kinematic_tree(load_description(nominal)))
    servo = NominalServo(law_vector(kp=8.0)[None], (False,), "estimated")
    return problem, joint_case(problem, 1, 0, servo, SelectionLimits())


def test_every_window_is_for_validation_once(nominal):
    problem, case = case_of(nominal, 24.0)
    pairs = [(case.fit, case.validation), *case.folds]
    seen = np.concatenate([validation.windows.first for _, validation in pairs])
    assert len(pairs) == EVERY
    assert sorted(seen) == sorted(problem.windows(0).first)
    for fit, validation in pairs:
        assert not set(fit.windows.first) & set(validation.windows.first)


def test_enough_motion_has_one_part_for_validation(nominal):
    assert case_of(nominal, 160.0)[1].folds == ()


@pytest.mark.parametrize(("duty", "excited"), [(None, True), (0.6, False), (1.0, True)])
def test_no_torque_was_limited_below_full_duty(nominal, duty, excited):
    assert ("duty_saturation" in case_of(nominal, 24.0, duty)[1].excited) is excited
