"""What parts the motion of two laws, for an effect that acts throughout and for one that acts at moments."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from lagnet.diagnosis.motion.joint.selection import difference_of
from lagnet.servos.catalogue import SERVO_CATALOGUE

APART = 0.01  # [rad] in one second of twenty


def two_laws() -> SimpleNamespace:
    """Data of twenty seconds in which the second of two laws parts from the first for one second."""
    time = np.arange(0.0, 20.0, 0.02)
    moved = np.where((time >= 7.0) & (time < 8.0), APART, 0.0)
    windows = SimpleNamespace(first=np.array([0, 500]), last=np.array([499, 999]))
    series = SimpleNamespace(time=time)
    return SimpleNamespace(series=series, windows=windows, predict=lambda laws: np.outer(laws[:, 0], moved))


@pytest.mark.parametrize(("at_moments", "expected"), [(False, APART / np.sqrt(20.0)), (True, APART / 2.0)])
def test_a_moment_counts_half_by_itself_where_the_effect_acts_at_moments(at_moments: bool, expected: float):
    found = difference_of(two_laws(), np.zeros(1), np.ones(1), at_moments)  # pyright: ignore[reportArgumentType]
    assert found == pytest.approx(expected, rel=0.03)


def test_break_away_friction_alone_acts_at_moments():
    assert [name for name, effect in SERVO_CATALOGUE.items() if effect.starts_alone] == ["static_friction"]
