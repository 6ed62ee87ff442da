"""The complete law of a joint that moves alone is not judged twice."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from lagnet.diagnosis.motion.arm import complete_or_named
from lagnet.diagnosis.motion.arm.complete_or_named import no_worse_than_named
from lagnet.servos.parameters import NEUTRAL, law_vector


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
