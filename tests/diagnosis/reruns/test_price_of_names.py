"""A narrower band with fewer names must predict better by a factor of three for each that is lost, and one more."""

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
    ("names", "factor", "taken"), [(2, 2.9, 0), (2, 3.1, 1), (1, 8.9, 0), (1, 9.1, 1), (3, 3.1, 1)]
)
def test_each_name_that_is_lost_is_paid_for(monkeypatch: pytest.MonkeyPatch, names, factor, taken) -> None:
    first, second = state(2), state(names)
    for name, answer in (("against_given", first), ("is_puzzled", True), ("is_identified", False)):
        monkeypatch.setattr(band, name, lambda _, answer=answer: answer)
    monkeypatch.setattr(band, "_narrower", lambda *_: [second])
    monkeypatch.setattr(band, "_error", lambda one, *_: -np.log(factor) if one is second else 0.0)
    assert band.best_band(first, lambda _: second) is (first, second)[taken]


def test_an_ambiguous_cause_is_no_lost_name() -> None:
    assert fewer_names(state(1, ambiguous=1), state(2)) == 0
    assert fewer_names(state(1), state(2)) == 1
    assert fewer_names(state(3), state(2)) == 0
