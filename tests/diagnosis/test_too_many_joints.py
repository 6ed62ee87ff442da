"""A model of more joints than memory allows is refused before anything is computed."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import MOST_JOINTS, diagnose
from lagnet.errors import DiagnosisError


def test_more_joints_than_a_diagnosis_can_hold_are_refused() -> None:
    n = MOST_JOINTS + 1
    robot = SimpleNamespace(n_dof=n, joints=tuple(f"j{i}" for i in range(n)))
    recording = SimpleNamespace(n_dof=n, path="", tau=np.zeros((10, n)))
    with pytest.raises(DiagnosisError, match="65 joints; 64 at most"):
        diagnose([recording], robot)  # type: ignore[arg-type]
