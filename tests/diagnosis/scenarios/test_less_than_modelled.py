"""An arm that rubs less than the model calibrated on it, as after warming up: the difference is named with its sign."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.free_bodies import with_changed_bodies
from lagnet.models.corrected.folder import load_corrected, save_corrected
from lagnet.models.files.loading import load_any

VISCOUS, DRY = 0.8, 0.6  # [N m s/rad], [N m]
SHARP = 1e-3  # [rad/s]


def friction(share: float):
    return lambda q, v, a, body: share * (VISCOUS * v + DRY * np.tanh(v / SHARP))


@pytest.fixture(scope="module")
def calibrated(plant, arm):
    real = plant(friction(1.0))
    return diagnose([real.record(1), real.record(2)], arm, [real.record(3)]).corrected


@pytest.mark.parametrize("share", [0.7, 1.3])
def test_friction_that_fell_or_rose_is_named_as_the_difference(plant, arm, calibrated, share) -> None:
    real = plant(friction(share))
    result = diagnose([real.record(4), real.record(5)], calibrated, [real.record(6)])
    laws = ("coulomb_friction", "viscous_friction")
    assert {(e.effect, e.joint) for e in result.effects} == {(name, joint) for name in laws for joint in arm.joints}
    for effect in result.effects:
        name, size = ("Fc", DRY) if effect.effect == "coulomb_friction" else ("Fv", VISCOUS)
        assert effect.value(name) == pytest.approx((share - 1.0) * size, rel=0.03)
        assert ("less than modelled" in effect.explanation) == (share < 1.0)
    assert all(f.nmse_named < 0.01 * f.nmse_nominal for f in result.verdict.fit)


def test_the_difference_is_kept_in_a_folder(plant, calibrated, tmp_path) -> None:
    real = plant(friction(0.7))
    result = diagnose([real.record(4), real.record(5)], calibrated, [real.record(6)])
    again = load_corrected(save_corrected(result.corrected, tmp_path / "corrected"), load_any)
    assert {(e.effect, e.joint): e.values for e in again.effects} == {
        (e.effect, e.joint): e.values for e in result.corrected.effects
    }


def test_friction_that_no_model_holds_is_never_negative(plant, arm, at) -> None:
    real = plant(at(1, lambda q, v, a, body: -0.5 * v))
    result = diagnose([real.record(1), real.record(2)], arm, [real.record(3)])
    assert not [e for e in result.effects if e.effect == "viscous_friction"]


def test_changed_links_of_a_corrected_model_leave_its_friction(calibrated) -> None:
    change = 0.1 * calibrated.inertial_parameters()
    changed = with_changed_bodies(calibrated, change)
    np.testing.assert_allclose(changed.inertial_parameters(), calibrated.inertial_parameters() + change)
    q, v, a = np.zeros((1, 3)), np.full((1, 3), 0.5), np.zeros((1, 3))
    np.testing.assert_allclose(
        changed.residual_torque(q, v, a), calibrated.residual_torque(q, v, a), rtol=1e-6, atol=1e-9
    )
