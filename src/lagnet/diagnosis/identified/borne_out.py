"""w ± σ of φ(q, v, a) beside all links and all other functions: named effects that the identified layer bears out.

Friction, rotors and offsets are functions of the layer, too, estimated there together with whatever else the recordings
determine. An effect whose function keeps its weight in such company does not stand for a part of something else. One
that changes along the range of its joint, by more than a tenth of its power, is not the law of that name.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.identified.curves import curve_over_position
from lagnet.diagnosis.identified.fit import Identified
from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.diagnosis.problem.residuals import stacked
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.modelled import COUNTERPARTS
from lagnet.models.corrected.named_effects import NamedEffect

ALIKE = 0.5  # of an effect's value, within which the weight may differ from it
VARIES = 0.1  # variance over the range of a joint over the squared mean: beyond, one value is not its law


def is_borne_out(found: Identified, effect: NamedEffect) -> bool:
    """Whether the function of an effect is determined in the layer, |w| > 1.96 σ, and differs from it by half at most.

    No friction pushes: beside dry friction that would, a curve over speed is not the sum of its named parts. Only where
    the nominal model has friction may the arm have less.
    """
    if effect.effect not in COUNTERPARTS or effect.joint is None or effect.interval is not None:
        return False
    parameter, kind = COUNTERPARTS[effect.effect]
    weight, half = _weight(found, kind, effect.joint)
    value = effect.values[parameter]
    dry, dry_half = _weight(found, "dry", effect.joint)
    pushes = dry < -dry_half and not effect.modelled
    alike = abs(weight) > half and abs(weight - value) <= ALIKE * abs(value)
    return alike and not pushes and not _changes_along_the_range(found, kind, effect.joint)


def _changes_along_the_range(found: Identified, kind: str, joint: int) -> bool:
    """Whether one value explains less than ten times what friction, or a torque of position, differs from it."""
    curve = curve_over_position(found, joint)
    if curve is None:
        return False
    told = np.asarray(curve["torque" if kind == "offset" else "friction"])
    return bool(np.var(told) > VARIES * np.mean(told) ** 2)


def _weight(found: Identified, kind: str, joint: int) -> tuple[float, float]:
    """Weight of the function of a kind at a joint, and half of its 95 % interval; 0 where the layer has none."""
    return next(((w, found.half_width(term)) for term, w in found.layer.of_kind(kind, joint)), (0.0, 0.0))


def powers_beside(
    problem: Problem, pieces: Sequence[Segment], effects: Sequence[NamedEffect], layer: IdentifiedLayer
) -> tuple[np.ndarray, np.ndarray]:
    """mean r² of the nominal model, and of it with effects and an identified layer, each of shape (dof,) [N² m²]."""
    model = CorrectedModel(
        problem.nominal, tuple(effects), problem.slow, problem.held, problem.straight, identified=layer
    )
    rest = [
        problem.reduce(p, p.tau - replace(model, recording=p.origin).torque_along(p.time, p.q, p.v, p.a))
        for p in pieces
    ]
    nominal, valid = stacked(problem, pieces)
    count = np.maximum(1, valid.sum(axis=0))
    before, after = (np.sum((r * valid) ** 2, axis=0) / count for r in (nominal, np.concatenate(rest)))
    return before, after
