"""The predictable share: what of a residual can be predicted, from what, and what cannot."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.unexplained.predictability import Examples, predictability_of, signals_of


@pytest.fixture(scope="module")
def signals(plant, arm):
    problem = pose(arm, plant().record(91), plant().record(92)).problem
    return signals_of(problem, problem.fit), signals_of(problem, problem.holdout)


def column(signals, name):
    return signals.table[:, signals.names.index(name)]


def asked(signals, seen: np.ndarray, unseen: np.ndarray, joint: int):
    """The predictable share where all samples count."""
    examples = Examples(joint, signals[0], seen, np.ones(seen.size, dtype=bool), signals[1], unseen)
    return predictability_of(examples, 0)


def test_a_residual_of_two_joints_speeds_is_predicted_from_them(signals) -> None:
    residuals = [np.sign(column(s, "v_0")) + np.tanh(column(s, "v_2")) for s in signals]
    found = asked(signals, residuals[0], residuals[1], joint=0)
    assert found.share > 0.6
    assert set(found.depends_on[:2]) <= {"v_0", "v_2", "history_0", "history_2"}


def test_noise_is_not_predicted(signals) -> None:
    rng = np.random.default_rng(1)
    seen, unseen = (rng.standard_normal(len(s.table)) for s in signals)
    found = asked(signals, seen, unseen, joint=0)
    assert found.share < 0.05
    assert found.depends_on == ()


def test_samples_that_do_not_count_teach_nothing(signals) -> None:
    residuals = [column(s, "v_1") for s in signals]
    nothing = np.zeros(residuals[0].size, dtype=bool)
    examples = Examples(1, signals[0], residuals[0], nothing, signals[1], residuals[1])
    assert predictability_of(examples, 0).share == 0.0


def test_a_strut_that_rubs_is_predicted_from_its_own_joint(signals) -> None:
    """Trees that are given all signals learn a disturbance of the fitted motion by its time, and expect it again."""

    def rubbing(s) -> np.ndarray:
        push = (column(s, "q_1") - column(signals[0], "q_1").mean()) ** 2
        return push + 0.3 * push * np.tanh(column(s, "v_1") / 0.02)

    seen, unseen = map(rubbing, signals)
    time = column(signals[0], "time")
    disturbed = seen + seen.std() * np.sin(2.0 * np.pi * time / np.ptp(time))
    found = asked(signals, disturbed, unseen, joint=1)
    assert found.share > 0.7
    assert found.depends_on == ("q_1", "v_1")
