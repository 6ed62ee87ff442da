"""Intervals know of the usual laws of a joint that were not selected."""

from __future__ import annotations

import numpy as np
from tests.diagnosis.posed import pose

from lagnet.diagnosis.estimation.intervals.unselected_laws import (
    USUAL,
    shifts_beside_unselected,
    short_of_absence,
    unselected_laws,
)
from lagnet.diagnosis.estimation.refit import refit
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import NamedEffect

JOINT = 1
COULOMB = NamedEffect("coulomb_friction", JOINT, {"Fc": 4.0})
VISCOUS = NamedEffect("viscous_friction", JOINT, {"Fv": 2.0})


def interval(posed, *effects: NamedEffect) -> tuple[float, float]:
    """The widened interval of the first parameter of the first effect."""
    found = refit(posed.problem, effects, posed.noise)
    shifts = shifts_beside_unselected(posed.problem, found.effects, posed.noise)
    return next(iter(short_of_absence(found.effects[0], found.intervals[0], shifts[0]).values()))


def test_an_interval_holds_the_truth_where_a_companion_law_has_no_name(plant, arm, at) -> None:
    real = plant(at(JOINT, lambda q, v, a, t: 3.0 * np.tanh(v / 0.01) + 2.0 * v))
    posed = pose(arm, real.record(1), real.record(2))
    low, high = interval(posed, COULOMB)
    assert low < 3.0 < high
    with_both = interval(posed, COULOMB, VISCOUS)
    assert high - low > 3.0 * (with_both[1] - with_both[0])


def test_an_interval_hardly_widens_where_there_is_no_companion(plant, arm, at) -> None:
    real = plant(at(JOINT, lambda q, v, a, t: 3.0 * np.tanh(v / 0.01)))
    posed = pose(arm, real.record(1), real.record(2))
    alone, both = interval(posed, COULOMB), interval(posed, COULOMB, VISCOUS)
    assert alone[1] - alone[0] < 2.0 * (both[1] - both[0])


def test_laws_that_are_named_or_held_by_one_that_is_are_left_out(plant, arm, at) -> None:
    posed = pose(arm, plant().record(1), plant().record(2))
    named = (NamedEffect("stribeck_friction", JOINT, {"Fc": 1.0, "Fs": 1.0, "vs": 0.1}), VISCOUS)
    tables = list(unselected_laws(posed.problem, posed.problem.fit, named, posed.noise))
    assert len(tables) == len(USUAL) - 2  # Coulomb friction is a part of Stribeck's law
    for table in tables:
        assert table[0].shape == (posed.problem.fit[0].keep.size, arm.n_dof, 1)
        assert np.any(table[0][:, JOINT])
        assert not np.any(np.delete(table[0], JOINT, axis=1))


def test_a_shift_leaves_the_absence_of_an_effect_outside() -> None:
    assert short_of_absence(COULOMB, {"Fc": (3.0, 5.0)}, {"Fc": 1.0})["Fc"] == (4.0 - 2**0.5, 4.0 + 2**0.5)
    low, high = short_of_absence(COULOMB, {"Fc": (3.0, 5.0)}, {"Fc": 40.0})["Fc"]
    assert 0.0 < low < 1.0
    assert 7.0 < high < 8.0
    open_before = {"Fc": (-1.0, 9.0)}
    assert short_of_absence(COULOMB, open_before, {"Fc": 0.5}) == open_before  # the size alone is uncertain


def test_the_usual_laws_are_linear_and_of_one_joint() -> None:
    for law in map(effect_named, USUAL):
        assert len(law.free_parameters) == 1
        assert not law.reaches_all
