"""A few seconds of motion: what they show has a name, with an interval that holds the truth."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import diagnose

SECONDS, BAND = 5.0, 4.0  # twenty periods of the band: not two blocks of the usual twelve
DRY, VISCOUS = 2.0, 1.0  # [N m], [N m s/rad]


def test_friction_of_all_joints_shows_in_five_seconds(plant, arm, names) -> None:
    real = plant(lambda q, v, a, tau: DRY * np.tanh(v / 0.01) + VISCOUS * v)
    found = diagnose([real.record(1, seconds=SECONDS)], arm, [real.record(2)], bandwidth=BAND)
    frictions = ("coulomb_friction", "viscous_friction")
    assert names(found) == {(effect, joint) for effect in frictions for joint in arm.joints}
    for effect, parameter, truth in zip(frictions, ("Fc", "Fv"), (DRY, VISCOUS), strict=True):
        for one in (e for e in found.effects if e.effect == effect):
            assert one.value(parameter) == pytest.approx(truth, rel=0.1)


def test_five_seconds_of_a_perfect_model_show_nothing(plant, arm) -> None:
    assert not diagnose([plant().record(1, seconds=SECONDS)], arm, [plant().record(2)], bandwidth=BAND).effects
