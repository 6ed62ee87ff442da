"""Parameters that effects share: one for itself comes first, and a group keeps those that nobody else has."""

from __future__ import annotations

from types import SimpleNamespace

from lagnet.diagnosis.motion.joint.refitting import groups_of


def test_a_group_keeps_what_no_other_has():
    case = SimpleNamespace(base=())
    groups = groups_of(case, ("gear_friction", "directional_load_friction"))
    assert set(groups) == {("load_motor",), ("load_driving",), ("load_driven",)}


def test_the_same_parameter_is_free_once():
    case = SimpleNamespace(base=(("kp",),))
    assert groups_of(case, ("static_friction", "coulomb_friction")).count(("coulomb",)) == 1
