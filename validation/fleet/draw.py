"""Draws a fleet: what each robot is like, what becomes of it over a year, and at which temperatures it is recorded."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from datetime import datetime, timedelta
from typing import Any

import numpy as np

from validation.fleet.arms import MAKES

START = datetime(2025, 1, 6, 8, 0)
YEAR = 365.0  # [days]
REFERENCE = 25.0  # temperature at which friction is stated [°C]
WEAR = 0.15  # growth of the friction of one joint over the year
GAIN = (0.06, 0.12)  # change of a torque gain
TOOL = (0.15, 0.4)  # mass of another tool [kg]
ODD = 1.6  # friction of the odd one over that of its sisters
TYPICAL = {"viscous": (1.2, 0.8, 0.5), "dry": (1.4, 1.0, 0.6)}  # friction of the joints from the base outwards


@dataclass(frozen=True)
class Fate:
    """What becomes of a robot.

    Args:
        kind: steady, wear, warm, tool, gain or odd.
        joint: index of the joint that it concerns; -1 for all.
        size: growth of friction, mass of the tool [kg] or change of the gain.
        since: index of the first recording that shows it.
    """

    kind: str
    joint: int = -1
    size: float = 0.0
    since: int = 0


@dataclass(frozen=True)
class PlannedRobot:
    """One robot of the fleet, with friction at 25 °C and its growth per kelvin."""

    name: str
    make: str
    viscous: tuple[float, ...]
    dry: tuple[float, ...]
    per_kelvin: float
    fate: Fate
    dates: tuple[datetime, ...]
    temperatures: tuple[float, ...]

    def plain(self) -> dict[str, Any]:
        """Plain values for the envelope."""
        return asdict(self) | {"dates": [d.isoformat() for d in self.dates]}


def draw_fleet(n_robots: int, n_recordings: int, seed: int) -> list[PlannedRobot]:
    """A fleet in which a fifth wears and a quarter warms up, with one other tool, one changed gain, one odd robot."""
    rng = np.random.default_rng(seed)
    n_wear, n_warm = max(1, round(0.2 * n_robots)), max(1, round(0.25 * n_robots))
    kinds = ["wear"] * n_wear + ["warm"] * n_warm + ["tool", "gain", "odd"]
    kinds += ["steady"] * (n_robots - len(kinds))
    kinds = [kinds[i] for i in rng.permutation(n_robots)]
    return [_robot(i, kind, n_recordings, rng) for i, kind in enumerate(kinds)]


def _robot(index: int, kind: str, n: int, rng: np.random.Generator) -> PlannedRobot:
    make = [*MAKES][index % len(MAKES)]
    dof = len(MAKES[make])
    level = rng.lognormal(0.0, 0.07, (2, dof))
    joint = int(rng.integers(dof))
    since = int(rng.integers(3, n - 2)) if n > 5 else n // 2
    fate = {
        "wear": Fate("wear", joint, WEAR, 1),
        "tool": Fate("tool", -1, float(rng.uniform(*TOOL)), since),
        "gain": Fate("gain", dof - 1, float(rng.choice([-1, 1]) * rng.uniform(*GAIN)), since),
        "odd": Fate("odd", joint, ODD - 1.0, 0),
    }.get(kind, Fate(kind))
    if kind == "odd":
        level[:, joint] *= ODD
    days = np.linspace(0.0, YEAR, n) + np.append(0.0, rng.uniform(-6.0, 6.0, n - 1))
    return PlannedRobot(
        name=f"{make}_{index:03d}",
        make=make,
        viscous=tuple(float(x) for x in level[0] * TYPICAL["viscous"][:dof]),
        dry=tuple(float(x) for x in level[1] * TYPICAL["dry"][:dof]),
        per_kelvin=float(-0.02 * rng.lognormal(0.0, 0.2)),
        fate=fate,
        dates=tuple(START + timedelta(days=float(d)) for d in days),
        temperatures=tuple(float(x) for x in _temperatures(kind, n, rng)),
    )


def _temperatures(kind: str, n: int, rng: np.random.Generator) -> np.ndarray:
    """Steady within a kelvin; warm robots rise or fall by 8 to 14 K over the year, or follow its seasons."""
    steady = rng.uniform(22.0, 30.0) + rng.normal(0.0, 0.7, n)
    if kind != "warm":
        return steady
    span, share = float(rng.choice([-1, 1]) * rng.uniform(8.0, 14.0)), np.linspace(0.0, 1.0, n)
    course = share if rng.random() < 0.6 else np.sin(np.pi * share)
    return steady + span * course
