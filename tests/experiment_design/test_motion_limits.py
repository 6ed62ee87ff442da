"""A suggested motion may do what the arm's description allows, with a margin, or what the recordings show."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lagnet.experiment_design.motion_limits import BEYOND, MODEST, motion_limits


def seen(**changes: Any) -> Any:
    """Two joints: the first moved, the second stood still; a description that states every limit."""
    time = np.linspace(0.0, 10.0, 1000)
    q = np.column_stack([0.5 + 0.2 * np.sin(time), np.full(time.size, -0.1)])
    v = np.column_stack([0.2 * np.cos(time), np.zeros(time.size)])
    a = np.column_stack([-0.2 * np.sin(time), np.zeros(time.size)])
    piece = SimpleNamespace(q=q, v=v, a=a, tau=10.0 * q)
    stated = {
        "position_lower": np.full(2, -1.0),
        "position_upper": np.full(2, 1.0),
        "velocity_limit": np.full(2, 1.0),
        "effort_limit": np.full(2, 20.0),
        "joint_types": ("revolute", "revolute"),
    }
    nominal = SimpleNamespace(**(stated | changes)) if changes != {"nothing": True} else SimpleNamespace()
    return SimpleNamespace(fit=(piece,), nominal=nominal, n_dof=2)


def test_stated_limits_are_kept_with_a_margin_and_near_where_the_arm_was() -> None:
    limits = motion_limits(seen())
    assert limits.from_model
    np.testing.assert_allclose(limits.lower, [0.3 - BEYOND, -0.1 - BEYOND], atol=1e-3)
    np.testing.assert_allclose(limits.upper, [0.9, -0.1 + BEYOND], atol=1e-3)
    np.testing.assert_allclose(limits.speed, 0.7)
    np.testing.assert_allclose(limits.torque, 16.0)
    np.testing.assert_allclose(limits.acceleration, MODEST)


def test_a_model_without_limits_is_kept_to_what_the_recordings_show() -> None:
    limits = motion_limits(seen(nothing=True))
    assert not limits.from_model
    assert limits.upper[0] == pytest.approx(0.7, abs=1e-3)
    assert limits.lower[1] == limits.upper[1] == pytest.approx(-0.1)
    assert limits.speed[0] == pytest.approx(0.2, abs=1e-3)
    assert limits.speed[1] == 0.0


@pytest.mark.parametrize("nothing", [0.0, np.inf])
def test_a_limit_that_says_nothing_is_taken_from_the_recordings(nothing: float) -> None:
    limits = motion_limits(seen(effort_limit=np.full(2, nothing), velocity_limit=np.full(2, nothing)))
    np.testing.assert_allclose(limits.torque, [7.0, 1.0], atol=1e-2)
    assert limits.speed[0] == pytest.approx(0.2, abs=1e-3)


def test_what_the_arm_did_is_allowed_even_beyond_a_limit() -> None:
    limits = motion_limits(seen(position_upper=np.array([0.6, 1.0]), effort_limit=np.full(2, 5.0)))
    assert limits.upper[0] == pytest.approx(0.7, abs=1e-3)
    assert limits.torque[0] == pytest.approx(7.0, abs=1e-2)
