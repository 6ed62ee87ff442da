"""What a run leaves unexplained: whether it is enough for another one."""

from __future__ import annotations

from collections.abc import Sequence

from lagnet.diagnosis.free_bodies import BETTER, explains, log_error
from lagnet.diagnosis.identified.borne_out import powers_beside
from lagnet.diagnosis.identified.fit import Identified
from lagnet.diagnosis.state import DiagnosisState
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import NamedEffect

PUZZLING = 0.3  # of a joint's mismatch: if so much is unexplained, narrower bands are tried
MUCH = 0.05  # of a joint's mismatch: if names leave so much, links that differ may explain it
OUTDONE = 3.0  # times the error beside the links and functions of motion that the recordings determine
CLEARLY = 2.0  # times the noise that it must exceed


def is_puzzled(state: DiagnosisState, much: float = PUZZLING) -> bool:
    """Whether some joint has a large residual share, clearly above the noise; an ambiguous cause is no puzzle."""
    limits = (CLEARLY * state.noise) ** 2
    left = zip(state.sizes_beside_supposed, limits, strict=True)
    return any(joint.above and joint.share > much and joint.power > limit for joint, limit in left)


def is_outdone(state: DiagnosisState) -> bool:
    """Whether the identified layer leaves less than a third of what names leave at a joint where that is much.

    Not beside a body that has a name: a load says more than links that differ.
    """
    if any(effect_named(e.effect).is_body for e in state.effects):
        return False
    sizes = state.sizes_beside_supposed
    much = [j for j, joint in enumerate(sizes) if joint.above and joint.share > MUCH]
    found = state.identified if much else None
    if found is None:
        return False
    _, after = powers_beside(state.problem, state.problem.holdout, state.effects, found.layer)
    return any(after[j] < sizes[j].power / OUTDONE for j in much)


def is_identified(state: DiagnosisState) -> bool:
    """Whether bodies and functions of motion without a name explain what is left: then nothing drowns what holds.

    Beside the names, or in their place: a wrong name leaves to the layer what it is not.
    """
    return _explains(state, state.effects, state.identified) or _explains(state, (), state.identified_alone)


def _explains(state: DiagnosisState, effects: Sequence[NamedEffect], found: Identified | None) -> bool:
    """Whether effects and the layer beside them explain the held-out recordings."""
    return found is not None and explains(state.problem, state.problem.holdout, effects, found.layer, state.noise)


def fewer_names(second: DiagnosisState, first: DiagnosisState) -> int:
    """How many causes another run has less: what one joint gains is no reason to forget others."""
    second_has, first_has = (len(one.effects) + len(one.ambiguous) for one in (second, first))
    return max(0, first_has - second_has)


def predicts_better(second: DiagnosisState, first: DiagnosisState) -> bool:
    """Whether another run leaves a third of the error on held-out motion, all joints together."""
    before, after = (log_error(one.after, one.noise) for one in (first, second))
    return bool(after < before - BETTER)
