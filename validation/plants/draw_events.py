"""Draw plants in which something happens for a while: a push, or a load that is picked up."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from validation.plants.body import GRAVITY
from validation.plants.draw import draw_plant
from validation.plants.simulate import FIT_SHAPES
from validation.plants.sizes import scale_of
from validation.plants.spec import Hidden, PlantSpec

ROBOTS = ("ur5", "panda", "ur10")
SIZES = (0.05, 0.5)  # of the joints' torque while it lasts
KINDS = ("contact_force", "payload")


def draw_event_plant(
    seed: int,
    number: int = 0,
    event: str | None = "contact_force",
    beside: Sequence[str] = (),
    robots: Sequence[str] = ROBOTS,
) -> PlantSpec:
    """A plant with one event in one of its fitted recordings, and one lasting effect if kinds are given for it."""
    spec = draw_plant(seed, number, beside or ("payload",), 1 if beside else 0, robots)
    rng = np.random.default_rng([seed, number, 1])
    hidden = () if event is None else (draw_event(event, spec.robot, spec.duration, rng),)
    return replace(spec, hidden=(*spec.hidden, *hidden))


def draw_event(event: str, robot: str, duration: float, rng: np.random.Generator) -> Hidden:
    """A push or a grasp of some seconds in one of the recordings."""
    scale = scale_of(robot)
    size = float(np.exp(rng.uniform(*np.log(SIZES))))
    length = rng.uniform(1.5, 6.0) if event == "contact_force" else rng.uniform(0.3, 0.7) * duration
    start = rng.uniform(2.0, duration - length - 2.0)
    end = duration if event == "payload" and rng.random() < 0.5 else start + length
    place = {"t0": start, "t1": end, "recording": float(rng.integers(len(FIT_SHAPES)))}
    point = rng.uniform((-0.04, -0.04, 0.0), (0.04, 0.04, 0.12))
    mass = float(np.clip(size / scale.payload_share, 0.02, 10.0))
    if event == "payload":
        values = {"m": mass, **dict(zip(("cx", "cy", "cz"), map(float, point), strict=True)), "radius": 0.04}
    else:
        force = rng.normal(size=3)
        force *= GRAVITY * mass / np.linalg.norm(force)
        names = ("Fx", "Fy", "Fz", "px", "py", "pz")
        values = dict(zip(names, map(float, (*force, *point)), strict=True))
    return Hidden(event, None, values | place, mass * scale.payload_share)
