"""Hold every verdict against its opened envelope and the witness of its plant."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path

from validation.concealed.fair_names import Claim, claims_of, is_beside, is_part_of_a_tie, joints_of, match
from validation.concealed.parameters import errors_of
from validation.plants.catalogue.plan import Plan, opened
from validation.plants.catalogue.witness import Witness, read_witness


@dataclass(frozen=True)
class Answer:
    """What became of one hidden cause.

    Args:
        effect, joint, size: as hidden.
        shown: whether the recordings can show it; a cause that they hide is not asked for.
        how: "alone", "tied", "same torque", "missed"; for unlisted causes "unnamed".
        noticed: of unlisted causes, whether the verdict says that something at the joint is unexplained.
    """

    effect: str
    joint: str | None
    size: float
    shown: bool
    how: str
    noticed: bool | None = None


@dataclass(frozen=True)
class Score:
    """One plant's verdict against its truth.

    Args:
        plant, group, robot: of which.
        answers: one for each hidden cause.
        claims: (effect, joint, tied names, "right", "beside" or "wrong").
        joint_right, joint_judged: of the claims that name a hidden effect, those on its joint, and all.
        errors, covered: see `parameters`.
        gain_share, gain_share_with_rest: see `gain`; None where nothing or something unlisted was hidden.
        seconds, processor_seconds: of the diagnosis.
        failure: why there is no verdict.
        code: fingerprint of the lagnet that gave it.
    """

    plant: str
    group: str
    robot: str
    answers: list[Answer]
    claims: list[tuple[str, str | None, list[str], str]] = field(default_factory=list)
    joint_right: int = 0
    joint_judged: int = 0
    errors: dict[str, float] = field(default_factory=dict)
    covered: dict[str, bool] = field(default_factory=dict)
    gain_share: float | None = None
    gain_share_with_rest: float | None = None
    seconds: float = 0.0
    processor_seconds: float = 0.0
    failure: str = ""
    code: str = ""

    @property
    def wrong(self) -> int:
        """Claims that match nothing hidden."""
        return sum(claim[3] == "wrong" for claim in self.claims)

    @property
    def right(self) -> int:
        """Claims that name something hidden."""
        return sum(claim[3] == "right" for claim in self.claims)


def read_scores(out: Path) -> list[Score]:
    """Scores of every finished plant in a run's folder, in order; a plant that was never simulated is a failure."""
    scores = [_read(out, file) for file in sorted((out / "envelopes").glob("*.json"))]
    done = {s.plant for s in scores}
    lost = [file for file in sorted((out / "failures").glob("*.txt")) if file.stem not in done]
    return scores + [Score(file.stem, "not simulated", "", [], failure=file.read_text()) for file in lost]


def _read(out: Path, envelope: Path) -> Score:
    plan = opened(envelope.read_bytes())
    witness = read_witness((out / "witnesses" / envelope.name).read_bytes())
    outcome = json.loads((out / "outcomes" / envelope.name).read_text())
    verdict = out / "verdicts" / envelope.name
    return score(plan, witness, json.loads(verdict.read_text()) if verdict.exists() else None, outcome)


def score(plan: Plan, witness: Witness, verdict: dict | None, outcome: dict) -> Score:
    """Score one plant; `outcome` holds seconds, processor_seconds, message and gain_share."""
    claims = [] if verdict is None else claims_of(verdict)
    pairs = match(plan, witness, claims)
    errors: dict[str, float] = {}
    covered: dict[str, bool] = {}
    for i, (c, _) in pairs.items():
        if claims[c].effect == plan.hidden[i].effect and claims[c].joint == plan.hidden[i].joint:
            off, inside = errors_of(plan.hidden[i], claims[c])
            errors |= off
            covered |= inside
    right, judged = _joints(plan, claims, pairs)
    strange = any(h.effect.startswith("unlisted:") for h in plan.hidden)
    return Score(
        plan.name,
        plan.group,
        plan.robot,
        _answers(plan, witness, verdict, pairs),
        _judged_claims(plan, witness, claims, pairs),
        right,
        judged,
        errors,
        covered,
        None if strange else outcome["gain_share"],
        None if strange else outcome["gain_share_with_rest"],
        outcome["seconds"],
        outcome["processor_seconds"],
        outcome["message"] if verdict is None else "",
        outcome.get("code", ""),
    )


def _joints(plan: Plan, claims: list[Claim], pairs: dict[int, tuple[int, str]]) -> tuple[int, int]:
    """Claims that name a hidden effect and stand on its joint, the second half of a tie too, and all that name one."""
    taken = {c for c, _ in pairs.values()}
    hidden = {h.effect for h in plan.hidden}
    naming = [c for c, claim in enumerate(claims) if c in taken or any(name in hidden for name in claim.names)]
    places = {(h.effect, h.joint) for h in plan.hidden}
    there = [c for c in naming if c in taken or any((name, claims[c].joint) in places for name in claims[c].names)]
    return len(there), len(naming)


def _answers(plan: Plan, witness: Witness, verdict: dict | None, pairs: dict[int, tuple[int, str]]) -> list[Answer]:
    answers = []
    for i, (hidden, sight) in enumerate(zip(plan.hidden, witness.sights, strict=True)):
        strange = hidden.effect.startswith("unlisted:")
        how = pairs[i][1] if i in pairs else ("unnamed" if strange else "missed")
        noticed = _noticed(plan, i, verdict) if strange else None
        answers.append(Answer(hidden.effect, hidden.joint, hidden.size, sight.shown, how, noticed))
    return answers


def _noticed(plan: Plan, i: int, verdict: dict | None) -> bool:
    joints = joints_of(plan, plan.hidden[i])
    left = [] if verdict is None else verdict["unexplained"]
    return any(entry["above_noise"] and entry["joint"] in joints for entry in left)


def _judged_claims(
    plan: Plan, witness: Witness, claims: list[Claim], pairs: dict[int, tuple[int, str]]
) -> list[tuple[str, str | None, list[str], str]]:
    taken = {c for c, _ in pairs.values()}
    paired = {i: claims[c] for i, (c, _) in pairs.items()}
    out = []
    for c, claim in enumerate(claims):
        judged = (
            "right"
            if c in taken
            else ("beside" if (is_part_of_a_tie(plan, claim, paired) or is_beside(plan, witness, claim)) else "wrong")
        )
        out.append((claim.effect, claim.joint, list(claim.tied), judged))
    return out
