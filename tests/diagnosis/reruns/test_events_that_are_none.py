"""Events that are none beside the names of a run without their samples leave its names, where these predict better."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lagnet.diagnosis.reruns import puzzles, transients
from lagnet.diagnosis.reruns.transients import settle_transients

EVENT = SimpleNamespace(gain=1.0, covers=lambda *_: False)


@dataclass(frozen=True)
class Posed:
    """A problem, of which only its samples matter here."""

    fit: str = "all"
    holdout: str = "held"
    slow: float = 0.0
    straight: None = None
    held: None = None
    bandwidth: float = 10.0


@dataclass(frozen=True)
class State:
    """A run of the pipeline, with its error on held-out samples."""

    after: float
    problem: Posed = field(default_factory=Posed)
    transients: tuple = ()
    events: tuple = ()
    lasting_effects: tuple = ()
    noise: float = 1.0
    fit: str = "all"


@pytest.mark.parametrize(("factor", "taken"), [(2.5, "first"), (3.5, "second")])
def test_the_better_prediction_stands(monkeypatch: pytest.MonkeyPatch, factor: float, taken: str) -> None:
    first: Any = State(0.0)
    second = State(-np.log(factor))
    scans = iter([SimpleNamespace(events=(EVENT,)), SimpleNamespace(events=())])
    masked = Posed(fit="masked")
    for name, answer in {
        "detect_events": lambda *_: next(scans),
        "too_much": lambda *_: False,
        "set_aside": lambda *_: masked,
        "thinned": lambda x: x,
        "blurred_speed": lambda _: 0.0,
        "fit_sign_model": lambda problem: problem,
        "is_puzzled": lambda _: False,
    }.items():
        monkeypatch.setattr(transients, name, answer)
    monkeypatch.setattr(puzzles, "log_error", lambda after, _: after)
    asked = []

    def again(problem: Any) -> Any:
        asked.append(problem)
        return State(second.after, problem)

    found: Any = settle_transients(first, again)
    assert [problem.fit for problem in asked] == ["masked"]
    assert found.after == {"first": first, "second": second}[taken].after
    assert found.problem.fit == "all"
