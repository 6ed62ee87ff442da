"""A load that is mounted differently in two recordings is told in each; one that is mounted alike is one load."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import diagnose

pytestmark = pytest.mark.slow

MASS = 1.5  # [kg]
NEAR = 0.05  # relative error of a mass
CENTRES = np.array([[0.03, 0.0, 0.15], [0.03, 0.1, -0.12]])  # [m], in the frame of the last link
APART = 0.03  # [m] by which a centre may be off


def carrying(plant, arm, centre, seed: int):
    """A recording of the arm with the load, while its model has none."""
    loaded = arm.with_payload(MASS, centre, 0.004 * np.eye(3))

    def law(q, v, a, body):
        return loaded.inverse_dynamics(q, v, a) - arm.inverse_dynamics(q, v, a)

    return plant(law).record(seed)


@pytest.fixture(scope="module")
def differing(plant, arm):
    return diagnose([carrying(plant, arm, c, seed) for seed, c in zip((11, 12), CENTRES, strict=True)], arm)


def test_each_recording_has_its_load(differing, names) -> None:
    assert names(differing) == {("payload", None)}
    assert len(differing.effects) == 2
    for effect in differing.effects:
        index = int(effect.recording.rsplit(" ", 1)[1]) - 1
        assert effect.value("m") == pytest.approx(MASS, rel=NEAR)
        centre = [effect.value(name) for name in ("cx", "cy", "cz")]
        np.testing.assert_allclose(centre, CENTRES[index], atol=APART)
        assert "throughout recording" in effect.explanation


def test_the_difference_is_told_and_the_held_out_ends_are_predicted(differing) -> None:
    assert any("recordings differ from each other" in line for line in differing.verdict.warnings)
    assert all(fit.nmse_named < 0.01 * max(fit.nmse_nominal, 0.05) for fit in differing.verdict.fit)


def test_a_load_that_is_mounted_alike_is_one(plant, arm, names) -> None:
    result = diagnose([carrying(plant, arm, CENTRES[0], seed) for seed in (13, 14)], arm)
    assert names(result) == {("payload", None)}
    assert [e.interval_s for e in result.effects] == [None]
    assert not any("differ" in line for line in result.verdict.warnings)


def test_a_held_out_recording_that_contradicts_the_fitted_one_is_told(plant, arm) -> None:
    fitted, other = (carrying(plant, arm, c, seed) for seed, c in zip((15, 16), CENTRES, strict=True))
    result = diagnose([fitted], arm, [other])
    assert any("differs from the fitted recordings from beginning to end" in line for line in result.verdict.warnings)
