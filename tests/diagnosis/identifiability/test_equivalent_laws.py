"""Friction and what shifts it: which names are one law while the joint moves."""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.diagnose import diagnose


def uneven_beside_a_spring(plant, at):
    """Coulomb friction of 3 and 1 N m the two ways, and a spring at rest in the middle."""
    level = plant().usual_torque()[1]
    return plant(at(1, lambda q, v, a, load: level * (0.1 + 0.2 * np.tanh(v / 1e-3) + 0.5 * q)))


def test_uneven_friction_beside_a_spring_is_told_as_a_tie(plant, at) -> None:
    real = uneven_beside_a_spring(plant, at)
    result = diagnose([real.record(1), real.record(2)], real.robot, [real.record(3)])
    told = {e.effect: e for e in result.effects}
    assert set(told) == {"coulomb_friction", "joint_spring"}  # the spring takes the shift, which is one with its own
    assert told["coulomb_friction"].tied_with == ("asymmetric_friction",)
    assert not told["joint_spring"].tied_with


def test_friction_without_anything_that_shifts_it_is_no_tie(plant, at) -> None:
    level = plant().usual_torque()[1]
    real = plant(at(1, lambda q, v, a, load: 0.2 * level * np.tanh(v / 1e-3)))
    result = diagnose([real.record(1), real.record(2)], real.robot, [real.record(3)])
    assert [(e.effect, e.tied_with) for e in result.effects] == [("coulomb_friction", ())]
