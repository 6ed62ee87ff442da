"""Compares what a column of effort may hold: torque with or without gravity, at the link, current, magnitude, duty."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.effort_column.finding import CANNOT_TELL, EffortFinding, EffortLimits
from lagnet.diagnosis.effort_column.regressions import Fit, columns_of, fit
from lagnet.diagnosis.effort_column.samples import FAST, MOST, EffortSamples, effort_samples
from lagnet.diagnosis.effort_column.units import UnitOdds, unit_odds
from lagnet.recordings.recording import Recording
from lagnet.types import InverseDynamics

DRIVE = ("rotor", "viscous", "coulomb")
HYPOTHESES = {
    "torque": ("gravity", "dynamic", *DRIVE),
    "torque without gravity": ("dynamic", *DRIVE),
    "link-side torque": ("gravity", "dynamic"),
    "link-side torque without gravity": ("dynamic",),
}
COPIES = {"position": "q", "velocity": "viscous"}
ERROR = "position error"
ONE_GAIN = 0.1  # spread of the gains of joints over their mean, below which they are one gain
BETTER = 2.0  # times what one hypothesis leaves unexplained, which the other must leave at least
FULL_SCALES = (1.0, 100.0, 255.0, 885.0, 1000.0, 1023.0)  # of duty cycles: fraction, percent, counts
MOST_UNUSED = 12.0  # full scale over the largest number, beyond which it is not that scale
ROTOR = 0.05  # of the link's inertia: a rotor that cannot be told from the only body behind it
OWN_UNIT = "drive's own"
DEGREES = 57.29578  # in one radian
SAME_UNIT = 0.02  # of a factor: what is nearer to a unit has it
MOVING = 1e-9  # spread of a column over its size, below which it is constant


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
    return _Decision(effort_samples(recordings, robot, column, most), limits or EffortLimits()).finding()


@dataclass
class _Decision:
    samples: EffortSamples
    limits: EffortLimits

    def __post_init__(self) -> None:
        y = self.samples.y
        size = np.max(np.abs(y), axis=0)
        self.alive = [j for j in range(self.samples.n_dof) if np.std(y[:, j]) > MOVING * max(size[j], 1e-12)]
        self.explained: dict[str, float] = {}
        self.evidence: list[str] = []
        self.magnitude = False
        self._fits: dict[tuple[int, str], Fit] = {}

    def finding(self) -> EffortFinding:
        """The finding, or why there is none."""
        if not self.alive:
            return self._told("constant", "", "no joint's column ever changes")
        copied = self._copied()
        if copied:
            return copied
        self.magnitude = self._has_no_sign()
        self._unknown = "magnitude" if self.magnitude else CANNOT_TELL
        for name in HYPOTHESES:
            self.explained[name] = self._mean(name)
        if self.explained["torque"] < self.limits.explained:
            share = max(self.explained["torque"], 0.0)
            return self._otherwise(f"the model's torque predicts {share:.0%} of the column only")
        gravity = self._gravity()
        if gravity is None:
            return self._otherwise(self.evidence[-1])
        return self._with_unit(gravity)

    def _told(self, kind: str, unit: str, sentence: str, odds: UnitOdds | None = None) -> EffortFinding:
        if not self.evidence or self.evidence[-1] != sentence:
            self.evidence.append(sentence)
        scale = dict(zip(self.judged, odds.scale, strict=True)) if odds else {}
        per_joint = tuple(float(scale[j][0]) if j in scale else None for j in range(self.samples.n_dof))
        probability = odds.likely[odds.best] if odds else 0.0
        return EffortFinding(
            kind,
            unit,
            self.samples.joints,
            per_joint,
            tuple(self.evidence),
            dict(self.explained),
            probability,
            len(self.alive),
        )

    def _fit(self, joint: int, name: str) -> Fit:
        key = (joint, name)
        if key not in self._fits:
            terms = HYPOTHESES.get(name) or (COPIES.get(name, "error"),)
            self._fits[key] = fit(self.samples, joint, terms, self.magnitude and name in HYPOTHESES)
        return self._fits[key]

    def _mean(self, name: str) -> float:
        return float(np.mean([max(self._fit(j, name).explained, -1.0) for j in self.alive]))

    def _copied(self) -> EffortFinding | None:
        for kind in COPIES:
            self.explained[kind] = self._mean(kind)
            factors = [float(self._fit(j, kind).value[0]) for j in self.alive if self._fit(j, kind).value.size]
            if min(self._fit(j, kind).explained for j in self.alive) > self.limits.copy and _one_factor(factors):
                unit = "degrees" if abs(np.median(factors) / DEGREES - 1) < SAME_UNIT else ""
                return self._told(kind, unit, f"the column is the {kind} times {np.median(factors or [0.0]):.4g}")
        return None

    def _otherwise(self, sentence: str, odds: UnitOdds | None = None) -> EffortFinding:
        """What is told where no torque was found: the position error, a magnitude, or nothing."""
        return self._error_times_gain() or self._told(self._unknown, "", sentence, odds)

    def _error_times_gain(self) -> EffortFinding | None:
        """The output of a proportional controller, where that predicts more than the model's torque."""
        if self.samples.error is None or self.magnitude:
            return None
        self.explained[ERROR] = self._mean(ERROR)
        left, by_model = 1.0 - self.explained[ERROR], 1.0 - self.explained["torque"]
        if self.explained[ERROR] < self.limits.error or left > BETTER * by_model:
            return None
        gains = [float(self._fit(j, ERROR).value[0]) for j in self.alive if self._fit(j, ERROR).value.size]
        listed = ", ".join(f"{gain:.4g}" for gain in gains[:7])
        share = f"{self.explained[ERROR]:.1%} of it is the position error times {listed}"
        better = left * BETTER < by_model
        alike = float(np.ptp(gains)) < ONE_GAIN * float(np.mean(np.abs(gains)))
        if alike and (better or len(gains) > 1):
            return self._told(ERROR, "", share)
        if len(gains) > 1 and not better:
            return None  # a gain of its own at every joint, and no better than the model: a motor's effort
        # Under a purely proportional controller the motors' effort is the error times a gain of every joint.
        return self._told(CANNOT_TELL, "", f"{share}: the controller's output, or the motors' effort that follows it")

    def _has_no_sign(self) -> bool:
        """Whether no number is negative although a joint's torque must have turned round.

        It must where the joint moves both ways and gravity does not hold it to one side: friction and inertia turn.
        """
        if (self.samples.y[:, self.alive] < 0).any():
            return False
        turning = [self.samples.joints[j] for j in self.alive if self._must_turn(j)]
        if turning:
            self.evidence.append(
                f"no number is negative, though the torque must turn round at {', '.join(turning[:4])}"
            )
        else:
            self.evidence.append("no number is negative, as gravity may have it")
        return bool(turning)

    def _must_turn(self, joint: int) -> bool:
        gravity, v = columns_of(self.samples, joint)["gravity"], self.samples.v[:, joint]
        fast = np.abs(v) > 0.2 * np.percentile(np.abs(v), FAST)
        both_ways = min(np.mean(v[fast] < 0), np.mean(v[fast] > 0)) > self.limits.turning if fast.any() else False
        held = gravity.any() and min(np.mean(gravity < 0), np.mean(gravity > 0)) < self.limits.turning
        return bool(both_ways and not held)

    def _gravity(self) -> bool | None:
        """Whether gravity is in the column; None where that cannot be told."""
        with_, without = [], []
        for j in self.alive:
            found = self._fit(j, "torque")
            (g, sg), (d, sd) = found.of("gravity"), found.of("dynamic")
            if "gravity" not in found.terms:
                continue
            left = 1.0 - self._fit(j, "torque without gravity").explained
            gain = found.explained - (1.0 - left)
            stands_out = gain > self.limits.gain or gain > self.limits.gain_of_rest * left
            if abs(g) > self.limits.significant * sg and stands_out:
                with_.append((j, g, gain))
            elif abs(d) > self.limits.significant * sd and abs(g) + 2 * sg < self.limits.without_gravity * abs(d):
                without.append((j, g, gain))
        if not with_ and not without:
            heavy = any("gravity" in self._fit(j, "torque").terms for j in self.alive)
            if not heavy:
                self.evidence.append("gravity does not load these joints")
                return True
            self.evidence.append("neither gravity nor the rest of the model's torque stands out of the column")
            return None
        if with_ and without and sum(g for *_, g in with_) < 5 * self.limits.gain * len(without):
            self.evidence.append("gravity is in the column of some joints and not of others")
            return None
        if with_:
            best = max(with_, key=lambda item: item[2])
            name = self.samples.joints[best[0]]
            self.evidence.append(
                f"gravity is in it: without it {self.explained['torque without gravity']:.0%} is predicted in place of"
                f" {self.explained['torque']:.0%} (most at {name})"
            )
            return True
        listed = ", ".join(self.samples.joints[j] for j, *_ in without[:4])
        self.evidence.append(f"gravity is not in it: its factor is below a quarter of the inertia's at {listed}")
        return False

    @property
    def judged(self) -> list[int]:
        """Joints whose factor is significant."""
        return [j for j in self.alive if self._factor(j) is not None]

    def _factor(self, joint: int) -> tuple[float, float] | None:
        """Column units per N m at a joint: by gravity where that is in it, else by inertia."""
        found, choices = self._fit(joint, "torque"), []
        for term in ("gravity", "dynamic") if self._with_gravity else ("dynamic",):
            value, sigma = found.of(term)
            if abs(value) <= self.limits.significant * sigma:
                continue
            if term == "dynamic" and "rotor" not in found.terms:
                sigma = float(np.hypot(sigma, ROTOR * abs(value)))
            choices.append((abs(value) / max(sigma, 1e-12), value, sigma))
        return max(choices)[1:] if choices else None

    def _with_unit(self, with_gravity: bool) -> EffortFinding:
        self._with_gravity = with_gravity
        factors = [self._factor(j) for j in self.judged]
        known = [f for f in factors if f is not None]
        if not known:
            return self._otherwise("no joint's factor between model and column is significant")
        signs = {np.sign(value) for value, _ in known}
        load = [float(np.sqrt(np.mean((self.samples.gravity + self.samples.dynamic)[:, j] ** 2))) for j in self.judged]
        odds = unit_odds(known, load)
        shown = ", ".join(f"{v:.3g} ± {s:.2g}" for v, s in known[:7])
        self.evidence.append(f"column units in one N m, joint by joint: {shown}")
        if len(signs) > 1 and not self.magnitude:
            self.evidence.append("the sign of the column differs between joints")
        if odds.likely[odds.best] < self.limits.probability:
            two = sorted(odds.likely.items(), key=lambda item: -item[1])[:2]
            told = " or ".join(f"{unit} ({p:.0%})" for unit, p in two)
            share, like_duty = self._back_emf()
            if share > self.limits.back_emf and like_duty and not self.magnitude:
                grows = f"{share:.0%} of it grows with speed, as back electromotive force does"
                return self._error_times_gain() or self._told("duty", OWN_UNIT, grows)
            return self._otherwise(f"its unit may be {told}", odds)
        if odds.best == "current":
            return self._current_or_duty(odds)
        return self._torque(odds, with_gravity)

    def _torque(self, odds: UnitOdds, with_gravity: bool) -> EffortFinding:
        said = f"its unit is {odds.best} with a probability of {odds.likely[odds.best]:.3g}"
        if self.magnitude:
            return self._told("magnitude of torque", odds.best, said, odds)
        if not with_gravity:
            return self._told("torque without gravity", odds.best, said, odds)
        self.evidence.append(said)
        least, most = self._friction()
        if least > self.limits.friction:
            return self._told("torque", odds.best, f"friction is at least {least:.0%} of the joints' torques", odds)
        if most < self.limits.no_friction:
            told = f"friction is at most {most:.1%} of the joints' torques, less than drives lose"
            return self._told("link-side torque", odds.best, told, odds)
        told = f"friction is {least:.1%} to {most:.1%} of the joints' torques: motor's or link's side cannot be told"
        return self._told("torque of either side", odds.best, told, odds)

    def _friction(self) -> tuple[float, float]:
        """Least and most of dry friction, and of viscous friction at fast speed, over the torques of all joints."""
        least = most = total = 0.0
        for j in self.alive:
            found = self._fit(j, "torque")
            fast = float(np.percentile(np.abs(self.samples.v[:, j]), FAST))
            (dry, s_dry), (wet, s_wet) = found.of("coulomb"), found.of("viscous")
            if not np.isfinite(s_dry + s_wet):
                continue
            least += max(dry - 2 * s_dry, 0.0) + max(wet - 2 * s_wet, 0.0) * fast
            most += max(dry, 0.0) + 2 * s_dry + max(wet, 0.0) * fast
            total += float(np.percentile(np.abs(self.samples.y[:, j]), FAST))
        return least / max(total, 1e-300), most / max(total, 1e-300)

    def _current_or_duty(self, odds: UnitOdds) -> EffortFinding:
        said = f"its factors are no unit of torque (probability {odds.likely['current']:.3g})"
        self.evidence.append(said)
        as_error = self._error_times_gain()
        if as_error:
            return as_error
        share, like_duty = self._back_emf()
        grows = f"{share:.0%} of it grows with speed"
        if share > self.limits.back_emf and like_duty:
            if self.magnitude:
                return self._told("magnitude", "", f"magnitude of a current or of a duty cycle: {grows}", odds)
            return self._told("duty", OWN_UNIT, f"{grows}, as back electromotive force does", odds)
        if share < self.limits.no_back_emf or not like_duty:
            kind = "magnitude of current" if self.magnitude else "current"
            return self._told(kind, OWN_UNIT, f"{grows}: no back electromotive force", odds)
        return self._otherwise(f"{grows}: current or duty cycle", odds)

    def _back_emf(self) -> tuple[float, bool]:
        """Share of the column at fast speed that grows with speed (median of joints), and whether a duty cycle that
        ends at a usual full scale would give a no-load speed near the joints' speed limits."""
        y, v = np.abs(self.samples.y), np.abs(self.samples.v)
        factors = np.array([self._fit(j, "torque").of("viscous")[0] for j in self.judged])
        fast, size = (np.percentile(x[:, self.judged], FAST, axis=0) for x in (v, y))
        top, limit = float(y[:, self.alive].max()), self.samples.speed_limit[self.judged]
        share = float(np.median(np.maximum(factors, 0.0) * fast / np.maximum(size, 1e-300)))
        low, high = self.limits.no_load
        for full in FULL_SCALES:
            if full / MOST_UNUSED <= top <= 1.001 * full:
                no_load = full / np.maximum(factors, 1e-300)
                known = np.where(np.isfinite(limit), limit, fast)
                if np.mean((no_load > low * known) & (no_load < high * known)) > 0.5:
                    return share, True
        return share, False


def _one_factor(factors: Sequence[float]) -> bool:
    """Whether all joints are copied alike; of a single joint, whether in a known unit: a spring or viscous friction is
    proportional to position or speed as well.
    """
    if len(factors) > 1:
        return float(np.ptp(factors)) < SAME_UNIT * float(np.mean(np.abs(factors)))
    return any(abs(f / unit - 1) < SAME_UNIT for f in factors for unit in (1.0, DEGREES))
