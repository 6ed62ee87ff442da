"""The confusion study counts a cause as right, tied, not told or told as another; kept rows are not run again."""

from __future__ import annotations

import json

import numpy as np
import pytest
from validation.motion_concealed.causes import ENCODER, LISTED, SIDES, UNLISTED, YIELDING, Cause, draw_cause
from validation.motion_concealed.confusions import FOUR, outcome, result_of
from validation.motion_concealed.plants import plant
from validation.motion_concealed.study import plan_of, run

from lagnet.diagnosis.verdict.verdict import EffectEvidence, EffectFound

CAUSE = Cause("backlash", 0, "b", 0.02, "link")
SECONDS = 4.0


def claim(effect: str, joint: str = "lower", tied: tuple[str, ...] = ()) -> EffectFound:
    return EffectFound(effect, joint, "named", tied, (), EffectEvidence(1.0, 0.0, 1.0, None, None), "")


@pytest.mark.parametrize(
    ("claims", "told"),
    [
        ((claim("backlash"),), "named right"),
        ((claim("backlash", tied=("dead_band",)),), "tied"),
        ((claim("dead_band", tied=("backlash",)),), "tied"),
        ((), "abstained"),
        ((claim("dead_band"),), "named as another"),
        ((claim("backlash"), claim("dead_band")), "named as another"),
        ((claim("backlash", "upper"),), "named as another"),
    ],
)
def test_what_became_of_a_cause(claims, told):
    assert outcome("one", CAUSE, ("lower", "upper"), claims)["outcome"] == told


def test_one_told_as_another_fails():
    rows = [outcome("one", CAUSE, ("lower",), [claim("dead_band")])]
    found = result_of(1, rows)
    assert found["table"]["backlash"]["named as another"] == found["named_as_another"] == 1
    assert not found["passed"]["never_one_for_another"]
    assert set(FOUR) == set(found["table"])


def test_a_plan_hides_each_cause_as_often_as_asked():
    plan = plan_of(5, 3, 4, 6)
    assert all(plan.count(effect) == 3 for effect in LISTED)
    assert plan.count(None) == 4
    assert sum(plan.count(effect) for effect in UNLISTED) == 6
    assert plan != plan_of(6, 3, 4, 6)


@pytest.mark.parametrize("effect", [*LISTED, *UNLISTED])
def test_sizes_are_drawn_within_their_bounds(effect):
    rng = np.random.default_rng(1)
    drawn = [draw_cause(rng, effect, 0, 1.0, SIDES[i % 2]) for i in range(40)]
    _, low, high = (LISTED | UNLISTED)[effect]
    assert all(0.999 * low <= c.value <= max(high, 0.05) for c in drawn)
    assert all((c.side == SIDES[i % 2]) == (effect in YIELDING) for i, c in enumerate(drawn))


def test_kept_rows_are_not_run_again(tmp_path):
    kept = tmp_path / "kept.jsonl"
    rows = [{"index": i, "plant": f"p_{i}", "claims": []} for i in range(2)]
    kept.write_text("\n".join(json.dumps(r) for r in rows) + '\n{"index": 2, "pla', encoding="utf-8")
    found = run((None, None), 1, SECONDS, kept=kept)
    assert [r["plant"] for r in found] == ["p_0", "p_1"]


@pytest.mark.parametrize("effect", [None, *YIELDING])
def test_both_engines_move_the_same_robot_alike(effect, tmp_path):
    """The same draws, servo and commands; in PyBullet rigid joints have no rotors."""
    real = [plant(4, 2, kind, effect, SECONDS, tmp_path) for kind in ("pendulum", "pendulum_bullet")]
    assert np.array_equal(real[0].recordings[0].command, real[1].recordings[0].command)
    apart = float(np.sqrt(np.mean((real[0].recordings[0].q - real[1].recordings[0].q) ** 2)))
    assert apart < (2.0 if effect else 60.0) * ENCODER
