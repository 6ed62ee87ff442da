"""The identified layer as plain JSON values, and back; nothing in them is trusted."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.motion_terms import KINDS, MotionTerm, Rest
from lagnet.models.corrected.remainder import LearnedRemainder

REST = ("speed", "held")
MOST_TERMS = 10_000


def layer_as_json(layer: IdentifiedLayer | None) -> dict[str, Any] | None:
    """Plain values of a layer; None for none."""
    if layer is None:
        return None
    terms = [
        {"kind": t.kind, "joint": t.joint, "scale": t.scale, "other": t.other, "weight": float(w)}
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
    bodies = None if entry["bodies"] is None else _numbers(entry["bodies"], (n_dof, 10))
    rest = Rest(*(_numbers(entry["rest"][name], (n_dof,)) for name in REST))
    terms = tuple(_term(t, n_dof) for t in entry["terms"])
    weights = np.array([float(t["weight"]) for t in entry["terms"]])
    if not np.isfinite(weights).all():
        raise ValueError("a weight of the identified layer is not finite")
    return IdentifiedLayer(bodies, terms, weights, rest)


def remainder_as_json(learned: LearnedRemainder | None) -> dict[str, Any] | None:
    """Plain values of a learned remainder; None for none."""
    if learned is None:
        return None
    single = {name: getattr(learned, name).tolist() for name in ("centre", "spread", "share", "anchors")}
    layers = {name: [x.tolist() for x in getattr(learned, name)] for name in ("weights", "biases")}
    return {**single, **layers, "reach": learned.reach}


def remainder_from_json(entry: Any, n_dof: int) -> LearnedRemainder | None:
    """A learned remainder from plain values.

    Raises:
        ValueError, TypeError, KeyError: values that are no remainder of an arm of so many joints.
    """
    if entry is None:
        return None
    n = 4 * n_dof
    biases = [np.array(b, dtype=float) for b in entry["biases"]]
    members, sizes = len(biases[0]), [n, *(b.shape[1] for b in biases)]
    shapes = pairwise(sizes)
    weights = [_numbers(w, (members, *s)) for w, s in zip(entry["weights"], shapes, strict=True)]
    biases = [_numbers(b, (members, m)) for b, m in zip(biases, sizes[1:], strict=True)]
    centre, spread, share = (
        _numbers(entry[k], s) for k, s in (("centre", (n,)), ("spread", (n,)), ("share", (n_dof,)))
    )
    anchors, reach = _numbers(entry["anchors"], (len(entry["anchors"]), n)), float(entry["reach"])
    if sizes[-1] != n_dof or not reach > 0.0 or not np.all(spread > 0.0):
        raise ValueError("the learned remainder has other joints, or no reach")
    return LearnedRemainder(centre, spread, tuple(weights), tuple(biases), share, anchors, reach)


def _numbers(entry: Any, shape: tuple[int, ...]) -> np.ndarray:
    values = np.array(entry, dtype=float)
    if values.shape != shape or not np.isfinite(values).all():
        raise ValueError(f"the identified layer lacks an array of {shape} finite numbers")
    return values


def _term(entry: dict[str, Any], n_dof: int) -> MotionTerm:
    kind, joint, scale, other = str(entry["kind"]), int(entry["joint"]), float(entry["scale"]), entry["other"]
    other = None if other is None else int(other)
    known = kind in KINDS and 0 <= joint < n_dof and (other is None or 0 <= other < n_dof)
    if not known or not np.isfinite(scale) or scale <= 0.0:
        raise ValueError(f"{kind} at joint {joint} is no term of the identified layer")
    return MotionTerm(kind, joint, scale, other)
