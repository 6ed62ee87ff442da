"""What a rule buys: the figures with it, and without it on the same plants."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from validation.ablations.table import NOTHING, WITHOUT_RULE, WITHOUT_STEP, ablation_named, names_of
from validation.concealed.scoring import Score
from validation.concealed.summary import FOUND, figures

SHARES = {  # figure → whether more is better
    "precision": True,
    "recall": True,
    "right_joint": True,
    "interval_coverage": True,
    "unlisted_given_a_wrong_name": False,
}
COUNTS = ("claims_on_plants_with_nothing_hidden",)
BESIDE = (
    "plants",
    "asked",
    "claims",
    "claims_wrong",
    "precision_without_unlisted",
    "named_alone",
    "unlisted_noticed",
    "median_parameter_error",
    "failures",
)
LEAST = 0.02  # of a share, that a rule must buy to earn its place
FULL_COVERAGE = 0.95


@dataclass(frozen=True)
class Told:
    """What a verdict without a rule is worth.

    Args:
        score: of its claims.
        mismatch: whether it says that recordings and model differ at all.
    """

    score: Score
    mismatch: bool


@dataclass(frozen=True)
class Row:
    """One ablation.

    Args:
        name, instead_of: of the rule, and what the diagnosis does without it.
        figures: without the rule.
        bought: by how much each figure is better with the rule; coverage is better where it is nearer to 95 %.
        plants_better, plants_worse: where the rule changes the claims for the better, or for the worse.
        claims: of each plant whose claims are not those of the whole diagnosis.
    """

    name: str
    instead_of: str
    figures: dict
    bought: dict[str, float]
    plants_better: int
    plants_worse: int
    claims: dict[str, list[str]]

    @property
    def earns(self) -> bool:
        """Whether some figure is better with the rule by as much as the pass line asks for."""
        shares = any(self.bought[k] >= LEAST for k in SHARES if k in self.bought)
        return shares or any(self.bought.get(k, 0) >= 1 for k in COUNTS)

    def told(self) -> dict:
        """Plain values for the result file."""
        return {
            "instead": self.instead_of,
            "kind": kind_of(self.name),
            "figures": self.figures,
            "bought": self.bought,
            "earns_its_place": self.earns,
            "plants_better_with_it": self.plants_better,
            "plants_worse_with_it": self.plants_worse,
            "claims_that_differ": self.claims,
        }

    def line(self) -> str:
        """One line of a table."""
        shown = " ".join("     -" if (x := self.figures[k]) is None else f"{x:6.3f}" for k in (*SHARES, *COUNTS))
        return f"{self.name:74s} {shown}  better {self.plants_better}, worse {self.plants_worse} with it"


def kind_of(name: str) -> str:
    """What was taken out: nothing, a rule of the catalogue, a step that is none, or several."""
    kinds = {"nothing": (NOTHING,), "rule": WITHOUT_RULE, "step": WITHOUT_STEP}
    return next((kind for kind, own in kinds.items() if name in names_of(own)), "several")


def rule_rows(told: Mapping[str, Sequence[Told]]) -> list[Row]:
    """The whole diagnosis first, then each ablation against it."""
    whole = next(iter(told.values()))
    return [_row(name, one, whole) for name, one in told.items()]


def _row(name: str, told: Sequence[Told], told_by_all: Sequence[Told]) -> Row:
    without, whole = ([t.score for t in each] for each in (told, told_by_all))
    found, full = figures(without), figures(whole)
    empty = [t.mismatch for t in told if t.score.group == "empty"]
    alarms = {"mismatch_told_where_nothing_is_hidden": sum(empty), "plants_with_nothing_hidden": len(empty)}
    kept = {k: found[k] for k in (*SHARES, *COUNTS, *BESIDE)} | alarms
    pairs = list(zip(whole, without, strict=True))
    values = [(_value(a), _value(b)) for a, b in pairs]
    return Row(
        name,
        ablation_named(name).instead_of,
        kept,
        {k: _gain(k, full[k], found[k]) for k in (*SHARES, *COUNTS) if None not in (full[k], found[k])},
        sum(a > b for a, b in values),
        sum(a < b for a, b in values),
        {b.plant: _told(b) for a, b in pairs if _told(a) != _told(b)},
    )


def _gain(figure: str, whole: float, without: float) -> float:
    if figure == "interval_coverage":
        return abs(without - FULL_COVERAGE) - abs(whole - FULL_COVERAGE)
    return (whole - without) if SHARES.get(figure) else without - whole


def _value(s: Score) -> int:
    """Causes found less claims that are wrong; a plant without a verdict has found nothing."""
    return sum(a.how in FOUND for a in s.answers if not a.effect.startswith("unlisted:")) - s.wrong


def _told(s: Score) -> list[str]:
    return [f"{c[0]} @ {c[1]}: {'/'.join((c[3], *c[2]))}" for c in s.claims] or [s.failure or "none"]
