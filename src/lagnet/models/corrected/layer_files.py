"""The identified layer as plain JSON values, and back; nothing in them is trusted."""

from __future__ import annotations

from typing import Any

import numpy as np

from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.motion_terms import KINDS, MotionTerm, Rest

REST = ("speed", "held")
MOST_TERMS = 10_000


def layer_as_json(layer: IdentifiedLayer | None) -> dict[str, Any] | None:
    """Plain values of a layer; None for none."""
    if layer is None:
        return None
    terms = [
        {"kind": t.kind, "joint": t.joint, "scale": t.scale, "other": t.other, "centre": t.centre, "weight": float(w)}
        for t, w in zip(layer.terms, layer.weights, strict=True)
    ]
    rest = {name: getattr(layer.rest, name).tolist() for name in REST}
    return {"bodies": None if layer.bodies is None else layer.bodies.tolist(), "terms": terms, "rest": rest}


def layer_from_json(entry: Any, n_dof: int) -> IdentifiedLayer | None:
    """A layer from plain values.

    Raises:
        ValueError, TypeError, KeyError: values that are no layer of an arm of so many joints.
    """
    if entry is None:
        return None
    if len(entry["terms"]) > MOST_TERMS:
        raise ValueError(f"{len(entry['terms'])} terms are more than any layer has")
    bodies = None if entry["bodies"] is None else numbers_of(entry["bodies"], (n_dof, 10))
    rest = Rest(*(numbers_of(entry["rest"][name], (n_dof,)) for name in REST))
    terms = tuple(_term(t, n_dof) for t in entry["terms"])
    weights = np.array([float(t["weight"]) for t in entry["terms"]])
    if not np.isfinite(weights).all():
        raise ValueError("a weight of the identified layer is not finite")
    return IdentifiedLayer(bodies, terms, weights, rest)


def numbers_of(entry: Any, shape: tuple[int, ...]) -> np.ndarray:
    """Finite numbers of that shape.

    Raises:
        ValueError, TypeError: anything else.
    """
    values = np.array(entry, dtype=float)
    if values.shape != shape or not np.isfinite(values).all():
        raise ValueError(f"the correction lacks an array of {shape} finite numbers")
    return values


def _term(entry: dict[str, Any], n_dof: int) -> MotionTerm:
    kind, joint, scale, other = str(entry["kind"]), int(entry["joint"]), float(entry["scale"]), entry["other"]
    other = None if other is None else int(other)
    centre = float(entry.get("centre", 0.0))  # format 4 has none
    known = kind in KINDS and 0 <= joint < n_dof and (other is None or 0 <= other < n_dof)
    if not known or not np.isfinite([scale, centre]).all() or scale <= 0.0:
        raise ValueError(f"{kind} at joint {joint} is no term of the identified layer")
    return MotionTerm(kind, joint, scale, other, centre)
