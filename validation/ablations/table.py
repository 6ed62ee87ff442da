"""What is taken out of the diagnosis: each rule, by leaving it out of `RULES`, and each step that is no rule."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from lagnet.diagnosis.rules.catalogue import RULES
from lagnet.diagnosis.rules.rule import RejectionRule
from lagnet.diagnosis.settings import DecisionLimits
from validation.ablations import neutral
from validation.ablations.taken_out import Instead


@dataclass(frozen=True)
class Ablation:
    """One rule or step that is taken out.

    Args:
        name: of the rule or step.
        instead_of: what the diagnosis does then, in words.
        less: names of rules that are left out.
        instead: what stands in the places of a step that is no rule and has no parameter.
        changed: rules with another limit, in the places of those of the same names.
        limits: of the diagnosis, where they are not the defaults.
    """

    name: str
    instead_of: str
    less: frozenset[str] = frozenset()
    instead: Instead = field(default_factory=dict)
    changed: tuple[RejectionRule, ...] = ()
    limits: DecisionLimits | None = None

    @property
    def rules(self) -> tuple[RejectionRule, ...]:
        """The rules that stay."""
        changed = {r.name: r for r in self.changed}
        return tuple(changed.get(r.name, r) for r in RULES if r.name not in self.less)


NOTHING = Ablation("nothing", "the diagnosis as it is")

WITHOUT_RULE = tuple(Ablation(r.name, f"need not hold: {r.statement}", frozenset({r.name})) for r in RULES)
"""One for each rule of the catalogue, so that a new rule is measured without a line here."""

WITHOUT_STEP = (
    Ablation(
        "noise floor",
        "no noise is known: every residual is a mismatch",
        instead={"lagnet.diagnosis.problem.noise_floor:noise_floor": neutral.no_noise},
    ),
    Ablation(
        "sign model",
        "dry friction changes its sign over the speed that noise blurs, at every joint",
        instead={"lagnet.diagnosis.problem.dry_friction:fit_sign_model": neutral.first_argument},
    ),
    Ablation(
        "rivals",
        "the best hypothesis is taken up, then the next; none is exchanged for another",
        frozenset({"canonical_form"}),
        {"lagnet.diagnosis.selection.joint_search:search_joint": neutral.first_come},
    ),
    Ablation(
        "unseen blocks",
        "hypotheses are judged on the data that they are fitted to",
        instead={
            "lagnet.diagnosis.regression.joint_system:BorderedSystems": neutral.error_where_fitted,
            "lagnet.diagnosis.regression.cross_validation:_unseen_error": neutral.arm_error_where_fitted,
            "lagnet.diagnosis.regression.cross_validation:_theta_without_folds": neutral.arm_theta_where_fitted,
            "lagnet.diagnosis.identifiability.rivals:held_out_errors": neutral.block_errors_where_fitted,
        },
    ),
    Ablation(
        "blocks of time",
        "noise is white, and every sample a piece of evidence of its own",
        instead={
            "lagnet.diagnosis.regression.cross_validation:statistical_inefficiency": neutral.value(1.0),
            "lagnet.diagnosis.selection.arm_search:FIRST_INEFFICIENCY": neutral.value(1.0),
            "lagnet.diagnosis.estimation.gauss_newton:GaussNewton.covariance": neutral.white,
            "lagnet.diagnosis.transients.separation:_caution": neutral.value(1.0),
        },
    ),
    Ablation(
        "proposals",
        "the residual proposes no hypotheses, such as the order of a ripple",
        instead={
            "lagnet.diagnosis.selection.residual_proposals:proposals_from_residual": neutral.value(None),
        },
    ),
    Ablation(
        "repeated search",
        "effects behind a payload see the load of the nominal model",
        instead={"lagnet.diagnosis.selection.iterated_search:ROUNDS": neutral.value(0)},
    ),
    Ablation(
        "mounting",
        "the search starts from a base that stands as modelled",
        instead={"lagnet.diagnosis.nominal.mounting:mounting_of": neutral.value(())},
    ),
    Ablation(
        "ties",
        "the selected name stands alone, whatever else would explain the data",
        instead={
            "lagnet.diagnosis.identifiability.rivals:compare_with_rivals": neutral.without_rivals,
            "lagnet.diagnosis.identifiability.unexcited_rivals:with_unexcited_rivals": neutral.comparisons_as_they_are,
            "lagnet.diagnosis.identifiability.equivalent_laws:tie_equivalent_laws": neutral.comparisons_as_they_are,
        },
    ),
    Ablation(
        "ambiguity",
        "a cause that could be any of many is named",
        instead={"lagnet.diagnosis.identifiability.ambiguity:ambiguous_causes": neutral.value({})},
    ),
    Ablation(
        "joint refit",
        "parameters stay as the search found them, on its grid of shapes",
        instead={
            "lagnet.diagnosis.estimation.gauss_newton:GaussNewton.descend": neutral.start_as_it_is,
            "lagnet.diagnosis.estimation.physical_bodies:with_physical_bodies": neutral.start_as_it_is,
        },
    ),
    Ablation(
        "physical bodies",
        "a fitted body may be one that no mass can have",
        instead={"lagnet.diagnosis.estimation.physical_bodies:with_physical_bodies": neutral.start_as_it_is},
    ),
    Ablation(
        "misspecification",
        "intervals hold the scatter of blocks alone",
        frozenset({"not_significant"}),
        {"lagnet.diagnosis.pipeline:with_misspecification": neutral.first_argument},
    ),
    Ablation(
        "friction at rest",
        "a joint that rests keeps none of its dry friction",
        instead={"lagnet.diagnosis.estimation.friction_at_rest:friction_at_rest": neutral.full_friction_at_rest},
    ),
    Ablation(
        "narrower band",
        "the first bandwidth is kept whatever is left unexplained",
        instead={"lagnet.diagnosis.reruns.band:best_band": neutral.first_argument},
    ),
    Ablation(
        "shared clock",
        "a shift that all joints share is a delay of each",
        instead={"lagnet.diagnosis.reruns.clock:on_one_clock": neutral.first_argument},
    ),
    Ablation(
        "transients",
        "nothing acts for a while only",
        instead={"lagnet.diagnosis.reruns.transients:settle_transients": neutral.first_argument},
    ),
)
"""Steps of the search and of the estimation; patched where no parameter of `diagnose` turns them off."""

SINGLE = (NOTHING, *WITHOUT_RULE, *WITHOUT_STEP)
"""The whole diagnosis first, then one thing taken out at a time."""


def _together(*names: str) -> Ablation:
    """Several taken out at once, where each may stand in for another."""
    chosen = [a for a in SINGLE if a.name in names]
    places = {place: new for a in chosen for place, new in a.instead.items()}
    less = frozenset[str]().union(*(a.less for a in chosen))
    return Ablation(" + ".join(names), "several are taken out at once", less, places)


HELD_OUT = ("no_holdout_gain", "measured_torque_leakage")  # both ask recordings that were not fitted
ABLATIONS = (
    *SINGLE,
    _together(*HELD_OUT),
    _together("lack_of_fit", *HELD_OUT),
    _together("noise floor", "lack_of_fit", *HELD_OUT, "unseen blocks", "blocks of time"),
    Ablation("all rules", "whatever the search finds is named", frozenset(r.name for r in RULES)),
)
"""Those, and what may stand in for each other taken out together."""


def ablation_named(name: str) -> Ablation:
    """One of them.

    Raises:
        KeyError: there is none of that name.
    """
    return {a.name: a for a in ABLATIONS}[name]


def names_of(ablations: Iterable[Ablation]) -> tuple[str, ...]:
    """Their names, in order."""
    return tuple(a.name for a in ablations)
