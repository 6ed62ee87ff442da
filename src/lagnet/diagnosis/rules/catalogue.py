"""Every rule that a named effect must pass, in their order. A new rule is one file and one line here."""

from __future__ import annotations

from lagnet.diagnosis.rules.canonical_form import CanonicalForm
from lagnet.diagnosis.rules.contained_law import ContainedLaw
from lagnet.diagnosis.rules.distant_centre import DistantCentre
from lagnet.diagnosis.rules.freed_link import FreedLink
from lagnet.diagnosis.rules.gain_beside_free_links import GainBesideFreeLinks
from lagnet.diagnosis.rules.impossible_density import ImpossibleDensity
from lagnet.diagnosis.rules.lack_of_fit import LackOfFit
from lagnet.diagnosis.rules.measured_torque_leakage import MeasuredTorqueLeakage
from lagnet.diagnosis.rules.negligible_torque import NegligibleTorque
from lagnet.diagnosis.rules.no_holdout_gain import NoHoldoutGain
from lagnet.diagnosis.rules.not_significant import NotSignificant
from lagnet.diagnosis.rules.periodic_disturbance import PeriodicDisturbance
from lagnet.diagnosis.rules.reversals_only import ReversalsOnly
from lagnet.diagnosis.rules.rule import RejectionRule
from lagnet.diagnosis.rules.surrogate_terms import SurrogateTerms
from lagnet.diagnosis.rules.value_at_bound import ValueAtBound

RULES: tuple[RejectionRule, ...] = (
    CanonicalForm(),
    FreedLink(),
    ContainedLaw(),
    NoHoldoutGain(),
    NegligibleTorque(),
    MeasuredTorqueLeakage(),
    LackOfFit(),
    SurrogateTerms(),
    PeriodicDisturbance(),
    ImpossibleDensity(),
    DistantCentre(),
    GainBesideFreeLinks(),
    ReversalsOnly(),
    ValueAtBound(),
    NotSignificant(),
)
