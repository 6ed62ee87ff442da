"""Facts about what a motion excites."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.recordings.excitation import excitation
from lagnet.recordings.recording import Recording

RMS_OF_A_SINE = np.sqrt(0.5)


def swing(seconds: float = 10.0, with_rates: bool = True) -> Recording:
    """Joint one swings at 1 Hz, joint two turns one way, joint three stands."""
    time = np.arange(0, seconds, 0.002)
    w = 2 * np.pi
    q = np.column_stack([np.sin(w * time), 0.3 * time, np.full_like(time, 0.7)])
    v = np.column_stack([w * np.cos(w * time), np.full_like(time, 0.3), np.zeros_like(time)])
    a = np.column_stack([-(w**2) * np.sin(w * time), np.zeros_like(time), np.zeros_like(time)])
    tau = np.column_stack([5 * np.sin(w * time), np.ones_like(time), -np.ones_like(time)])
    rates = {"v": v, "a": a} if with_rates else {}
    return Recording(time=time, q=q, tau=tau, joints=("swing", "turn", "stand"), **rates)


@pytest.mark.parametrize("with_rates", [True, False])
def test_a_swing_a_turn_and_a_standstill(with_rates: bool) -> None:
    moving, turning, standing = excitation(swing(with_rates=with_rates))
    assert moving.reversals == 20  # two in each of ten periods
    assert moving.both_directions
    assert moving.moves
    assert moving.acceleration_rms == pytest.approx((2 * np.pi) ** 2 * RMS_OF_A_SINE, rel=0.01)
    assert moving.speed_range[1] == pytest.approx(2 * np.pi, rel=1e-3)
    assert moving.position_range == pytest.approx((-1, 1), abs=1e-4)
    assert moving.torque_range == pytest.approx((-5, 5), abs=1e-3)
    assert turning.reversals == 0
    assert turning.moves
    assert not turning.both_directions
    assert turning.forward_share == 1.0
    assert not standing.moves
    assert standing.speed_range == (0.0, 0.0)
    assert standing.samples == 5000


def test_noise_at_standstill_is_no_reversal() -> None:
    recording = swing()
    rng = np.random.default_rng(0)
    v = recording.v + rng.normal(0, 1e-3, recording.v.shape)
    noisy = Recording(time=recording.time, q=recording.q, tau=recording.tau, joints=recording.joints, v=v)
    assert excitation(noisy)[0].reversals == 20


def test_motions_are_not_joined_at_their_ends() -> None:
    """A jump of q between two motions is neither a speed nor a reversal."""
    time = np.arange(0, 1, 0.01)
    out, back = time, 5.0 + time
    joined = Recording(
        time=np.r_[time, time],
        q=np.r_[out, back][:, None],
        tau=np.zeros((200, 1)),
        joints=("j",),
        trajectory=np.repeat([0, 1], 100),
        trajectory_names=("a", "b"),
    )
    (facts,) = excitation(joined)
    assert facts.speed_range[1] == pytest.approx(1.0)
    assert facts.reversals == 0
    (both,) = excitation([joined, joined])
    assert both.samples == 400
