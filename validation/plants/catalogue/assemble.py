"""The true arm and measuring chain of a plan: every hidden cause as bodies, pulls, surfaces, gears or signal."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from validation.plants.arm.bodies import PinocchioBodies
from validation.plants.arm.events import Grasp, Push
from validation.plants.arm.gears import Gear
from validation.plants.arm.pulls import Drag, Field, MaxwellSlip, Pull
from validation.plants.arm.surfaces import Loaded, Plain, Surface
from validation.plants.body import BodySettings, Payload, arm_joints, joint_names
from validation.plants.catalogue.plan import Plan
from validation.plants.catalogue.scale import LEAD
from validation.plants.catalogue.unlisted import UNLISTED
from validation.plants.spec import Hidden

SLIDERS = 6


@dataclass
class Parts:
    """The parts of a true arm as they are put together; numbers are those of the hidden causes."""

    dof: int
    payload: Payload | None = None
    tilt: tuple[float, float] = (0.0, 0.0)
    links: list[tuple[str, float, tuple[float, float, float]]] = field(default_factory=list)
    armature: np.ndarray = field(init=False)
    angle_offset: np.ndarray = field(init=False)
    gain: np.ndarray = field(init=False)
    offset: np.ndarray = field(init=False)
    delay: np.ndarray = field(init=False)
    ceiling: np.ndarray = field(init=False)
    pulls: list[tuple[int, Pull]] = field(default_factory=list)
    surfaces: list[tuple[int, Surface]] = field(default_factory=list)
    gears: list[tuple[int, Gear]] = field(default_factory=list)
    grasps: list[Grasp] = field(default_factory=list)

    def __post_init__(self) -> None:
        for name in ("armature", "angle_offset", "offset", "delay"):
            setattr(self, name, np.zeros(self.dof))
        self.gain, self.ceiling = np.ones(self.dof), np.full(self.dof, np.inf)

    @property
    def body(self) -> BodySettings:
        """What the true bodies have."""
        return BodySettings(self.payload, self.tilt, tuple(self.links))


Put = Callable[[Parts, int, int, str | None, dict[str, float]], None]  # parts, number, joint index, name, values


def _ripple(parts: Parts, i: int, j: int, name: str | None, x: dict[str, float]) -> None:
    """Cogging with a tenth of its second harmonic."""

    def law(t: float, q: np.ndarray) -> float:
        angle = x["N"] * q[j] + x["phase"]
        return -x["amplitude"] * float(np.sin(angle) + 0.1 * np.sin(2 * angle + 1.0))

    parts.pulls.append((i, Field(j, law)))


def _sliders(parts: Parts, i: int, j: int, name: str | None, x: dict[str, float]) -> None:
    """Equal sliders that let go at evenly spaced distances up to the reach."""
    slips = x["reach"] * (np.arange(SLIDERS) + 1) / SLIDERS
    levels = np.full(SLIDERS, x["Fc"] / SLIDERS)
    parts.pulls.append((i, MaxwellSlip(j, levels / slips, levels)))


def _payload(parts: Parts, i: int, j: int, name: str | None, x: dict[str, float]) -> None:
    parts.payload = Payload(x["m"], (x["cx"], x["cy"], x["cz"]), x["radius"])


def _tilt(parts: Parts, i: int, j: int, name: str | None, x: dict[str, float]) -> None:
    parts.tilt = (x["theta_1"], x["theta_2"])


def _at(array: str, key: str) -> Put:
    def put(parts: Parts, i: int, j: int, name: str | None, x: dict[str, float]) -> None:
        getattr(parts, array)[j] = x[key]

    return put


def _surface(make: Callable[[tuple[tuple[int, float], ...], dict[str, float]], Surface]) -> Put:
    return lambda parts, i, j, name, x: parts.surfaces.append((i, make(((j, 1.0),), x)))


PHYSICS: dict[str, Put] = {
    "viscous_friction": lambda p, i, j, name, x: p.pulls.append((i, Drag(j, x["Fv"]))),
    "quadratic_drag": lambda p, i, j, name, x: p.pulls.append((i, Drag(j, x["Fd"], 2.0))),
    "joint_spring": lambda p, i, j, name, x: p.pulls.append((i, Field(j, lambda t, q: -x["k"] * (q[j] - x["q0"])))),
    "rotor_inertia": _at("armature", "Ia"),
    "coulomb_friction": _surface(lambda ways, x: Plain(ways, x["Fc"], x["Fc"])),
    "asymmetric_friction": _surface(lambda ways, x: Plain(ways, x["Fc_plus"], x["Fc_minus"])),
    "stribeck_friction": _surface(lambda ways, x: Plain(ways, x["Fc"], x["Fc"], x["Fs"], x["vs"])),
    "load_dependent_friction": _surface(lambda ways, x: Loaded(ways, x["K"])),
    "presliding_hysteresis": _sliders,
    "torque_ripple": _ripple,
    "payload": _payload,
    "gravity_tilt": _tilt,
    "link_inertia": lambda p, i, j, name, x: p.links.append((str(name), x["factor"], (x["dx"], x["dy"], x["dz"]))),
    "encoder_offset": _at("angle_offset", "delta"),
    "torque_gain": _at("gain", "g"),
    "torque_offset": _at("offset", "b"),
    "time_delay": _at("delay", "T"),
    "saturation": _at("ceiling", "tau_max"),
    "joint_elasticity": lambda p, i, j, name, x: p.gears.append((i, Gear(j, x["K"], x["damping"], x["rotor"]))),
    "backlash": lambda p, i, j, name, x: p.gears.append((i, Gear(j, x["K"], x["damping"], x["rotor"], x["h"]))),
}
"""How each name enters the plant."""


def assemble(plan: Plan, recording: int = 0) -> Parts:
    """All that a plan hides in one of its recordings, put together.

    Raises:
        ValueError: a name without physics.
    """
    names = joint_names(plan.robot)
    parts = Parts(len(names))
    lasting_first = sorted(enumerate(plan.hidden), key=lambda entry: "t0" in entry[1].values)
    for i, hidden in lasting_first:
        j = -1 if hidden.joint is None else names.index(hidden.joint)
        kind = hidden.effect.removeprefix("unlisted:")
        if "t0" in hidden.values:
            if hidden.values["recording"] == recording:
                _happen(parts, plan, i, hidden)
        elif kind != hidden.effect:
            pulls, surfaces = UNLISTED[kind].build(j, len(names), hidden.values)
            parts.pulls += [(i, pull) for pull in pulls]
            parts.surfaces += [(i, surface) for surface in surfaces]
        elif hidden.effect in PHYSICS:
            PHYSICS[hidden.effect](parts, i, j, hidden.joint, hidden.values)
        else:
            raise ValueError(f"no plant physics for {hidden.effect}; known: {', '.join(PHYSICS)}")
    return parts


def _happen(parts: Parts, plan: Plan, i: int, hidden: Hidden) -> None:
    """A load that is carried, or a push that acts, for a while: the clock of a run starts at its lead."""
    x = hidden.values
    start, end = x["t0"] + LEAD, x["t1"] + LEAD
    if hidden.effect == "payload":
        load = Payload(x["m"], (x["cx"], x["cy"], x["cz"]), x["radius"])
        settings = BodySettings(load, parts.tilt, tuple(parts.links))
        parts.grasps.append(Grasp(PinocchioBodies(plan.robot, settings), start, end))
        return
    force, point = (np.array([x[f"{letter}{axis}"] for axis in "xyz"]) for letter in "Fp")
    joint = arm_joints(plan.robot)[-1]  # the name is of what the arm does to its surroundings
    parts.pulls.append((i, Push(PinocchioBodies(plan.robot), joint, -force, point, start, end)))
