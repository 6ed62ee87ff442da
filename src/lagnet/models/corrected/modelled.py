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
COUNTERPARTS = {
    "viscous_friction": ("Fv", "viscous"),
    "coulomb_friction": ("Fc", "dry"),
    "presliding_hysteresis": ("Fc", "dry"),
    "load_dependent_friction": ("K", "load"),
    "rotor_inertia": ("Ia", "rotor"),
    "torque_offset": ("b", "offset"),
}
"""By effect, its parameter that is the weight of a function of the identified layer, and the kind of that function."""


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
    _, kind = COUNTERPARTS.get(effect, ("", ""))
    while isinstance(nominal, CorrectedModel):
        for name, parameter in WEIGHTS[effect]:
            same = (e for e in nominal.acting if (e.effect, e.joint) == (name, joint))
            yield from (e.values[parameter] for e in same if e.interval is None and e.recording is None)
        if nominal.layer is not None:
            yield from (weight for _, weight in nominal.layer.of_kind(kind, joint))
        nominal = nominal.nominal
    armature = getattr(nominal, "armature", None)
    if effect == "rotor_inertia" and armature is not None:
        yield float(armature[joint])
