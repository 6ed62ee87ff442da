"""Events that are set aside may leave one sample of a stretch: it counts, and has no rate of its own."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from lagnet.diagnosis.estimation.intervals.misspecification import _slower

PROBLEM: Any = SimpleNamespace(rate=100.0, bandwidth=8.0)  # [Hz]


def test_the_slower_half_of_a_single_sample_is_finite() -> None:
    assert np.all(np.isfinite(_slower(PROBLEM, np.array([7]), np.ones((1, 3)))))
