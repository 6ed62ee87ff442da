"""The complete law of a joint that moves alone is not judged twice."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lagnet.diagnosis.motion.arm import complete_or_named
from lagnet.diagnosis.motion.arm.complete_or_named import no_worse_than_named
from lagnet.servos.parameters import COULOMB, NEUTRAL, law_vector


class Judged(Exception):
    """Rollouts of the whole arm were asked for."""


def diagnosed(**named: float) -> Any:
    """A joint whose complete law has friction that its named law does not have."""
    return SimpleNamespace(law=law_vector(coulomb=0.2, **named), named_law=law_vector(**named))


def judge(found: dict[int, Any], monkeypatch: pytest.MonkeyPatch) -> dict[int, Any]:
    def rolled(*given: Any) -> Any:
        raise Judged

    monkeypatch.setattr(complete_or_named, "runs_held_out", rolled)
    problem: Any = None
    return no_worse_than_named(problem, 1, NEUTRAL[None].repeat(2, axis=0), found)


def test_one_rigid_joint_keeps_its_complete_law(monkeypatch: pytest.MonkeyPatch) -> None:
    found = {0: diagnosed(kp=3.0)}
    assert judge(found, monkeypatch) == found


@pytest.mark.parametrize(
    "found",
    [{0: diagnosed(stiffness=40.0)}, {1: diagnosed(gap=0.01)}, {0: diagnosed(kp=3.0), 1: diagnosed(kp=2.0)}],
    ids=["spring", "play", "two joints"],
)
def test_coupled_and_yielding_joints_are_judged_by_the_whole_arm(
    found: dict[int, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(Judged):
        judge(found, monkeypatch)


@dataclass(frozen=True)
class Found:
    """A joint with its complete and its named law."""

    law: np.ndarray
    named_law: np.ndarray

    @property
    def case(self) -> Any:
        return SimpleNamespace(floor=1e-3)


class Coupled:
    """Rollouts of two joints; the second is loaded by what the first does, three quarters of its friction."""

    def __init__(self, *given: Any) -> None:
        pass

    def errors(self, laws: np.ndarray) -> list[np.ndarray]:
        first, second = laws[:, COULOMB]
        return [np.array([first - 0.2]), np.array([second - 0.75 * first])]

    def scores(self, errors: list[np.ndarray], floors: np.ndarray) -> np.ndarray:
        return np.array([0.5 * np.log(np.mean(e**2) + f**2) for e, f in zip(errors, floors, strict=True)])


def test_a_joint_is_judged_beside_the_law_that_its_neighbour_keeps(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(complete_or_named, "runs_held_out", lambda *given: ())
    monkeypatch.setattr(complete_or_named, "ArmRuns", Coupled)
    second: Any = Found(law_vector(coulomb=0.1), law_vector())
    found: Any = {0: Found(law_vector(coulomb=0.2), law_vector()), 1: second}
    problem: Any = None
    kept = no_worse_than_named(problem, 1, NEUTRAL[None].repeat(2, axis=0), found)
    assert kept[0].law[COULOMB] == 0.2
    assert kept[1].law[COULOMB] == 0.1  # beside the other named law its own would be the better one
    found[1] = Found(law_vector(coulomb=0.1), law_vector(coulomb=0.16))
    kept = no_worse_than_named(problem, 1, NEUTRAL[None].repeat(2, axis=0), found)
    assert kept[1].law[COULOMB] == 0.16
