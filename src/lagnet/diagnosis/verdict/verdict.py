"""The verdict as frozen values that mirror verdict.schema.json."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any

from lagnet.errors import DiagnosisError
from lagnet.recordings.quality.finding import Finding

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
    """Held-out nMSE without and with an effect, its share of the mismatch, and the odds over its best rival."""

    holdout_nmse_without: float
    holdout_nmse_with: float
    share_of_mismatch: float
    best_rival: str | None
    log10_odds_over_best_rival: float | None


@dataclass(frozen=True)
class EffectFound:
    """Physics that the nominal model lacks. `joint` is None for an effect of the whole arm.

    A transient has the interval and the recording in which it acts; both are None for persistent effects. `also_at`
    holds the other joints at which it would explain as much, where recordings do not tell which link has a mass.
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
    also_at: tuple[str, ...] = ()

    def value(self, parameter: str) -> float:
        """The fitted value of a parameter by name."""
        return next(p.value for p in self.parameters if p.name == parameter)


@dataclass(frozen=True)
class JointMismatch:
    """The nominal residual of one joint: its size, noise, and the regimes of motion in which it is large."""

    joint: str
    significant: bool
    residual_rms: float
    noise_rms: float
    nmse_nominal: float
    where: tuple[dict[str, Any], ...]


@dataclass(frozen=True)
class Unexplained:
    """The remainder of a joint after the named physics, and a simple formula of its signals where one predicts most."""

    joint: str
    above_noise: bool
    share_of_mismatch: float
    depends_on: tuple[str, ...]
    formula: str | None = None


@dataclass(frozen=True)
class JointFit:
    """nMSE of one joint on the held-out recordings, layer by layer."""

    joint: str
    nmse_nominal: float
    nmse_named: float
    nmse_named_and_residual_network: float | None
    nmse_noise_floor: float
    nmse_identified: float | None = None
    nmse_full: float | None = None


@dataclass(frozen=True)
class Abstained:
    """An effect that the recordings cannot determine, and the motion that would."""

    effect: str
    joint: str | None
    reason: str
    record_next: str


@dataclass(frozen=True)
class Rejected:
    """An effect that was considered and not named, with the rule, its value, its limit and the reason."""

    effect: str
    joint: str | None
    rule: str
    value: float
    limit: float
    detail: str


@dataclass(frozen=True)
class Verdict:
    """The conclusions of a diagnosis; `to_dict` is valid under verdict.schema.json."""

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
    data_quality: tuple[dict[str, Any], ...] = ()
    rejected: tuple[Rejected, ...] = ()
    limits: dict[str, Any] = field(default_factory=dict)
    identified: dict[str, Any] = field(default_factory=dict)

    @property
    def found(self) -> bool:
        """Whether any joint's nominal residual is significantly larger than its noise."""
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


def with_data_quality(verdict: Verdict, findings: Sequence[Finding]) -> Verdict:
    """The verdict with faults of its data, those that were corrected or are not certain also before all warnings."""
    sentences = tuple(finding.sentence() for finding in findings)
    data = tuple(finding.to_dict() for finding in findings)
    return replace(verdict, warnings=(*sentences, *verdict.warnings), data_quality=data)


def _finite(node: Any, where: str = "verdict") -> Any:
    """Numbers that JSON can hold: infinities become the largest float.

    Raises:
        DiagnosisError: some figure is not a number; as 0.0 it would read as perfect.
    """
    if isinstance(node, dict):
        return {k: _finite(v, f"{where}.{k}") for k, v in node.items()}
    if isinstance(node, (list, tuple)):
        return [_finite(v, f"{where}[{n}]") for n, v in enumerate(node)]
    if isinstance(node, float) and math.isnan(node):
        raise DiagnosisError("a figure of the verdict is not a number", where=where, next_step="please report this")
    if isinstance(node, float) and math.isinf(node):
        return math.copysign(sys.float_info.max, node)
    return node
