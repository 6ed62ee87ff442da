"""What a rule buys: the figures with it, and without it on the same plants."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from validation.ablations.table import NOTHING, WITHOUT_RULE, WITHOUT_STEP, names_of
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
class Gain:
    """What one ablation does on plants of one kind.

    Args:
        figures, whole: without the rule or step, and of the whole diagnosis, on the same plants.
        bought: by how much each figure is better with the rule; coverage is better where it is nearer to 95 %.
        plants_better, plants_worse: where the rule changes the claims for the better, or for the worse.
        claims: of each plant whose claims are not those of the whole diagnosis.
        unaffected: plants on which it had no effect in the whole diagnosis, so that nothing was run.
    """

    figures: dict
    whole: dict
    bought: dict[str, float]
    plants_better: int
    plants_worse: int
    claims: dict[str, list[str]]
    unaffected: int

    @property
    def earns(self) -> bool:
        """Whether some figure is better with the rule by as much as the pass line asks for."""
        shares = any(self.bought[k] >= LEAST for k in SHARES if k in self.bought)
        return shares or any(self.bought.get(k, 0) >= 1 for k in COUNTS)

    def told(self) -> dict:
        """Plain values for the result file."""
        return {
            "figures": self.figures,
            "bought": self.bought,
            "earns_its_place": self.earns,
            "plants_better_with_it": self.plants_better,
            "plants_worse_with_it": self.plants_worse,
            "plants_without_effect": self.unaffected,
            "claims_that_differ": self.claims,
        }

    def line(self) -> str:
        """One line of a table."""
        shown = " ".join("     -" if (x := self.figures[k]) is None else f"{x:6.3f}" for k in (*SHARES, *COUNTS))
        counts = f"{self.figures['plants']:3d} plants, {self.unaffected:3d} without effect"
        return f"{shown} {counts}, better {self.plants_better}, worse {self.plants_worse} with it"


@dataclass(frozen=True)
class Row:
    """One ablation.

    Args:
        name, instead_of: of the rule, and what the diagnosis does without it.
        kinds: what it does on plants of each kind.
    """

    name: str
    instead_of: str
    kinds: dict[str, Gain]

    @property
    def earns(self) -> bool:
        """Whether it earns its place on plants of some kind."""
        return any(gain.earns for gain in self.kinds.values())

    def told(self) -> dict:
        """Plain values for the result file."""
        plain = {"instead": self.instead_of, "kind": kind_of(self.name), "earns_its_place": self.earns}
        return plain | {kind: gain.told() for kind, gain in self.kinds.items()}


def kind_of(name: str) -> str:
    """What was taken out: nothing, a rule of the catalogue, a step that is none, or several."""
    kinds = {"nothing": (NOTHING,), "rule": WITHOUT_RULE, "step": WITHOUT_STEP}
    return next((kind for kind, own in kinds.items() if name in names_of(own)), "several")


def gain_of(pairs: Sequence[tuple[Told, Told]], unaffected: int) -> Gain:
    """What an ablation does on some plants.

    Args:
        pairs: the whole diagnosis and that under the ablation, of each plant.
        unaffected: how many of these were not run, since nothing of it had an effect.
    """
    whole, without = ([t.score for t in each] for each in zip(*pairs, strict=True))
    full, found = figures(whole), figures(without)
    values = [(_value(a.score), _value(b.score)) for a, b in pairs]
    return Gain(
        _kept(found, [b for _, b in pairs]),
        _kept(full, [a for a, _ in pairs]),
        {k: _gain(k, full[k], found[k]) for k in (*SHARES, *COUNTS) if None not in (full[k], found[k])},
        sum(a > b for a, b in values),
        sum(a < b for a, b in values),
        {b.plant: _told(b) for a, b in zip(whole, without, strict=True) if _told(a) != _told(b)},
        unaffected,
    )


def _kept(found: dict, told: Sequence[Told]) -> dict:
    empty = [t.mismatch for t in told if t.score.group == "empty"]
    alarms = {"mismatch_told_where_nothing_is_hidden": sum(empty), "plants_with_nothing_hidden": len(empty)}
    return {k: found[k] for k in (*SHARES, *COUNTS, *BESIDE)} | alarms


def _gain(figure: str, whole: float, without: float) -> float:
    if figure == "interval_coverage":
        return abs(without - FULL_COVERAGE) - abs(whole - FULL_COVERAGE)
    return (whole - without) if SHARES.get(figure) else without - whole


def _value(s: Score) -> int:
    """Causes found less claims that are wrong; a plant without a verdict has found nothing."""
    return sum(a.how in FOUND for a in s.answers if not a.effect.startswith("unlisted:")) - s.wrong


def _told(s: Score) -> list[str]:
    return [f"{c[0]} @ {c[1]}: {'/'.join((c[3], *c[2]))}" for c in s.claims] or [s.failure or "none"]
