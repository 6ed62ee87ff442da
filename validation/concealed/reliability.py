"""Of the names told with odds of so many powers of ten over their best rival, the share that is right."""

from __future__ import annotations

import json
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

from validation.concealed.scoring import Score

EDGES = (float("-inf"), -1.3, 0.0, 1.0, 2.0, 4.0, 8.0, 16.0, float("inf"))  # log10 of the odds


def odds_of(out: Path, scores: Sequence[Score]) -> list[tuple[float, str, str]]:
    """(log10 odds over the best rival, status, judgement) of every claim that has a rival."""
    rows = []
    for score in scores:
        verdict = out / "verdicts" / f"{score.plant}.json"
        if not verdict.exists():
            continue
        effects = json.loads(verdict.read_text())["effects"]
        for claim, effect in zip(score.claims, effects, strict=True):
            odds = effect["evidence"]["log10_odds_over_best_rival"]
            if odds is not None:
                rows.append((float(odds), effect["status"], claim[3]))
    return rows


def reliability(rows: Sequence[tuple[float, str, str]]) -> list[dict]:
    """For each range of odds: names told alone, those of them that are right or beside it, and ties likewise."""
    table = []
    for low, high in pairwise(EDGES):
        here = [r for r in rows if low <= r[0] < high]
        alone, tied = ([r for r in here if r[1] == status] for status in ("named", "tied"))
        table.append(
            {
                "log10_odds": [None if abs(x) == float("inf") else x for x in (low, high)],
                "named": len(alone),
                "named_right": sum(r[2] != "wrong" for r in alone),
                "tied": len(tied),
                "tied_right": sum(r[2] != "wrong" for r in tied),
            }
        )
    return table


def named_against_the_odds(rows: Sequence[tuple[float, str, str]], tie: float) -> int:
    """Names told although a rival is likelier by more than the limit of a tie; asked: none."""
    return sum(odds < -tie for odds, _, _ in rows)
