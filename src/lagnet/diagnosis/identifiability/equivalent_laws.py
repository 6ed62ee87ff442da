"""Observationally equivalent laws: Fc⁺[v>0] − Fc⁻[v<0] = Fc s(v) + b while a joint moves, so that no motion differs.

Likewise K |τ| s(v) + (g − 1) τ is friction per load of K + (g − 1) where the motor drives the load, and of K − (g − 1)
where the load drives the motor: a gain beside it may be a gear whose efficiency differs by the direction of power.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from lagnet.diagnosis.identifiability.rivals import Comparison
from lagnet.diagnosis.regression.library import Library
from lagnet.models.corrected.named_effects import NamedEffect

UNEVEN, EVEN, SHIFT, SPRING = "asymmetric_friction", "coulomb_friction", "torque_offset", "joint_spring"
PER_LOAD, GAIN = "load_dependent_friction", "torque_gain"
NONE = {"K": 0.0}


def observationally_equivalent(first: Iterable[str], second: Iterable[str]) -> bool:
    """Whether two explanations, given by their names, are the same law: Fc⁺ and Fc⁻ are Fc + b and Fc − b."""
    return {frozenset(first), frozenset(second)} == {frozenset({UNEVEN}), frozenset({EVEN, SHIFT})}


def tie_equivalent_laws(
    library: Library, comparisons: Sequence[Comparison], effects: Sequence[NamedEffect]
) -> tuple[Comparison, ...]:
    """The comparisons with ties between equivalent names, whatever the odds, which then depend on standstill alone.

    An offset or a gain larger than the friction has no equal: friction that pushes does not exist. Beside a spring,
    whose rest position is not known, the offset of uneven friction is one of the spring's.

    Args:
        library: of the hypotheses.
        comparisons: one for each named effect.
        effects: the named effects, refitted.
    """
    values = {(e.effect, e.joint): e.values for e in effects}

    def rivals(place: tuple[str, int | None]) -> set[str]:
        name, joint = place
        friction, offset = values.get((EVEN, joint)), values.get((SHIFT, joint))
        if name == UNEVEN:
            return {EVEN, SHIFT}
        if name in (EVEN, SHIFT) and friction and offset and abs(offset["b"]) <= friction["Fc"]:
            return {UNEVEN}
        if name == GAIN and abs(values[place]["g"] - 1.0) <= values.get((PER_LOAD, joint), NONE)["K"]:
            return {PER_LOAD}
        if name == EVEN and (SPRING, joint) in values:
            return {UNEVEN}
        return set()

    return tuple(
        replace(c, tied=tuple(sorted({*c.tied, *rivals(library.hypotheses[c.index].place)}))) for c in comparisons
    )
