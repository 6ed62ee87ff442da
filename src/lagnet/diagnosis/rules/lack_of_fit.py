"""Lack of fit: effects that explain less of a joint than all effects leave unexplained there.

A wrong name for unlisted physics is worse than none. An effect is tested at the joints where it helps, and stays if it
passes at one of them: another joint may have physics of its own. A residual on held-out motion alone rejects no effect,
unless it can be predicted from the fitted motion. One that nothing predicts is a disturbance: an effect must explain
a tenth of it. Of one that is predictable it must explain as much, or where it is large many times as much; but where
the identified layer bears the effect out, twice what that layer leaves. A model that is known to leave an error leaves
another one on another motion, so that an effect must explain several times its power; one that may be the error of a
learned model stays only if it explains many times the residual.
At a joint whose held-out error all effects together make larger than that of the nominal model, effects with a torque
larger than the mismatch are rejected, since they cancel each other on the fitted motion alone; an arm-wide effect that
explains another joint stays.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from lagnet.diagnosis.identified.borne_out import is_borne_out
from lagnet.diagnosis.nominal.learned_error import Name, may_be_its_error, was_learned
from lagnet.diagnosis.rules.candidate import Candidate, Part
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.diagnosis.selection.holdout_gain import HoldoutGain
from lagnet.diagnosis.unexplained.predictability import Examples, is_predictable, signals_of
from lagnet.diagnosis.unexplained.remainder import every_second_part
from lagnet.percent import percent

Shares = dict[int, float]
"""By joint, a share of its mismatch."""


@final
@dataclass(frozen=True)
class LackOfFit(RejectionRule):
    """Share of a joint's mismatch that the effect explains, against the share that all effects leave unexplained.

    Args:
        little: residual share of a joint's mismatch, up to which no effect is rejected: real arms always have some.
        much: residual share, from which on what is predictable is physics of its own, not the shape of a named law.
        predictable: share of the residual that a flexible model predicts, from which on it is no disturbance.
        disturbed: share of a residual that is not predictable, a disturbance, that an effect must explain.
        stands: an effect stays if it alone explains this many times the predictable residual.
        borne_out: and this many times what the identified layer leaves, if that bears the effect out.
        most_left: residual share at a joint that still counts as explained by an arm-wide effect.
        worse: held-out error over the nominal one, from which the effects together harm a joint.
        outgrows: times the power of the nominal model's known error that an effect must explain: on real arms that did
            not change, errors on two stretches of motion differ by less in nine of ten joints.
    """

    name: ClassVar[str] = "lack_of_fit"
    statement: ClassVar[str] = (
        "an effect explains more of a joint than all effects together leave unexplained there, a tenth of what nothing "
        "predicts, or twice what the identified layer leaves where that bears it out"
    )
    source: ClassVar[str] = ""
    together: ClassVar[bool] = True

    little: float = 0.01
    much: float = 0.05
    predictable: float = 0.3
    disturbed: float = 0.1
    stands: float = 10.0
    borne_out: float = 2.0
    most_left: float = 0.2
    worse: float = 1.5
    outgrows: float = 6.25

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        problem, effects = candidate.problem, candidate.effects
        harmed = self._harmed(candidate)
        held, fitted = (left_shares(candidate, part) for part in ("holdout", "fit"))
        needed = self._needed(candidate, held, fitted)
        doubtful = may_be_its_error(problem, effects)
        if not needed and not harmed and not doubtful and problem.missed is None:
            return ()
        least = np.maximum(self._ignored(candidate), [needed.get(j, 0.0) for j in range(problem.n_dof)])
        asked = (self._asked(candidate, i, least, held, fitted, harmed, doubtful) for i in candidate.indices)
        return tuple(r for r in asked if r is not None)

    def _needed(self, candidate: Candidate, held: Shares, fitted: Shares) -> Shares:
        """By joint, the share of its mismatch that an effect must explain there."""
        both = {j: min(s, fitted.get(j, 0.0)) for j, s in held.items()}
        needed = {j: s for j, s in both.items() if s > self.little}
        if was_learned(candidate.problem.nominal):  # the error of a network is a function of the arm's state, too
            return needed
        undecided = _undecided(candidate, needed | self._of_physics(held))
        predictable = self._predictable(candidate, {j: held[j] for j in undecided if held.get(j, 0.0) > self.little})
        disturbance = {j: self.disturbed * s for j, s in needed.items() if j not in predictable}
        return needed | disturbance | self._of_physics(predictable)

    def _of_physics(self, predictable: Shares) -> Shares:
        """By joint, what is asked beside a predictable residual that is too large for the shape of a named law."""
        return {j: self.stands * s for j, s in predictable.items() if s > self.much}

    def _is_borne_out(self, candidate: Candidate, index: int, share: float, joint: int) -> bool:
        """Whether the identified layer bears an effect out, and leaves half of the share that it explains or less."""
        if was_learned(candidate.problem.nominal):  # the layer would bear out what the network has wrong
            return False
        found, effect = candidate.identified, candidate.effects[candidate.indices.index(index)]
        if found is None or not is_borne_out(found, effect):
            return False
        return share >= max(self.borne_out * candidate.left_by_layer[joint], self._ignored(candidate)[joint])

    def _asked(
        self,
        candidate: Candidate,
        index: int,
        least: np.ndarray,
        held: Shares,
        fitted: Shares,
        harmed: dict[int, list[Name]],
        doubtful: frozenset[Name],
    ) -> Rejection | None:
        """A rejection of one effect, or None where it may stay."""
        h, part = candidate.library.hypotheses[index], candidate.holdout_gain[index]
        at = max(part.at_joints, key=lambda j: part.shares[j] - least[j])
        share, joint = float(part.shares[at]), candidate.problem.joints[at]
        explains = any(part.shares[j] >= least[j] for j in part.at_joints)
        if not explains and not self._is_borne_out(candidate, index, share, at):
            known = float(self._ignored(candidate)[at])
            detail = _too_little(joint, share, float(least[at]), known / self.outgrows if known >= least[at] else 0.0)
            return self.rejection(candidate, index, share, float(least[at]), detail)
        if h.place in doubtful and not outshines(part, self.stands, held, fitted):
            detail = (
                f"it may be the error of the learned model: at {joint} it explains less than ten times what is left"
            )
            return self.rejection(
                candidate, index, share, self.stands * max(held.get(at, 0.0), fitted.get(at, 0.0)), detail
            )
        if any(h.place in names for names in harmed.values()) and not self._stands_elsewhere(
            h.law.reaches_all, part, {*harmed}, held
        ):
            detail = "with it the held-out torque of a joint is predicted worse than by the nominal model"
            return self.rejection(candidate, index, 1.0, self.worse, detail)
        return None

    def _stands_elsewhere(self, arm_wide: bool, part: HoldoutGain, harmed: set[int], held: Shares) -> bool:
        """Whether an arm-wide effect alone explains a joint that is not harmed: harm may come of another's physics."""
        explained = (j for j in part.at_joints if j not in harmed and held.get(j, 0.0) < self.most_left)
        return arm_wide and any(part.shares[j] > 1.0 - self.most_left for j in explained)

    def _ignored(self, candidate: Candidate) -> np.ndarray:
        """Share of each joint's held-out mismatch that may be the nominal model's own known error, shape (dof,)."""
        missed = candidate.problem.missed
        if missed is None:
            return np.zeros(candidate.problem.n_dof)
        return self.outgrows * missed**2 / np.maximum(_power(candidate.residual("holdout", ())), 1e-300)

    def _harmed(self, candidate: Candidate) -> dict[int, list[Name]]:
        """Joints that the effects make worse on held-out motion, with those whose torque there exceeds the mismatch."""
        noise = candidate.noise
        before, after = (_power(candidate.residual("holdout", e)) for e in ((), None))
        worse = np.flatnonzero(after > self.worse * np.maximum(before, noise**2))
        if not worse.size:
            return {}
        alone = {(e.effect, e.joint): _power(candidate.torque("holdout", e)) for e in candidate.effects}
        largest = {int(j): max(p[j] for p in alone.values()) for j in worse}
        limits = {j: min(max(before[j], noise[j] ** 2), largest[j]) for j in largest}
        return {j: [name for name, power in alone.items() if power[j] >= limits[j]] for j in largest}

    def _predictable(self, candidate: Candidate, shares: Shares) -> Shares:
        """Those of the joints whose residual is predictable from the state, by trees or by the identified layer."""
        kept = 1.0 - self.predictable
        return {
            j: s
            for j, s in shares.items()
            if _trees_predict(candidate, j, self.predictable) or candidate.left_by_layer[j] < kept * s
        }


def _undecided(candidate: Candidate, most: Shares) -> set[int]:
    """Joints of the effects that explain less than the most that may be asked of them, at each of their joints."""
    parts = (candidate.holdout_gain[i] for i in candidate.indices)
    short = (p for p in parts if all(p.shares[j] < most.get(j, 0.0) for j in p.at_joints))
    return {int(j) for part in short for j in part.at_joints}


def outshines(part: HoldoutGain, stands: float, *remainders: Shares) -> bool:
    """Whether an effect explains many times the residual at its strongest joint, both in the fit and held out."""
    most = max(part.at_joints, key=lambda j: part.shares[j])
    return bool(part.shares[most] >= stands * max(shares.get(most, 0.0) for shares in remainders))


def left_shares(candidate: Candidate, part: Part) -> Shares:
    """Joints with a residual above the noise, and (mean r² − σ²) / (mean r_nominal² − σ²) of each."""
    if not candidate.effects:
        return {}
    power = candidate.noise**2
    before, after = (_power(candidate.residual(part, e)) - power for e in ((), None))
    above = (before > 0) & (after > (candidate.limits.above_noise**2 - 1.0) * power)
    return {int(j): float(after[j] / before[j]) for j in np.flatnonzero(above)}


def _too_little(joint: str, share: float, least: float, known: float) -> str:
    """The reason for a rejection by shares of a joint's mismatch; more than all of it cannot be asked for.

    Args:
        known: the model's known error, as a share, where that is the reason; else 0.
    """
    explains = f"it explains {percent(share, 3)} of {joint}"
    if known:
        return f"{explains}, too little beside the known error of the model, {percent(known, 3)}"
    if least < 1.0:
        return f"{explains}, where more than {percent(least, 3)} is asked for"
    return f"{explains}, beside too much that motion predicts and no effect explains"


def _trees_predict(candidate: Candidate, joint: int, least: float) -> bool:
    """Whether a share of a joint's residual can be predicted: held out, or in every second part of the fit."""
    problem, seed = candidate.problem, candidate.seed
    seen, fresh = signals_of(problem, problem.fit), signals_of(problem, problem.holdout)
    residual, test = (candidate.residual(part)[:, joint] for part in ("fit", "holdout"))
    counts = np.concatenate([p.counts for p in problem.fit])[:, joint]
    if is_predictable(Examples(joint, seen, residual, counts, fresh, test), seed, least):
        return True
    one, other = every_second_part(len(counts))
    halves = Examples(joint, seen.only(one), residual[one], counts[one], seen.only(other), residual[other])
    return is_predictable(halves, seed, least)


def _power(x: np.ndarray) -> np.ndarray:
    return np.mean(x**2, axis=0)
