"""The learned remainder as plain JSON values, and back; nothing in them is trusted."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from lagnet.models.corrected.layer_files import numbers_of
from lagnet.models.corrected.remainder.learned import LearnedRemainder, RemainderPart
from lagnet.models.corrected.remainder.network import OWN, NetworkRemainder
from lagnet.models.corrected.remainder.process import ProcessRemainder

NETWORK, PROCESS = "networks", "gaussian_process"
MOST_PARTS = 10


def remainder_as_json(learned: LearnedRemainder | None) -> dict[str, Any] | None:
    """Plain values of a learned remainder; None for none."""
    if learned is None:
        return None
    return {"slow": learned.slow.tolist(), "parts": [_part_as_json(part) for part in learned.parts]}


def remainder_from_json(entry: Any, n_dof: int) -> LearnedRemainder | None:
    """A learned remainder from plain values.

    Raises:
        ValueError, TypeError, KeyError: values that are no remainder of an arm of so many joints.
    """
    if entry is None:
        return None
    if "parts" not in entry:
        raise ValueError(
            "its learned remainder is of an earlier version; the other layers load with layers='identified'"
        )
    if not 1 <= len(entry["parts"]) <= MOST_PARTS:
        raise ValueError(f"a learned remainder has 1 to {MOST_PARTS} parts, not {len(entry['parts'])}")
    readers = {NETWORK: _network, PROCESS: _process}
    parts = tuple(readers[part["kind"]](part, n_dof) for part in entry["parts"])
    return LearnedRemainder(parts, _positive(entry["slow"], (n_dof,)))


def _part_as_json(part: RemainderPart) -> dict[str, Any]:
    kind = NETWORK if isinstance(part, NetworkRemainder) else PROCESS
    return {"kind": kind, **{name: _as_list(array) for name, array in vars(part).items()}}


def _as_list(value: np.ndarray | tuple[np.ndarray, ...]) -> list:
    return [layer.tolist() for layer in value] if isinstance(value, tuple) else value.tolist()


def _network(entry: dict[str, Any], n_dof: int) -> NetworkRemainder:
    n = 2 * n_dof + OWN
    biases = [np.array(b, dtype=float) for b in entry["biases"]]
    if not all(b.ndim == 3 for b in biases) or not entry["anchors"]:
        raise ValueError("the networks of the learned remainder lack biases or anchors")
    members, sizes = len(biases[0]), [n, *(b.shape[2] for b in biases)]
    layers = [numbers_of(w, (members, n_dof, *s)) for w, s in zip(entry["weights"], pairwise(sizes), strict=True)]
    biases = [numbers_of(b, (members, n_dof, m)) for b, m in zip(biases, sizes[1:], strict=True)]
    if sizes[-1] != 1:
        raise ValueError("a network of the learned remainder has more than one output")
    anchors = numbers_of(entry["anchors"], (n_dof, len(entry["anchors"][0]), n))
    centre, share = numbers_of(entry["centre"], (n_dof, n)), numbers_of(entry["share"], (n_dof,))
    spread, reach, slow = (
        _positive(entry[k], s) for k, s in (("spread", (n_dof, n)), ("reach", (n_dof,)), ("slow", (n_dof,)))
    )
    return NetworkRemainder(centre, spread, tuple(layers), tuple(biases), share, anchors, reach, slow)


def _process(entry: dict[str, Any], n_dof: int) -> ProcessRemainder:
    n, m = 4 * n_dof, len(entry["anchors"])
    centre, anchors = numbers_of(entry["centre"], (n,)), numbers_of(entry["anchors"], (m, n))
    counted, weights = numbers_of(entry["counted"], (m, n_dof)) > 0.0, numbers_of(entry["weights"], (m, n_dof))
    length, noise = _positive(entry["length"], (n_dof,)), _positive(entry["noise"], (n_dof,))
    share = numbers_of(entry["share"], (n_dof,))
    if not np.all(counted.any(axis=0) | (share == 0.0)):
        raise ValueError("the Gaussian process has a joint without a sample")
    return ProcessRemainder(centre, _positive(entry["spread"], (n,)), anchors, counted, weights, length, noise, share)


def _positive(entry: Any, shape: tuple[int, ...]) -> np.ndarray:
    values = numbers_of(entry, shape)
    if not np.all(values > 0.0):
        raise ValueError("a width of the learned remainder is not above zero")
    return values
