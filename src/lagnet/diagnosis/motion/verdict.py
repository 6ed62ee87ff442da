"""The verdict of a diagnosis on motion: the same values as on torque, with errors of position beside them."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import Any

from lagnet.diagnosis.verdict.verdict import EffectFound, Verdict


@dataclass(frozen=True)
class PositionErrors:
    """Root mean square error of a joint's held-out rollouts [rad or m].

    Args:
        rmse_nominal, rmse_named, rmse_corrected: of the nominal model, with the named effects, of the correction.
        rmse_resolution: quantisation error of the encoder, which a perfect model has.
    """

    rmse_nominal: float
    rmse_named: float
    rmse_corrected: float
    rmse_resolution: float


@dataclass(frozen=True)
class MotionVerdict:
    """All that a diagnosis on motion concluded; `to_dict` is valid under verdict.schema.json.

    Args:
        verdict: the part that both routes have; its residuals are positions [rad or m].
        errors: of each joint in model order.
        servo: source of the nominal servos, and the laws before and after.
        rest: friction band of each joint at rest, None where it seldom rests.
        rejected: effects that were considered and not named, with the rule.
    """

    verdict: Verdict
    errors: tuple[PositionErrors, ...]
    servo: dict[str, Any]
    rest: tuple[dict[str, Any] | None, ...]
    rejected: tuple[dict[str, Any], ...]

    @property
    def effects(self) -> tuple[EffectFound, ...]:
        """The physics that was left out, strongest first."""
        return self.verdict.effects

    @property
    def found(self) -> bool:
        """Whether any joint's nominal motion differs from the recorded one by more than the encoder's step."""
        return self.verdict.found

    def to_dict(self) -> dict[str, Any]:
        """Plain values, every number finite."""
        plain = self.verdict.to_dict()
        for entry, errors in zip(plain["fit"], self.errors, strict=True):
            entry.update(asdict(errors))
        return {
            **plain,
            "route": "motion",
            "servo": self.servo,
            "rest": list(self.rest),
            "rejected": list(self.rejected),
        }

    def to_json(self) -> str:
        """The text of verdict.json."""
        return json.dumps(self.to_dict(), indent=1, allow_nan=False, ensure_ascii=False) + "\n"
