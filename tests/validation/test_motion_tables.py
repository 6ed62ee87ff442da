"""Plants over a table are the given arms but for the table, and the study counts them as its page says."""

from __future__ import annotations

import numpy as np
import pytest
from validation.motion_concealed.plants import ENCODER
from validation.motion_concealed.robots import SERVO, STRONG
from validation.motion_concealed.table_plants import FRICTION, plant_over_table
from validation.motion_concealed.tables import KINDS, WITHOUT, figures, judge

from lagnet.models.corrected.servo_driven import ServoDrivenModel

SECONDS = 8.0


def error_of_the_nominal_model(case) -> float:
    arm = case.plant
    model, recording = ServoDrivenModel(arm.robot, arm.servo.laws, (True,) * arm.robot.n_dof), arm.recordings[0]
    q = model.rollout(np.array(recording.command), recording.time, recording.q[0], step=0.001)
    return float(np.sqrt(np.mean((q - recording.q) ** 2)))


@pytest.mark.slow
def test_without_a_table_the_arm_moves_as_its_model(tmp_path):
    free = plant_over_table(5, 0, "arm6", False, SECONDS, tmp_path)
    over = plant_over_table(5, 0, "arm6", True, SECONDS, tmp_path)
    assert free.table is None
    assert error_of_the_nominal_model(free) < 3.0 * ENCODER
    assert error_of_the_nominal_model(over) > 3.0 * error_of_the_nominal_model(free)


@pytest.mark.slow
def test_friction_is_hidden_in_every_other_pair(tmp_path):
    low, high = (STRONG * SERVO["kp"] / 8.0 * f for f in FRICTION)
    hidden = [plant_over_table(5, i, "arm6", False, 1.0, tmp_path).friction for i in range(4)]
    assert hidden[:2] == [0.0, 0.0]
    assert all(low <= f <= high for f in hidden[2:])


def test_every_kind_is_there_with_and_without_a_table_and_friction():
    seen = {(i % len(KINDS), i % WITHOUT == WITHOUT - 1, i // 2 % 2) for i in range(30)}
    assert len(seen) == 2 * 2 * len(KINDS)


def row(table: float | None, named: bool, touching: float = 0.1, **more) -> dict:
    told = {"table": table, "touching": touching, "named": named, "used": named, "rmse_nominal": 0.1}
    return told | {"rmse_corrected": 0.02 if named else 0.1} | more


def test_a_table_is_asked_for_where_it_is_touched():
    over = [row(0.1, True, h=0.11, covered=True) for _ in range(19)]
    found = figures([*over, row(0.1, False), row(0.1, False, touching=0.0), row(None, False)])
    assert (found["tables"], found["touched"], found["named"]) == (21, 20, 19)
    assert found["height_off_m"] == pytest.approx(0.01)
    assert all(judge(found).values())


@pytest.mark.parametrize(
    ("line", "rows"),
    [
        ("recall", [row(0.1, True, h=0.1, covered=True), row(0.1, False)]),
        ("better", [row(0.1, True, h=0.1, covered=True), row(0.1, False)]),
        ("told_without_a_table", [row(0.1, True, h=0.1, covered=True), row(None, True)]),
        ("cover", [row(0.1, True, h=0.2, covered=False)]),
    ],
)
def test_a_line_that_is_missed_is_said(line, rows):
    assert judge(figures(rows))[line] is False
