"""The evidence: how much better each effect explains unseen data than every rival does."""

from __future__ import annotations

import math
from typing import Any

from lagnet.diagnosis.verdict.report_data import Comparison
from lagnet.reports.contents.findings import Findings, place
from lagnet.reports.figures.figure import Figure, Trace, axis, colour, names_axis, plain
from lagnet.reports.page import Section, section
from lagnet.reports.wording import effect_words, number, wrapped

TICKS = (-1000, -100, -10, -3, -1, 0, 1, 3, 10, 30, 100, 300, 1000, 3000)
Best = tuple[Comparison, str, float]  # a comparison with its strongest rival and the odds over it


def build(findings: Findings) -> Section | None:
    """Bars of log10 odds; what comes close to zero cannot be told apart."""
    comparisons = [comparison for comparison in _comparisons(findings) if comparison.rivals]
    if not comparisons:
        return None
    best = [(comparison, *min(comparison.rivals, key=lambda rival: rival[1])) for comparison in comparisons]
    tied = {(effect["effect"], effect["joint"]) for effect in findings.effects if effect["status"] == "tied"}
    rows = [(comparison, *rival) for comparison in comparisons for rival in comparison.rivals]
    return section(
        "rivals",
        "Evidence against rivals",
        [_figure(best, tied)],
        rows=[{"effect": c.effect, "place": place(c.joint), "rival": rival, "odds": odds} for c, rival, odds in rows],
        any_tied=bool(tied),
        more=len(rows) > len(comparisons),
    )


def _comparisons(findings: Findings) -> list[Comparison]:
    """The comparisons of the evidence, or, without it, each effect against the best rival that the verdict names."""
    if findings.evidence.comparisons:
        return list(findings.evidence.comparisons)
    best = ((effect, effect["evidence"]) for effect in findings.effects)
    return [
        Comparison(
            effect["effect"], effect["joint"], ((evidence["best_rival"], evidence["log10_odds_over_best_rival"]),)
        )
        for effect, evidence in best
        if evidence["best_rival"] is not None and evidence["log10_odds_over_best_rival"] is not None
    ]


def _figure(best: list[Best], tied: set[tuple[str, str | None]]) -> Figure:
    words = [_words(*row) for row in best]
    labels = ["<br>".join(plain(line) for line in lines) for lines in words]
    named = [(comparison.effect, comparison.joint) not in tied for comparison, *_ in best]
    traces = [_bars(labels, [odds for *_, odds in best], named), _others(labels, best)]
    reach = [odds for comparison, *_ in best for _, odds in comparison.rivals]
    zero = {"type": "line", "x0": 0, "x1": 0, "yref": "paper", "y0": 0, "y1": 1}
    layout = {
        "yaxis": names_axis(autorange="reversed", categoryorder="array", categoryarray=labels),
        "xaxis": axis("log10 odds", "–", **_compressed_axis(reach)),
        "shapes": [{**zero, "line": {"color": colour("ink"), "width": 2}}],
        "bargap": 0.3,
        "margin": {"t": 40},
    }
    height = 120 + len(words) * (16 * max(map(len, words)) + 12)
    return Figure("rival-bars", traces, "log10 odds of each effect over its rivals", layout, height)


def _words(comparison: Comparison, rival: str, _: float) -> list[str]:
    effect = wrapped(f"{effect_words(comparison.effect)} on {place(comparison.joint)}", 30)
    return [*effect, f"over {effect_words(rival)}"]


def _bars(labels: list[str], odds: list[float], named: list[bool]) -> Trace:
    return {
        "type": "bar", "orientation": "h", "y": labels, "x": [_compressed(value) for value in odds],
        "name": "over its strongest rival", "text": [number(value, 2) for value in odds],
        "textposition": "auto", "insidetextanchor": "middle", "textangle": 0, "cliponaxis": False,
        "marker": {"color": [colour("corrected" if known else "noise") for known in named]},
        "hovertemplate": "%{y}: %{text}<extra></extra>",
    }  # fmt: skip


def _others(labels: list[str], best: list[Best]) -> Trace:
    """The weaker rivals, as marks on the same line."""
    marks = [
        (label, rival, odds)
        for label, (comparison, strongest, _) in zip(labels, best, strict=True)
        for rival, odds in comparison.rivals
        if rival != strongest
    ]
    return {
        "type": "scatter", "mode": "markers", "y": [label for label, *_ in marks],
        "x": [_compressed(odds) for *_, odds in marks], "name": "over its other rivals",
        "text": [f"over {plain(effect_words(rival))}: {number(odds, 2)}" for _, rival, odds in marks],
        "marker": {"symbol": "diamond-open", "size": 9, "color": colour("ink"), "line": {"width": 1.5}},
        "hovertemplate": "%{text}<extra></extra>",
    }  # fmt: skip


def _compressed(odds: float) -> float:
    """Linear near 0, logarithmic far out, so that odds of 3 and of 300 can both be read."""
    return math.copysign(math.log10(1 + abs(odds)), odds) if math.isfinite(odds) else math.copysign(4.0, odds)


def _compressed_axis(odds: list[float]) -> dict[str, Any]:
    reach = [_compressed(value) for value in odds]
    low, high = min(min(reach) * 1.15, -0.12), max(max(reach) * 1.15, 0.6)
    ticks = [t for t in TICKS if low <= _compressed(t) <= high]
    return {
        "range": [low, high], "tickvals": [_compressed(tick) for tick in ticks],
        "ticktext": [f"{tick:d}".replace("-", "−") for tick in ticks], "zeroline": False,
    }  # fmt: skip
