"""The split of torque: it adds up, agrees with Pinocchio, and is told with honest intervals."""

from __future__ import annotations

import json

import numpy as np
import pyarrow.parquet as pq
import pytest

from lagnet.decomposition.agreement import agreement, blocks_of, variance_floor
from lagnet.decomposition.decompose import decompose
from lagnet.decomposition.writing import summary, write_decomposition
from lagnet.errors import ModelError, RecordingError
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.random_arm import random_arm

IDENTITY = 1e-9  # rounding of sums of a few terms of order 1 to 1e3
RATE, FRICTION = 200.0, 2.0


class WithFriction:
    """An arm that says what lies beyond its mechanics."""

    def __init__(self, arm):
        self.joints, self.n_dof, self.joint_types = arm.joints, arm.n_dof, arm.joint_types
        self.mass_matrix, self.coriolis_torque = arm.mass_matrix, arm.coriolis_torque
        self.gravity_torque, self._torque = arm.gravity_torque, arm.inverse_dynamics

    def residual_torque(self, q, v, a):
        return FRICTION * v

    def inverse_dynamics(self, q, v, a):
        return self._torque(q, v, a) + FRICTION * v


@pytest.fixture(scope="module")
def arm():
    return random_arm(3, 8, ("revolute", "prismatic"))


def recording(model, seconds: float = 6.0, known: str = "va", noise: float = 0.0, motions: int = 1) -> Recording:
    time = np.arange(int(seconds * RATE)) / RATE
    phase = 2 * np.pi * 0.4 * time[:, None] + 1.3 * np.arange(model.n_dof)
    w = 2 * np.pi * 0.4
    q, v, a = 0.3 * np.sin(phase), 0.3 * w * np.cos(phase), -0.3 * w**2 * np.sin(phase)
    tau = model.inverse_dynamics(q, v, a) + noise * np.random.default_rng(0).normal(size=q.shape)
    labels = np.arange(time.size) * motions // time.size
    return Recording(
        time,
        q,
        tau,
        tuple(model.joints),
        v=v if "v" in known else None,
        a=a if "a" in known else None,
        trajectory=labels,
        trajectory_names=tuple(str(i) for i in range(motions)),
    )


def test_terms_add_up_to_the_models_torque(arm):
    rec = recording(arm)
    parts = decompose(arm, rec)
    np.testing.assert_allclose(parts.terms.total, rec.tau, atol=IDENTITY * np.abs(rec.tau).max())
    assert not parts.terms.residual.any()
    assert parts.motion_from == "recorded"
    np.testing.assert_allclose(sum(parts.shares.values()), 1.0, atol=IDENTITY)


def test_residual_is_what_the_model_says(arm):
    rec = recording(WithFriction(arm))
    parts = decompose(WithFriction(arm), rec, reference=arm)
    np.testing.assert_allclose(parts.terms.residual, FRICTION * rec.v)
    assert np.all(parts.term_errors["gravity"].nmse < IDENTITY)
    assert np.all(parts.term_errors["residual"].nmse > 1e-3)
    np.testing.assert_allclose(parts.energies.residual_power, FRICTION * np.sum(rec.v**2, axis=1))


def test_missing_velocity_and_acceleration_are_differentiated(arm):
    rec = recording(arm, seconds=10.0, known="")
    parts = decompose(arm, rec)
    assert parts.motion_from == "differentiated"
    assert len(parts.time) == len(rec)
    assert np.all(parts.total_error.nmse < 1e-2)


def test_energy_balances_along_the_motion(arm):
    parts = decompose(arm, recording(arm, motions=3))
    exchanged = np.ptp(parts.energies.kinetic + parts.energies.potential)
    assert np.abs(parts.energies.imbalance).max() < 1e-3 * exchanged  # trapezes at 200 Hz on motion of 0.4 Hz
    starts = np.flatnonzero(np.diff(parts.trajectory)) + 1
    assert not parts.energies.imbalance[starts].any()


def test_energy_of_a_model_that_breaks_mechanics_does_not_balance():
    arm = random_arm(3, 4, ("revolute",))

    class Tripled(WithFriction):
        def __init__(self, arm):
            super().__init__(arm)
            self.coriolis_torque = lambda q, v: 3.0 * arm.coriolis_torque(q, v)

    good, bad = (decompose(m, recording(arm)).energies for m in (WithFriction(arm), Tripled(arm)))
    assert np.abs(bad.imbalance).max() > 10 * np.abs(good.imbalance).max()


def test_ensemble_gives_mean_and_spread(arm):
    light = arm.with_inertial_parameters(0.9 * arm.inertial_parameters())
    parts = decompose([arm, light], recording(arm))
    single = decompose(arm, recording(arm))
    assert parts.spread is not None
    assert parts.spread.members == 2
    np.testing.assert_allclose(parts.terms.gravity, 0.95 * single.terms.gravity, atol=IDENTITY * 100)
    expected = 0.1 / np.sqrt(2) * np.abs(single.terms.total)
    np.testing.assert_allclose(parts.spread.of["total"], expected, atol=IDENTITY * 100)
    np.testing.assert_allclose(parts.energies.kinetic, 0.95 * single.energies.kinetic, atol=IDENTITY * 100)


def test_recordings_are_joined_and_told_apart(arm):
    parts = decompose(arm, [recording(arm, 2.0, motions=2), recording(arm, 3.0)])
    assert np.bincount(parts.recording).tolist() == [400, 600]
    assert np.unique(parts.trajectory).tolist() == [0, 1, 2]


def test_strangers_are_refused(arm):
    with pytest.raises(ModelError, match="has 2 joints, the model 3"):
        decompose(arm, recording(arm), reference=random_arm(2, 0))
    with pytest.raises(RecordingError, match="no recording"):
        decompose(arm, [])
    with pytest.raises(RecordingError, match="too few to differentiate"):
        decompose(arm, recording(arm, seconds=0.1, known=""))


def test_written_files_keep_the_promise(arm, tmp_path):
    parts = decompose(arm, recording(arm, noise=0.1), reference=WithFriction(arm))
    write_decomposition(parts, tmp_path)
    names = pq.read_schema(tmp_path / "decomposition.parquet").names
    for i in range(3):
        for term in ("inertial", "coriolis", "gravity", "residual", "total"):
            assert f"{term}_{i}" in names
            assert f"{term}_{i}_reference" in names
        assert f"measured_{i}" in names
    told = json.loads((tmp_path / "decomposition.json").read_text())
    assert told["joints"][0]["nmse_reference"]["gravity"]["value"] < IDENTITY
    assert told == json.loads(json.dumps(summary(parts)))
    assert not list(tmp_path.glob("*.partial"))


def test_interval_covers_the_truth():
    """nMSE of known noise, correlated over tenths of a second, inside the interval in 19 of 20 draws or nearly."""
    rng, covered, draws = np.random.default_rng(0), 0, 60
    time = np.arange(4000) / 200
    signal = np.sin(2 * np.pi * 0.7 * time)[:, None]
    blocks = blocks_of(time, np.zeros(4000, dtype=int))
    for _ in range(draws):
        noise = np.repeat(rng.normal(size=(200, 1)), 20, axis=0) * 0.1
        found = agreement(signal + noise, signal, np.zeros(1), blocks)
        covered += bool(found.low[0] <= 0.01 / signal.var() <= found.high[0])
    assert covered / draws > 0.8  # 0.95 less what 40 blocks cost and four standard errors


def test_interval_is_unknown_for_too_few_blocks():
    found = agreement(np.ones((5, 1)), np.zeros((5, 1)), np.ones(1), np.zeros(5, dtype=int))
    assert found.nmse[0] == 1.0
    assert np.isnan(found.low[0])


def test_blocks_end_where_trajectories_end():
    time = np.concatenate([np.arange(300) / 100, np.arange(200) / 100])
    labels = np.repeat([0, 1], [300, 200])
    blocks = blocks_of(time, labels)
    assert blocks[299] != blocks[300]
    assert np.all(np.diff(blocks) >= 0)
    assert blocks.max() + 1 >= 8


def test_floor_keeps_absent_terms_from_ratios_without_meaning():
    floor = variance_floor(np.random.default_rng(0).normal(size=(100, 2)) * [1.0, 10.0])
    assert floor[1] > 50 * floor[0] > 0
