"""Mechanics first, ε on what it left: ε takes nothing from mechanics, and a killed run goes on to the same weights."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lagnet.models.delan import DelanSettings
from lagnet.models.kinds import AugmentedSettings
from lagnet.models.torque_network import TorqueNetworkSettings
from lagnet.recordings.recording import Recording
from lagnet.training.settings import TrainingSettings
from lagnet.training.train import TrainResult, stage_files, train

SIZES = AugmentedSettings(
    mechanics_settings=DelanSettings(rank=3, potential_rank=3), residual=TorqueNetworkSettings(hidden=(16,))
)
PLAN = TrainingSettings(steps=500, batch=64, patience=1.0, learning_rate=5e-2)
SILENT = 1e-3  # of the torque variance: what ε may hold where mechanics explain all
MOSTLY = 0.04  # of the friction's power: a short training, held to which part took the torque and not to precision


def swing(friction: float) -> Recording:
    """One joint under gravity with viscous friction: τ = 0.7 a + 3 sin q + friction v."""
    q, v, a = np.random.default_rng(0).uniform(-3.0, 3.0, (3, 800, 1))
    tau = 0.7 * a + 3.0 * np.sin(q) + friction * v
    names = tuple(map(str, range(8)))
    label = np.arange(800) // 100
    return Recording(0.01 * np.arange(800), q, tau, ("swing",), v=v, a=a, trajectory=label, trajectory_names=names)


def fitted(run: Recording, **given: Any) -> TrainResult:
    return train([run], "delan-ffnn", settings=SIZES, training=PLAN, joint_types=("continuous",), **given)


@pytest.fixture(scope="module")
def with_friction() -> TrainResult:
    return fitted(swing(0.5))


def test_epsilon_takes_nothing_where_nothing_is_left_out():
    run = swing(0.0)
    done = fitted(run)
    assert run.v is not None
    assert run.a is not None
    share = done.model.residual_torque(run.q, run.v, run.a).var() / run.tau.var()
    assert share < SILENT
    assert max(done.stats["held_out_error"]) < SILENT


def test_friction_goes_to_epsilon_and_gravity_does_not(with_friction: TrainResult):
    rng = np.random.default_rng(5)
    q, v, rest = rng.uniform(-2.5, 2.5, (50, 1)), rng.uniform(-2.5, 2.5, (50, 1)), np.zeros((50, 1))
    model = with_friction.model
    off = model.residual_torque(q, v, rest) - 0.5 * v
    assert np.mean(off**2) < MOSTLY * np.mean((0.5 * v) ** 2)
    spread = model.gravity_torque(q) - 3.0 * np.sin(q)
    assert np.abs(spread).max() < 0.1
    assert model.mass_matrix(q).mean() == pytest.approx(0.7, rel=0.05)


def test_steps_are_shared_and_counted_through(with_friction: TrainResult):
    steps = [report.step for report in with_friction.history.reports]
    assert steps == sorted(steps)
    assert with_friction.stats["steps"] == PLAN.steps
    assert with_friction.history.kept_step > 0.6 * PLAN.steps  # ε made it better


class Killed(Exception):
    """Stands for the process dying between two chunks."""


@pytest.mark.parametrize("chunk", [2, 5])
def test_a_run_killed_in_either_stage_resumes_to_the_same_weights(
    with_friction: TrainResult, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, chunk: int
):
    monkeypatch.setattr("lagnet.training.fit.CHECKPOINT_EVERY", 0.0)
    path, seen = tmp_path / "run.npz", []

    def dies(report: Any) -> None:
        seen.append(report)
        if len(seen) == chunk:
            raise Killed

    with pytest.raises(Killed):
        fitted(swing(0.5), checkpoint=path, progress=dies)
    assert stage_files(path)[0].exists()
    resumed = fitted(swing(0.5), checkpoint=path)
    state = np.array([[0.4]]), np.array([[0.3]]), np.array([[0.2]])
    np.testing.assert_array_equal(resumed.model.inverse_dynamics(*state), with_friction.model.inverse_dynamics(*state))
