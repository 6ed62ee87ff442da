"""A narrower band must predict better by a factor of three, once more for each name lost, and for what layers lose."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lagnet.diagnosis.reruns import band
from lagnet.diagnosis.reruns.puzzles import fewer_names


def state(names: int, ambiguous: int = 0) -> Any:
    fit = SimpleNamespace(bandwidth=10.0)
    return SimpleNamespace(effects=("name",) * names, ambiguous=("cause",) * ambiguous, events=(), fit=fit)


@pytest.mark.parametrize(
    ("names", "factor", "layer", "taken"),
    [
        pytest.param(2, 2.9, 1.0, 0, id="little"),
        pytest.param(2, 3.1, 1.0, 1, id="enough"),
        pytest.param(1, 8.9, 1.0, 0, id="a name less"),
        pytest.param(1, 9.1, 1.0, 1, id="a name less, paid for"),
        pytest.param(3, 3.1, 1.0, 1, id="a name more"),
        pytest.param(2, 6.1, 2.0, 1, id="loss of layers outweighed"),
        pytest.param(2, 5.9, 2.0, 0, id="loss of layers"),
        pytest.param(2, 2.9, 0.1, 0, id="gain of layers alone"),
    ],
)
def test_what_is_lost_is_paid_for(monkeypatch: pytest.MonkeyPatch, names, factor, layer, taken) -> None:
    first, second = state(2), state(names)
    for name, answer in (("against_given", first), ("is_puzzled", True), ("is_identified", False)):
        monkeypatch.setattr(band, name, lambda _, answer=answer: answer)
    monkeypatch.setattr(band, "_narrower", lambda *_: [second])
    monkeypatch.setattr(band, "_error", lambda one, *_: -np.log(factor) if one is second else 0.0)
    monkeypatch.setattr(band, "_error_of_layer", lambda one, *_: np.log(layer) if one is second else 0.0)
    assert band.best_band(first, lambda _: second) is (first, second)[taken]


def test_an_ambiguous_cause_is_no_lost_name() -> None:
    assert fewer_names(state(1, ambiguous=1), state(2)) == 0
    assert fewer_names(state(1), state(2)) == 1
    assert fewer_names(state(3), state(2)) == 0
