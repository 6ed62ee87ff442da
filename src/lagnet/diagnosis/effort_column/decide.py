"""Compares what a column of effort may hold: torque with or without gravity, at the link, current, magnitude, duty."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from lagnet.diagnosis.effort_column.copies import copy_of, error_times_gain
from lagnet.diagnosis.effort_column.drives import back_emf, friction_share
from lagnet.diagnosis.effort_column.factors import joint_factors, joint_loads
from lagnet.diagnosis.effort_column.finding import CANNOT_TELL, EffortFinding, EffortLimits
from lagnet.diagnosis.effort_column.gravity import holds_gravity
from lagnet.diagnosis.effort_column.hypotheses import COPIES, ERROR, HYPOTHESES, HypothesisFits
from lagnet.diagnosis.effort_column.samples import MOST, effort_samples
from lagnet.diagnosis.effort_column.sign import lacks_sign
from lagnet.diagnosis.effort_column.units import UnitOdds, unit_odds
from lagnet.recordings.recording import Recording
from lagnet.types import InverseDynamics

OWN_UNIT = "drive's own"


def effort_column(
    recordings: Sequence[Recording],
    robot: InverseDynamics,
    column: str = "tau",
    limits: EffortLimits | None = None,
    most: int = MOST,
) -> EffortFinding:
    """What a column that was recorded as torque holds.

    Each joint's column is fitted by the nominal gravity torque, the rest of the nominal torque, the rotor, viscous and
    dry friction, and by fewer of them; each fit predicts stretches of time that were left out. The factors of the
    nominal torques, compared over the joints, tell the unit.

    Args:
        recordings: of the robot, with the column.
        robot: the nominal model.
        column: name of the signal.
        limits: what a decision needs.
        most: samples that are compared.
    """
    return _Decision(
        HypothesisFits(effort_samples(recordings, robot, column, most)), limits or EffortLimits()
    ).finding()


@dataclass
class _Decision:
    """The questions in their order, each answer with its sentence of evidence."""

    fits: HypothesisFits
    limits: EffortLimits
    explained: dict[str, float] = field(default_factory=dict)
    evidence: list[str] = field(default_factory=list)
    factors: dict[int, tuple[float, float]] = field(default_factory=dict)

    def finding(self) -> EffortFinding:
        """The finding, or why there is none."""
        if not self.fits.alive:
            return self._told("constant", "", "no joint's column ever changes")
        return self._copied() or self._effort()

    def _told(self, kind: str, unit: str, sentence: str, odds: UnitOdds | None = None) -> EffortFinding:
        if not self.evidence or self.evidence[-1] != sentence:
            self.evidence.append(sentence)
        samples = self.fits.samples
        scale = dict(zip(self.factors, odds.scale, strict=True)) if odds else {}
        per_joint = tuple(float(scale[j][0]) if j in scale else None for j in range(samples.n_dof))
        probability = odds.likely[odds.best] if odds else 0.0
        return EffortFinding(
            kind,
            unit,
            samples.joints,
            per_joint,
            tuple(self.evidence),
            dict(self.explained),
            probability,
            len(self.fits.alive),
        )

    def _copied(self) -> EffortFinding | None:
        for kind in COPIES:
            self.explained[kind] = self.fits.mean(kind)
            copy = copy_of(self.fits, kind, self.limits)
            if copy:
                return self._told(kind, *copy)
        return None

    def _effort(self) -> EffortFinding:
        """What is told of a column that is no copy."""
        magnitude, sentence = lacks_sign(self.fits, self.limits)
        if sentence:
            self.evidence.append(sentence)
        self.fits = HypothesisFits(self.fits.samples, magnitude)
        for name in HYPOTHESES:
            self.explained[name] = self.fits.mean(name)
        if self.explained["torque"] < self.limits.explained:
            share = max(self.explained["torque"], 0.0)
            return self._otherwise(f"the model's torque predicts {share:.0%} of the column only")
        gravity, sentence = holds_gravity(self.fits, self.limits)
        self.evidence.append(sentence)
        return self._otherwise(sentence) if gravity is None else self._with_unit(gravity)

    def _otherwise(self, sentence: str, odds: UnitOdds | None = None) -> EffortFinding:
        """What is told where no torque was found: the position error, a magnitude, or nothing."""
        unknown = "magnitude" if self.fits.magnitude else CANNOT_TELL
        return self._as_error() or self._told(unknown, "", sentence, odds)

    def _as_error(self) -> EffortFinding | None:
        if self.fits.samples.error is None or self.fits.magnitude:
            return None
        self.explained[ERROR] = self.fits.mean(ERROR)
        told = error_times_gain(self.fits, self.limits)
        return self._told(told[0], "", told[1]) if told else None

    def _with_unit(self, with_gravity: bool) -> EffortFinding:
        self.factors = joint_factors(self.fits, with_gravity, self.limits)
        known = list(self.factors.values())
        if not known:
            return self._otherwise("no joint's factor between model and column is significant")
        odds = unit_odds(known, joint_loads(self.fits, list(self.factors)))
        shown = ", ".join(f"{v:.3g} ± {s:.2g}" for v, s in known[:7])
        self.evidence.append(f"column units in one N m, joint by joint: {shown}")
        if len({np.sign(value) for value, _ in known}) > 1 and not self.fits.magnitude:
            self.evidence.append("the sign of the column differs between joints")
        if odds.likely[odds.best] < self.limits.probability:
            return self._of_either_unit(odds)
        return self._current_or_duty(odds) if odds.best == "current" else self._torque(odds, with_gravity)

    def _of_either_unit(self, odds: UnitOdds) -> EffortFinding:
        two = sorted(odds.likely.items(), key=lambda item: -item[1])[:2]
        told = " or ".join(f"{unit} ({p:.0%})" for unit, p in two)
        share, like_duty = back_emf(self.fits, list(self.factors), self.limits)
        if share > self.limits.back_emf and like_duty and not self.fits.magnitude:
            grows = f"{share:.0%} of it grows with speed, as back electromotive force does"
            return self._as_error() or self._told("duty", OWN_UNIT, grows)
        return self._otherwise(f"its unit may be {told}", odds)

    def _torque(self, odds: UnitOdds, with_gravity: bool) -> EffortFinding:
        said = f"its unit is {odds.best} with a probability of {odds.likely[odds.best]:.3g}"
        if self.fits.magnitude:
            return self._told("magnitude of torque", odds.best, said, odds)
        if not with_gravity:
            return self._told("torque without gravity", odds.best, said, odds)
        self.evidence.append(said)
        least, most = friction_share(self.fits)
        if least > self.limits.friction:
            return self._told("torque", odds.best, f"friction is at least {least:.0%} of the joints' torques", odds)
        if most < self.limits.no_friction:
            told = f"friction is at most {most:.1%} of the joints' torques, less than drives lose"
            return self._told("link-side torque", odds.best, told, odds)
        told = f"friction is {least:.1%} to {most:.1%} of the joints' torques: motor's or link's side cannot be told"
        return self._told("torque of either side", odds.best, told, odds)

    def _current_or_duty(self, odds: UnitOdds) -> EffortFinding:
        self.evidence.append(f"its factors are no unit of torque (probability {odds.likely['current']:.3g})")
        as_error = self._as_error()
        if as_error:
            return as_error
        share, like_duty = back_emf(self.fits, list(self.factors), self.limits)
        grows = f"{share:.0%} of it grows with speed"
        if share > self.limits.back_emf and like_duty:
            if self.fits.magnitude:
                return self._told("magnitude", "", f"magnitude of a current or of a duty cycle: {grows}", odds)
            return self._told("duty", OWN_UNIT, f"{grows}, as back electromotive force does", odds)
        if share < self.limits.no_back_emf or not like_duty:
            kind = "magnitude of current" if self.fits.magnitude else "current"
            return self._told(kind, OWN_UNIT, f"{grows}: no back electromotive force", odds)
        return self._otherwise(f"{grows}: current or duty cycle", odds)
