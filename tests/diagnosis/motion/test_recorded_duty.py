"""A recorded duty tells full duty's error and the bias where it follows the command error, and nothing elsewhere."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lagnet.diagnosis.motion.recorded_duty import duty_line
from lagnet.recordings.recording import Recording

FULL_ERROR, BIAS = 3.5, 0.01
COUNT = 1.0 / 885.0  # of duty


def logged(gain: float, seed: int, noise: float = 0.0) -> Recording:
    """A servo that swings behind its command, its duty in counts, limited at the full one."""
    rng, time = np.random.default_rng(seed), np.arange(0.0, 4.0, 0.01)
    command, q = 1.5 * np.sin(2.0 * time), 0.9 * np.sin(2.0 * time - 0.2)
    duty = gain * (command - q - BIAS) / FULL_ERROR + noise * rng.normal(size=time.size)
    duty = np.clip(COUNT * np.round(duty / COUNT), -1.0, 1.0)
    return Recording(time, q[:, None], None, ("servo",), command=command[:, None], duty=duty[:, None])


def test_the_line_is_found_over_several_gains_below_full_duty():
    line = duty_line([logged(1.0, 0), logged(8.0, 1)], [1.0, 8.0], 0)
    assert line is not None
    assert line.full_error == pytest.approx(FULL_ERROR, rel=5e-3)
    assert line.bias == pytest.approx(BIAS, abs=FULL_ERROR * COUNT / 2.0)


def test_a_duty_that_something_else_sets_is_no_line():
    assert duty_line([logged(1.0, 0, noise=0.05)], None, 0) is None


def test_a_line_needs_duty_in_every_recording():
    whole = logged(1.0, 0)
    assert duty_line([whole, replace(whole, duty=None)], None, 0) is None


def test_full_duty_alone_tells_no_slope():
    whole = logged(1.0, 0)
    assert duty_line([replace(whole, duty=np.ones_like(whole.q))], None, 0) is None
