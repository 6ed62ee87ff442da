"""The verdict as frozen values that mirror verdict.schema.json."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from typing import Any

SCHEMA = "lagnet-verdict/1"


@dataclass(frozen=True)
class NamedParameter:
    """A fitted parameter with its 95 % interval."""

    name: str
    value: float
    unit: str
    ci95: tuple[float, float]


@dataclass(frozen=True)
class EffectEvidence:
    """Why an effect is named."""

    holdout_nmse_without: float
    holdout_nmse_with: float
    share_of_mismatch: float
    best_rival: str | None
    log10_odds_over_best_rival: float | None


@dataclass(frozen=True)
class EffectFound:
    """Physics that was left out. `joint` is None for an effect of the whole arm.

    What acts for a while only has the interval and the recording in which it does.
    """

    effect: str
    joint: str | None
    status: str
    tied_with: tuple[str, ...]
    parameters: tuple[NamedParameter, ...]
    evidence: EffectEvidence
    explanation: str
    interval_s: tuple[float, float] | None = None
    recording: str | None = None

    def value(self, parameter: str) -> float:
        """The fitted value of a parameter by name."""
        return next(p.value for p in self.parameters if p.name == parameter)


@dataclass(frozen=True)
class JointMismatch:
    """Where and how much one joint's nominal torque is off."""

    joint: str
    significant: bool
    residual_rms: float
    noise_rms: float
    nmse_nominal: float
    where: tuple[dict[str, Any], ...]


@dataclass(frozen=True)
class Unexplained:
    """What is left at a joint after the named physics, and a formula of its signals where a simple one holds most."""

    joint: str
    above_noise: bool
    share_of_mismatch: float
    depends_on: tuple[str, ...]
    formula: str | None = None


@dataclass(frozen=True)
class JointFit:
    """Errors of one joint on the held-out recordings."""

    joint: str
    nmse_nominal: float
    nmse_named: float
    nmse_named_and_residual_network: float | None
    nmse_noise_floor: float


@dataclass(frozen=True)
class Abstained:
    """An effect on which the recordings say nothing, and what to record to hear of it."""

    effect: str
    joint: str | None
    reason: str
    record_next: str


@dataclass(frozen=True)
class Verdict:
    """All that a diagnosis concluded; `to_dict` is valid under verdict.schema.json."""

    lagnet_version: str
    seed: int
    nominal: dict[str, Any]
    recordings: tuple[dict[str, Any], ...]
    conditioning: dict[str, Any]
    joints: tuple[JointMismatch, ...]
    effects: tuple[EffectFound, ...]
    unexplained: tuple[Unexplained, ...]
    fit: tuple[JointFit, ...]
    abstentions: tuple[Abstained, ...]
    warnings: tuple[str, ...]

    @property
    def found(self) -> bool:
        """Whether any joint differs from its nominal torque by more than noise explains."""
        return any(j.significant for j in self.joints)

    def to_dict(self) -> dict[str, Any]:
        """Plain values, every number finite."""
        plain = asdict(self)
        joints = plain.pop("joints")
        for effect in plain["effects"]:
            if effect["recording"] is None:
                del effect["recording"]
        ordered = {"schema": SCHEMA, "lagnet_version": plain.pop("lagnet_version"), "seed": plain.pop("seed")}
        for name in ("nominal", "recordings", "conditioning"):
            ordered[name] = plain.pop(name)
        ordered["mismatch"] = {"found": self.found, "joints": joints}
        return _finite(ordered | plain)

    def to_json(self) -> str:
        """The text of verdict.json."""
        return json.dumps(self.to_dict(), indent=1, allow_nan=False, ensure_ascii=False) + "\n"


def _finite(node: Any) -> Any:
    """Numbers that JSON can hold: infinities become the largest float, and a number that is none becomes zero."""
    if isinstance(node, dict):
        return {k: _finite(v) for k, v in node.items()}
    if isinstance(node, (list, tuple)):
        return [_finite(v) for v in node]
    if isinstance(node, float) and not math.isfinite(node):
        return 0.0 if math.isnan(node) else math.copysign(1.7976931348623157e308, node)
    return node
