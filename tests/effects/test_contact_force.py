"""A contact is named where its force is known and its point lies on the arm."""

from __future__ import annotations

from lagnet.effects.catalogue import effect_named
from lagnet.effects.external.contact_force import FARTHEST, FORCE, POINT

PUSH = {"Fx": (-0.4, 0.6), "Fy": (3.8, 4.4), "Fz": (-1.0, 1.0)}
AT = {"px": (-0.01, 0.03), "py": (0.0, 0.02), "pz": (0.08, 0.12)}


def determined(**changed: tuple[float, float]) -> bool:
    return effect_named("contact_force").is_determined({**PUSH, **AT, "t0": (2.0, 2.1), "t1": (3.0, 3.1)} | changed)


def test_one_component_that_is_not_zero_is_a_push() -> None:
    assert determined()
    assert set(PUSH) == set(FORCE)
    assert set(AT) == set(POINT)


def test_a_force_that_may_be_none_is_no_push() -> None:
    assert not determined(Fy=(-1.0, 9.2))


def test_a_point_at_the_edge_of_what_is_asked_is_no_push() -> None:
    assert not determined(pz=(-FARTHEST - 2.0, -FARTHEST + 2.0))
