"""The figures of a run: over all plants, by group, by effect, and what was named as what."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from validation.concealed.scoring import Answer, Score

FOUND = ("alone", "tied", "same torque")


def _asked(scores: Iterable[Score]) -> list[Answer]:
    """Listed causes that the recordings can show."""
    return [a for s in scores for a in s.answers if a.shown and not a.effect.startswith("unlisted:")]


def _share(part: float, whole: float) -> float | None:
    return part / whole if whole else None


def _median(values: Sequence[float]) -> float | None:
    return float(np.median(values)) if len(values) else None


def figures(scores: Sequence[Score]) -> dict:
    """The figures that pass lines are drawn through, and what stands behind them."""
    asked = _asked(scores)
    right, wrong = sum(s.right for s in scores), sum(s.wrong for s in scores)
    strange = [s for s in scores if s.group == "unlisted"]
    behind = [s.answers[1] for s in scores if s.group == "behind" and s.answers[1].shown]
    covered = [c for s in scores for c in s.covered.values()]
    gains = [s.gain_share for s in scores if s.gain_share is not None]
    return {
        "plants": len(scores),
        "robots": sorted({s.robot for s in scores if s.robot}),
        "hidden_effects": sum(len(s.answers) for s in scores),
        "hidden_effects_not_shown": sum(not a.shown for s in scores for a in s.answers),
        "asked": len(asked),
        "claims": sum(len(s.claims) for s in scores),
        "claims_right": right,
        "claims_wrong": wrong,
        "claims_beside": sum(c[3] == "beside" for s in scores for c in s.claims),
        "precision": _share(right, right + wrong),
        "precision_without_unlisted": _precision([s for s in scores if s.group != "unlisted"]),
        "recall": _share(sum(a.how in FOUND for a in asked), len(asked)),
        "named_alone": _share(sum(a.how == "alone" for a in asked), len(asked)),
        "named_in_a_tie": _share(sum(a.how == "tied" for a in asked), len(asked)),
        "named_by_the_same_torque": _share(sum(a.how == "same torque" for a in asked), len(asked)),
        "right_joint": _share(sum(s.joint_right for s in scores), sum(s.joint_judged for s in scores)),
        "plants_with_nothing_hidden": sum(s.group == "empty" for s in scores),
        "claims_on_plants_with_nothing_hidden": sum(s.wrong for s in scores if s.group == "empty"),
        "unlisted_plants": len(strange),
        "unlisted_given_a_wrong_name": _share(sum(s.wrong > 0 for s in strange), len(strange)),
        "unlisted_noticed": _share(
            sum(bool(a.noticed) for s in strange for a in s.answers if a.noticed is not None), len(strange)
        ),
        "small_behind_large": len(behind),
        "small_behind_large_found": _share(sum(a.how in FOUND for a in behind), len(behind)),
        "median_parameter_error": _median([e for s in scores for e in s.errors.values()]),
        "interval_coverage": _share(sum(covered), len(covered)),
        "median_gain_share": _median(gains),
        "median_gain_share_with_rest": _median(
            [s.gain_share_with_rest for s in scores if s.gain_share_with_rest is not None]
        ),
        "share_of_plants_with_gain_over_95_percent": _share(sum(g >= 0.95 for g in gains), len(gains)),
        "median_seconds": _median([s.seconds for s in scores]),
        "median_processor_seconds": _median([s.processor_seconds for s in scores]),
        "codes": sorted({s.code for s in scores if s.code}),  # more than one: the package changed meanwhile
        "failures": [f"{s.plant}: {s.failure}" for s in scores if s.failure],
    }


def _precision(scores: Sequence[Score]) -> float | None:
    right, wrong = sum(s.right for s in scores), sum(s.wrong for s in scores)
    return _share(right, right + wrong)


def by(scores: Sequence[Score], key: Callable[[Score], str]) -> dict[str, dict]:
    """Figures of every group of plants."""
    return {name: figures([s for s in scores if key(s) == name]) for name in sorted({key(s) for s in scores})}


def by_effect(scores: Sequence[Score]) -> dict[str, dict]:
    """Recall, parameter error and coverage of every hidden effect, and how often its name was given wrongly."""
    names = {a.effect for s in scores for a in s.answers} | {c[0] for s in scores for c in s.claims}
    return {name: _row(scores, name) for name in sorted(names)}


def _row(scores: Sequence[Score], name: str) -> dict:
    answers = [a for s in scores for a in s.answers if a.effect == name]
    asked = [a for a in answers if a.shown]
    errors = [e for s in scores for key, e in s.errors.items() if key.split(".")[0] == name]
    covered = [c for s in scores for key, c in s.covered.items() if key.split(".")[0] == name]
    return {
        "hidden": len(answers),
        "not_shown": len(answers) - len(asked),
        "found": sum(a.how in FOUND for a in asked),
        "alone": sum(a.how == "alone" for a in asked),
        "missed": sum(a.how == "missed" for a in asked),
        "claimed_wrongly": sum(c[0] == name and c[3] == "wrong" for s in scores for c in s.claims),
        "median_parameter_error": _median(errors),
        "interval_coverage": _share(sum(covered), len(covered)),
    }


def confusion(scores: Sequence[Score]) -> dict[str, dict[str, int]]:
    """How often each hidden effect was answered by each name on its joint; "nothing" where no claim was left for it."""
    table: dict[str, dict[str, int]] = {}
    for s in scores:
        wrong = [c for c in s.claims if c[3] == "wrong"]
        for a in s.answers:
            if a.how in FOUND:
                named = a.effect
            else:
                here = [c for c in wrong if c[1] == a.joint] or [c for c in wrong if c[1] is None]
                named = here[0][0] if here else "nothing"
                if here:
                    wrong.remove(here[0])
            _count(table, a.effect, named)
        for c in wrong:  # answers to nothing that was hidden there
            _count(table, "nothing", c[0])
        if not s.answers and not s.claims:
            _count(table, "nothing", "nothing")
    return table


def _count(table: dict[str, dict[str, int]], hidden: str, named: str) -> None:
    row = table.setdefault(hidden, {})
    row[named] = row.get(named, 0) + 1


def misses(scores: Sequence[Score]) -> list[dict]:
    """Plants where something went wrong, for those who mend the diagnosis."""
    return [
        {
            "plant": s.plant,
            "robot": s.robot,
            "group": s.group,
            "hidden": [f"{a.effect} @ {a.joint} {a.size:.2f}: {a.how}" for a in s.answers],
            "wrong": [f"{c[0]} @ {c[1]}" for c in s.claims if c[3] == "wrong"],
        }
        for s in scores
        if s.wrong or any(a.how == "missed" and a.shown for a in s.answers)
    ]
