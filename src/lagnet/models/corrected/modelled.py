"""w_k of Σ_k w_k f_k(q, v, a) in a corrected model: how much of a law it already holds, of which an arm may have less.

A model that was calibrated on an arm has the arm's friction of that day. After warming up, new grease or a repair the
arm rubs less, and what the model lacks is then a negative change of a positive parameter.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from lagnet.models.corrected.model import CorrectedModel

WEIGHTS: dict[str, tuple[tuple[str, str], ...]] = {
    "viscous_friction": (("viscous_friction", "Fv"),),
    "coulomb_friction": (("coulomb_friction", "Fc"), ("stribeck_friction", "Fc"), ("presliding_hysteresis", "Fc")),
    "quadratic_drag": (("quadratic_drag", "Fd"),),
    "load_dependent_friction": (("load_dependent_friction", "K"),),
    "rotor_inertia": (("rotor_inertia", "Ia"),),
}
"""By law that is a weight of one function: the laws, and their parameters, that hold such a weight."""
TERMS = {
    "viscous_friction": "viscous",
    "coulomb_friction": "dry",
    "load_dependent_friction": "load",
    "rotor_inertia": "rotor",
}
"""By law the kind of function of the identified layer that is the same."""


def modelled_weight(nominal: Any, effect: str, joint: int | None) -> float:
    """How much of a law's weight the nominal model holds at a joint, at least 0; 0 for a model that was not corrected.

    Args:
        nominal: any model.
        effect: name in the catalogue.
        joint: index.
    """
    if effect not in WEIGHTS or joint is None:
        return 0.0
    return max(0.0, sum(_weights(nominal, effect, joint)))


def _weights(nominal: Any, effect: str, joint: int) -> Iterator[float]:
    while isinstance(nominal, CorrectedModel):
        for name, parameter in WEIGHTS[effect]:
            same = (e for e in nominal.acting if (e.effect, e.joint) == (name, joint))
            yield from (e.values[parameter] for e in same if e.interval is None and e.recording is None)
        if nominal.layer is not None:
            yield from nominal.layer.weights_of(TERMS.get(effect, ""), joint)
        nominal = nominal.nominal
    armature = getattr(nominal, "armature", None)
    if effect == "rotor_inertia" and armature is not None:
        yield float(armature[joint])
