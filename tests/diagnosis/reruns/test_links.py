"""Names beside free links are taken where nothing puzzles any more, or for a third of the error and no name less."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lagnet.diagnosis.free_bodies import BETTER
from lagnet.diagnosis.reruns import links, puzzles


def state(names: int, error: float, puzzling: bool) -> Any:
    problem = SimpleNamespace(given=None, nominal=None)
    return SimpleNamespace(
        problem=problem,
        effects=(SimpleNamespace(effect="coulomb_friction", joint=0),) * names,
        refit=SimpleNamespace(effects=()),
        ambiguous=(),
        rejected=(),
        noise=None,
        identified_alone=None,
        puzzling=puzzling,
        after=error,
    )


@pytest.mark.parametrize(
    ("puzzling", "still", "names", "factor", "taken"),
    [
        pytest.param(True, False, 1, 1.0, True, id="puzzle solved, whatever else"),
        pytest.param(True, True, 2, 1.1 * np.exp(BETTER), True, id="puzzle left, a third of the error"),
        pytest.param(True, True, 2, 0.9 * np.exp(BETTER), False, id="puzzle left, little gained"),
        pytest.param(True, True, 1, 9.0 * np.exp(BETTER), False, id="puzzle left, a name less"),
        pytest.param(False, False, 2, 1.1 * np.exp(BETTER), True, id="no puzzle, a third of the error"),
        pytest.param(False, False, 1, 9.0 * np.exp(BETTER), False, id="no puzzle, a name less"),
    ],
)
def test_a_run_beside_free_links_is_taken(monkeypatch, puzzling, still, names, factor, taken) -> None:
    first, second = state(2, 0.0, puzzling), state(names, -np.log(factor), still)
    for name in ("is_identified", "is_outdone", "has_mass"):
        monkeypatch.setattr(links, name, lambda _: True)
    monkeypatch.setattr(links, "is_puzzled", lambda one: one.puzzling)
    monkeypatch.setattr(links, "beside_free_bodies", lambda *_: "free")
    monkeypatch.setattr(links, "settle_transients", lambda one, _: one)
    monkeypatch.setattr(links, "against_given", lambda one: one)
    monkeypatch.setattr(puzzles, "log_error", lambda error, _: error)
    assert links._beside_free_links(first, lambda _: second) is (second if taken else None)
