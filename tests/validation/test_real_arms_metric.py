"""What rest has of an error is told from what motion has of it."""

from __future__ import annotations

import numpy as np
import pytest
from validation.real_arms.metric import at_rest, nmse

from lagnet.recordings.recording import Recording

RATE = 200.0  # [Hz]
MOVES, ENDS = 6.0, 10.0  # [s]


@pytest.fixture(scope="module")
def stopped() -> Recording:
    """Two joints that swing and then stand."""
    time = np.arange(0.0, ENDS, 1.0 / RATE)
    along = np.minimum(time, MOVES)[:, None]
    q = np.column_stack([np.cos(np.pi * along), 0.3 * np.cos(2.0 * np.pi * along)])
    return Recording(time, q, 5.0 * np.sin(3.0 * along) * [1.0, 2.0], ("a", "b"))


def table(recording: Recording, error: np.ndarray) -> dict[str, np.ndarray]:
    measured = {f"tau_measured_{j}": recording.tau[:, j] for j in range(2)}
    corrected = {f"tau_corrected_{j}": recording.tau[:, j] - error for j in range(2)}
    return {"time": recording.time} | measured | corrected


@pytest.mark.parametrize(("where", "share"), [("rest", 1.0), ("motion", 0.0)])
def test_an_error_is_told_where_it_is(where, share, stopped) -> None:
    inside = stopped.time > MOVES + 0.5 if where == "rest" else stopped.time < MOVES - 0.5
    told = table(stopped, np.where(inside, 1.0, 0.0))
    for joint in range(2):
        found, moving = at_rest(told, joint, "corrected", stopped)
        assert found == pytest.approx(share, abs=0.05)
        assert (moving < 0.05 * nmse(told, joint, "corrected")) == (where == "rest")
