"""What an effort column holds: each kind is told from the others, and what cannot be told is not guessed."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import lagnet
from lagnet.diagnosis.effort_column.decide import effort_column
from lagnet.diagnosis.effort_column.finding import CANNOT_TELL
from lagnet.diagnosis.effort_column.units import unit_odds
from lagnet.recordings.recording import Recording

CONSTANTS = np.array([12.0, 15.0, 9.0, 7.0, 10.0, 6.0])
DRY, WET = np.array([8.0, 12.0, 6.0, 2.0, 1.5, 1.0]), np.array([6.0, 9.0, 4.0, 1.0, 1.0, 0.8])
LOAD = {"mass": 0.4, "com": np.array([0.0, 0.0, 0.05]), "inertia": 1e-3 * np.eye(3)}


@pytest.fixture(scope="module")
def robot():
    """The nominal arm."""
    return lagnet.load_robot("ur5")


@pytest.fixture(scope="module")
def run(robot) -> dict[str, np.ndarray]:
    """A motion of an arm that carries a load which the nominal one does not."""
    rng = np.random.default_rng(1)
    time = 0.01 * np.arange(2500)
    rate, phase = 2 * np.pi * rng.uniform(0.1, 0.5, (4, 6)), rng.uniform(0, 6, (4, 6))
    angle = rate * time[:, None, None] + phase
    q = 0.25 * np.sin(angle).sum(axis=1) + [0.0, -1.2, 1.0, -1.0, 0.5, 0.0]
    v, a = 0.25 * (rate * np.cos(angle)).sum(axis=1), -0.25 * (rate**2 * np.sin(angle)).sum(axis=1)
    real = robot.with_payload(**LOAD)
    link = real.inverse_dynamics(q, v, a)
    motor = link + DRY * np.tanh(v / 0.01) + WET * v + 0.3 * a
    return {"time": time, "q": q, "v": v, "link": link, "motor": motor, "gravity": real.gravity_torque(q)}


def columns(run: dict[str, np.ndarray]) -> dict[str, tuple[np.ndarray, str]]:
    """Column and true unit of each kind."""
    motor, own = run["motor"], "drive's own"
    top = np.array([3.3, 3.3, 3.3, 3.3, 3.3, 3.3])
    return {
        "torque": (motor, "N m"),
        "link-side torque": (run["link"] + 0.2 * np.tanh(run["v"] / 0.01), "N m"),
        "torque without gravity": (motor - run["gravity"], "N m"),
        "current": (motor / CONSTANTS, own),
        "magnitude of torque": (np.abs(motor), "N m"),
        "magnitude of current": (np.abs(motor / CONSTANTS), own),
        "duty": (np.clip(100 * (motor / (3 * np.abs(motor).max(axis=0)) + run["v"] / top / 1.1), -100, 100), own),
        "position": (np.degrees(run["q"]), "degrees"),
        "constant": (np.zeros_like(motor), ""),
    }


KINDS = (
    "torque",
    "link-side torque",
    "torque without gravity",
    "current",
    "magnitude of torque",
    "magnitude of current",
    "duty",
    "position",
    "constant",
)


def recorded(run: dict[str, np.ndarray], robot, column: np.ndarray, command: np.ndarray | None = None) -> Recording:
    """A log with noise of one percent on the column."""
    noise = 0.01 * column.std(axis=0) * np.random.default_rng(2).standard_normal(column.shape)
    whole = column if not column.any() else np.abs(column + noise) if (column >= 0).all() else column + noise
    return Recording(run["time"], run["q"], whole, robot.joints, command=command)


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_is_told(kind: str, run, robot) -> None:
    column, unit = columns(run)[kind]
    found = effort_column([recorded(run, robot, column)], robot)
    assert (found.kind, found.unit) == (kind, unit), found.evidence
    assert found.is_torque == (kind in ("torque", "link-side torque"))
    assert (found.data_quality("run") is None) == found.is_torque


def test_newton_millimetres_are_mended_by_the_mapping(run, robot) -> None:
    found = effort_column([recorded(run, robot, 1000 * run["motor"])], robot)
    assert (found.kind, found.unit) == ("torque", "N mm")
    assert found.mapping(()) == {"scale": ["tau = 0.001  # N mm to N m"]}


def test_currents_come_with_constants_to_compare(run, robot) -> None:
    found = effort_column([recorded(run, robot, run["motor"] / CONSTANTS)], robot)
    lifting = found.scale[1]
    assert lifting is not None
    assert 1 / lifting == pytest.approx(CONSTANTS[1], rel=0.2)  # the load that the model lacks is in it
    assert found.mapping([f"tau_{k}" for k in range(6)])["columns"][1] == '"current_0" = "tau_0"'


def test_a_position_error_is_told_from_a_torque(run, robot) -> None:
    command = run["q"] + (run["motor"] - run["gravity"] + 5 * run["v"]) / 3000
    log = recorded(run, robot, 40 * (command - run["q"]), command)
    assert effort_column([log], robot).kind == "position error"
    # A current beside commands stays a current.
    assert effort_column([recorded(run, robot, run["motor"] / CONSTANTS, command)], robot).kind == "current"


def test_noise_is_not_guessed_at(run, robot) -> None:
    column = np.random.default_rng(0).standard_normal(run["q"].shape)
    found = effort_column([recorded(run, robot, column)], robot)
    assert found.kind == CANNOT_TELL
    assert not found.decided
    assert "predicts" in found.sentence()


def test_another_column_than_tau(run, robot) -> None:
    log = replace(recorded(run, robot, run["motor"]), current=run["motor"] / CONSTANTS)
    assert effort_column([log], robot, "current").kind == "current"


def test_units_of_one_joint_are_open_and_of_many_are_not() -> None:
    alike = unit_odds([(1.02, 0.01)] * 6, [50.0] * 6)
    assert alike.best == "N m"
    assert alike.likely["N m"] > 0.99
    assert max(unit_odds([(0.8, 0.1)], [1.0]).likely.values()) < 0.95
    unlike = unit_odds([(0.09, 0.01), (0.07, 0.01), (0.15, 0.01), (0.2, 0.02)], [50.0, 60.0, 30.0, 10.0])
    assert unlike.best == "current"
    assert sum(unlike.likely.values()) == pytest.approx(1.0)


@pytest.mark.shared_data
@pytest.mark.parametrize(
    ("file", "name", "kinds"),
    [
        ("bags/ur10_exciting_trajectory.db3", "ur10", {"torque"}),
        ("bags/panda_exciting_trajectory.db3", "panda", {"link-side torque", "torque of either side", CANNOT_TELL}),
    ],
)
def test_real_bags(file: str, name: str, kinds: set[str], shared_data: Path) -> None:
    from lagnet.recordings.loading.load import load_recording

    robot = lagnet.load_robot(name)
    found = effort_column([load_recording(shared_data / file, robot=robot)], robot)
    assert found.kind in kinds
    assert found.unit in ("N m", "")
