"""Which unit a column has, by the factors between it and the model's torque at all joints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

UNITS = {"N m": 1.0, "N mm": 1000.0, "N cm": 100.0, "kgf cm": 10.19716}
MODEL_ERRORS = (0.03, 0.1, 0.3)  # by how much the heaviest nominal torque may be wrong; each as likely
ODD_JOINT = 0.15  # share of joints whose nominal torque may be far off: unmodelled tools on light wrists
ODD_SPREAD = 1.2
# Amperes per N m at the joint: geared servos of 0.5 N m to robots of 300 N m have 0.05 to 3; the same in mA; any other.
CURRENT_SIZES = ((0.5, np.log(0.15), 1.2), (0.25, np.log(150.0), 1.2), (0.25, 0.0, 3.0))
CURRENT_SPREADS = (0.5, 1.5)  # of log A per N m over the joints of one robot: alike drives, and unlike ones
COMMON_ERROR = 0.15  # of all nominal torques alike: a tool that the model does not have
PRIOR_CURRENT = 0.5
PRIOR_OF_UNIT = {"N mm": 0.05, "N cm": 0.002, "kgf cm": 0.002}  # hardly any driver publishes the last two
GRID = np.linspace(-4.0, 4.0, 161)  # standard deviations at which an unknown centre is tried
WEIGHTS = np.exp(-0.5 * GRID**2) / np.sum(np.exp(-0.5 * GRID**2))


@dataclass(frozen=True)
class UnitOdds:
    """How likely each unit is.

    Args:
        likely: unit, or "current" for factors of a drive's own, to its probability; they sum to one.
        scale: per joint the column's units in one N m, with its standard deviation.
    """

    likely: dict[str, float]
    scale: tuple[tuple[float, float], ...]

    @property
    def best(self) -> str:
        """The most likely unit."""
        return max(self.likely, key=lambda unit: self.likely[unit])


def unit_odds(scale: Sequence[tuple[float, float]], load: Sequence[float]) -> UnitOdds:
    """Compare a unit of torque, the same at all joints, with currents, whose factors differ from joint to joint.

    Args:
        scale: per joint that can be judged its factor and standard deviation.
        load: per joint the size of its nominal torque [N m]; what a model misses, such as a tool, is a larger part of a
            lighter joint's torque.
    """
    relative = np.array([min(sigma / abs(s), 10.0) for s, sigma in scale])
    logs = np.log(np.abs([s for s, _ in scale]))
    lighter = np.sqrt(max(load) / np.maximum(load, 1e-12 * max(load)))
    evidence = {}
    rest = 1.0 - PRIOR_CURRENT - sum(PRIOR_OF_UNIT.values())
    spreads = [np.hypot(e * lighter, relative) for e in MODEL_ERRORS]
    for unit, factor in UNITS.items():
        centre = ((1.0, np.log(factor), COMMON_ERROR),)
        prior = PRIOR_OF_UNIT.get(unit, rest)
        evidence[unit] = np.log(prior) + _mean([_log_evidence(logs, spread, centre) for spread in spreads])
    wider = [np.hypot(spread, own) for spread in spreads for own in CURRENT_SPREADS]
    evidence["current"] = np.log(PRIOR_CURRENT) + _mean([_log_evidence(logs, s, CURRENT_SIZES) for s in wider])
    total = np.logaddexp.reduce(list(evidence.values()))
    return UnitOdds({unit: float(np.exp(e - total)) for unit, e in evidence.items()}, tuple(scale))


def _log_evidence(logs: np.ndarray, sigma: np.ndarray, centres: Sequence[tuple[float, float, float]]) -> float:
    """Of logarithms around a centre that is drawn from normals, each (weight, mean, spread).

    Most joints are as near to the centre as `sigma`, some much further.
    """
    weight, mean, spread = (np.array(column)[:, None] for column in zip(*centres, strict=True))
    centre = (mean + spread * GRID).ravel()
    x = logs - centre[:, None]
    near, far = (-0.5 * (x / s) ** 2 - np.log(s) for s in (sigma, np.hypot(ODD_SPREAD, sigma)))
    mixed = np.logaddexp(np.log(1 - ODD_JOINT) + near, np.log(ODD_JOINT) + far)
    each = np.sum(mixed - 0.5 * np.log(2 * np.pi), axis=1)
    return float(np.logaddexp.reduce(each + np.log(weight * WEIGHTS).ravel()))


def _mean(logs: Sequence[float]) -> float:
    return float(np.logaddexp.reduce(logs) - np.log(len(logs)))
