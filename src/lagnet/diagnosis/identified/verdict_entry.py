"""The `identified` entry of a verdict: combinations of inertial parameters, friction curves, and sentences."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from lagnet.diagnosis.identified.curves import curve_over_position, friction_curve
from lagnet.diagnosis.identified.dictionary import GAIN
from lagnet.diagnosis.identified.fit import NORMAL_95, Identified
from lagnet.models.corrected.motion_terms import OVER_POSITION
from lagnet.rigid_body.base_parameters import BaseParameters, base_parameters

NOTABLE = 0.02  # of a joint's torque: a smaller change is not reported
NAMED_OPEN = 3  # undetermined combinations that a sentence names, each by its first parameter
UNITS = ("kg", *("kg m",) * 3, *("kg m²",) * 6)


def identified_as_json(
    found: Identified | None, robot: Any, joints: Sequence[str], instead: bool = False
) -> dict[str, Any]:
    """Parameters that the recordings determine beside the named physics, whatever their cause.

    Args:
        found: the layer with its equations; None where there is none.
        robot: the model whose bodies are changed.
        joints: names.
        instead: whether it stands in the place of the named effects.

    Returns:
        `bodies` (combinations of inertial parameters that differ from the model, with 95 % intervals), `undetermined`
        (combinations that the motion does not excite), `joints` (friction curve, rotor and offset of each), `ties`,
        `samples_that_count_as_one` and `words`.
    """
    if found is None:
        return {"bodies": [], "undetermined": [], "joints": [], "ties": [], "words": NOTHING}
    bodies, undetermined = _bodies(found, robot) if found.design.n_bodies else ([], [])
    own = [entry for j, name in enumerate(joints) if (entry := _joint(found, j, name))]
    ties = _ties(found, joints)
    words = _words(bodies, undetermined, own, ties, _late(found, joints))
    words = f"{INSTEAD} {words.replace(BESIDE, '')}" if instead else words
    entry = {"bodies": bodies, "undetermined": undetermined, "joints": own, "ties": ties}
    return {**entry, "samples_that_count_as_one": found.choice.inefficiency, "words": words}


INSTEAD = (
    "Unseen motion is predicted better where the values of named friction, rotors, offsets, gains and links are not "
    "held fixed: in the identified layer and the full correction this layer stands in their place. The names stay "
    "claims, judged by themselves."
)
BESIDE = " beside the named physics"
ALONG = {
    "A torque that depends on position acts at": ("position",),
    "Friction changes over the range of": ("viscous_path", "dry_path"),
}
NOTHING = "Beside the named physics the recordings determine nothing that would predict unseen motion better."


def _bodies(found: Identified, robot: Any) -> tuple[list[dict[str, Any]], list[str]]:
    """Base parameters that differ, largest torque first, and those that the motion does not excite."""
    base: BaseParameters = base_parameters(robot)
    scale = found.design.scale[: found.design.n_bodies]
    per_unit = np.where(scale > 0, 1.0 / np.where(scale > 0, scale, 1.0), 0.0)
    inner = found.choice.ridge.covariance[: scale.size, : scale.size] * per_unit[:, None] * per_unit
    change = base.of(np.zeros((scale.size // 10, 10)) if found.layer.bodies is None else found.layer.bodies)
    spread = np.sqrt(np.maximum(np.einsum("ri,ij,rj->r", base.combinations, inner, base.combinations), 0.0))
    weight = scale[base.independent]  # torque per unit, over the torque of the joint where it is largest
    words = base.describe()
    determined = [
        {
            "combination": words[k],
            "link": base.joints[int(base.independent[k]) // 10],
            "change": float(change[k]),
            "unit": UNITS[int(base.independent[k]) % 10],
            "ci95": [float(change[k] - NORMAL_95 * spread[k]), float(change[k] + NORMAL_95 * spread[k])],
            "share_of_torque": float(abs(change[k]) * weight[k]),
        }
        for k in np.argsort(-np.abs(change) * weight)
        if abs(change[k]) > NORMAL_95 * spread[k] and abs(change[k]) * weight[k] > NOTABLE
    ]
    return determined, [words[k] for k in np.flatnonzero(weight <= 0)]


def _joint(found: Identified, joint: int, name: str) -> dict[str, Any] | None:
    """Friction curve over speed at no load, rotor and offset of one joint, with the interval of each weight."""
    own = [(i, t) for i, t in enumerate(found.layer.terms) if t.joint == joint and t.other is None]
    entries = []
    for i, term in own:
        weight, half = float(found.layer.weights[i]), found.half_width(term)
        if weight:
            about = {"centre": term.centre} if term.kind in OVER_POSITION else {}
            ends = [weight - half, weight + half]
            entries.append({"term": term.kind, "scale": term.scale, **about, "weight": weight, "ci95": ends})
    if not any(e["weight"] for e in entries):
        return None
    curves = {"friction_curve": friction_curve(found, joint), "curve_over_position": curve_over_position(found, joint)}
    return {"joint": name, "terms": entries, **{key: curve for key, curve in curves.items() if curve is not None}}


def _late(found: Identified, joints: Sequence[str]) -> list[str]:
    """Joints with a notable torque in phase with −a."""
    first = found.design.n_bodies
    pairs = [(first + i, t) for i, t in enumerate(found.design.terms) if t.kind == "lag"]
    return [joints[t.joint] for i, t in pairs if abs(found.choice.ridge.x[i]) > NOTABLE]


def _ties(found: Identified, joints: Sequence[str]) -> list[dict[str, Any]]:
    pairs = zip(found.layer.terms, found.layer.weights, strict=True)
    return [
        {"joints": [joints[t.joint], joints[t.other]], "term": t.kind, "weight": float(w)}
        for t, w in pairs
        if t.other is not None and w
    ]


def _words(bodies: list, undetermined: list, own: list, ties: list, late: list[str]) -> str:
    """The layer in plain English."""
    parts = []
    links = list(dict.fromkeys(b["link"] for b in bodies))
    if links:
        parts.append(f"The inertia of the links behind {_listed(links)} differs from the model's.")
        parts.append(f"{len(bodies)} combinations of inertial parameters are determined and differ.")
    if own:
        parts.append(f"Friction, rotor or offset{BESIDE} at {_listed([e['joint'] for e in own])}.")
    scaled = [e["joint"] for e in own if any(t["term"] == GAIN for t in e["terms"])]
    if scaled:
        parts.append(f"Against other joints, recorded torque of the bodies has another scale at {_listed(scaled)}.")
    for words, whats in ALONG.items():
        there = [e["joint"] for e in own if any(OVER_POSITION.get(t["term"], ("",))[0] in whats for t in e["terms"])]
        parts += [f"{words} {_listed(there)}."] if there else []
    if late:
        parts.append(f"At {_listed(late)} torque lags behind the motion: a part of it is in phase with −a.")
    if ties:
        tied = list(dict.fromkeys(" and ".join(t["joints"]) for t in ties))
        parts.append(f"The motors of {_listed(tied)} are coupled.")
    if undetermined:
        more = ", ".join(text.split(" ")[0] for text in undetermined[:NAMED_OPEN])
        rest = f" and {len(undetermined) - NAMED_OPEN} more" if len(undetermined) > NAMED_OPEN else ""
        parts.append(
            f"This motion says nothing of {more}{rest}, alone or combined: faster motion of all joints at once would."
        )
    return " ".join(parts) or NOTHING


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
