"""Draws of the listed kinds beyond the first set; a draw that finds no sensible size at a joint gives None."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from validation.plants.catalogue.scale import OwnScale
from validation.plants.draw import FIRST_SET

Values = dict[str, float]
Draw = Callable[[OwnScale, int, float, np.random.Generator], Values | None]
LARGEST_SHIFT = 0.12  # [rad] of encoder errors and bends that a working arm may have
SLOWEST_SWING = 4.0  # [Hz] of a link on its spring: softer arms cannot follow the motions
LARGEST_GAP = 0.05  # [rad], half the gap
FIRST_GAP = 0.004  # [rad], half of it, from which the size is calibrated
FREE_TORQUE = 0.15  # share of the time on the rarer flank below which a gap is hardly ever crossed


def _sign(rng: np.random.Generator) -> float:
    return float(rng.choice([-1.0, 1.0]))


def load_dependent(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values | None:
    """Friction that is a share of the torque carried; its rms over the torque's is that share."""
    return {"K": size}


def ripple(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values | None:
    """A whole number of cogs a turn, at most as many as 100 Hz resolves at the joint's usual speed."""
    most = min(120.0, 0.5 * np.pi * 100 / max(s.speed[j], 0.1))
    orders = float(np.round(np.exp(rng.uniform(np.log(6.0), np.log(most)))))
    return {"N": orders, "amplitude": np.sqrt(2) * size * s.torque[j], "phase": rng.uniform(-np.pi, np.pi)}


def encoder_offset(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values | None:
    """None at an axis that carries nothing: no offset there changes a torque."""
    delta = size / max(s.shift[j], 1e-9)
    return {"delta": _sign(rng) * delta} if delta <= LARGEST_SHIFT else None


def link_inertia(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values | None:
    """A mass (and inertia) factor; None at links too light to matter, and at the last, which is a payload."""
    change = size / max(s.heavier[j], 1e-9)
    if change > 0.8 or j >= np.flatnonzero(s.heavier > 0)[-1]:
        return None
    shift = rng.uniform(-0.01, 0.01, 3)
    factor = 1 + (_sign(rng) if change < 0.5 else 1.0) * change
    return {"factor": factor, "dx": shift[0], "dy": shift[1], "dz": shift[2]}


def elasticity(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values | None:
    """A stiffness that bends so far that torques change by the size."""
    bend = size / max(s.bend[j], 1e-9)
    stiffness = s.torque[j] / bend
    if bend > LARGEST_SHIFT or stiffness < s.mean_inertia[j] * (2 * np.pi * SLOWEST_SWING) ** 2:
        return None
    return _second_mass(s, j, stiffness, rng)


def backlash(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values | None:
    """A gap, to be calibrated; flanks a fiftieth as soft as the gap is wide."""
    if size / max(s.shift[j], 1e-9) > LARGEST_GAP or s.flips[j] < FREE_TORQUE:
        return None
    return {"h": FIRST_GAP} | _second_mass(s, j, 50 * s.torque[j] / FIRST_GAP, rng)


def _second_mass(s: OwnScale, j: int, stiffness: float, rng: np.random.Generator) -> Values:
    rotor = s.mean_inertia[j] * rng.uniform(0.3, 1.0)
    both = 1 / (1 / rotor + 1 / s.mean_inertia[j])
    damping = 2 * rng.uniform(0.05, 0.2) * np.sqrt(stiffness * both)
    return {"K": stiffness, "damping": damping, "rotor": rotor}


def presliding(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values | None:
    """Sliders that let go one after another over a distance; `reach` is where the last one slips."""
    return {"Fc": size * s.torque[j], "reach": s.spread[j] * float(np.exp(rng.uniform(np.log(0.05), np.log(0.25))))}


def saturation(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values | None:
    """The level at which a clipped signal loses the size, at most a quarter, of its rms."""
    wanted, torque = min(size, 0.25) * s.torque[j], np.abs(s.torques[:, j])
    low, high = 0.0, float(torque.max())
    for _ in range(50):
        middle = (low + high) / 2
        lost = np.sqrt(np.mean(np.maximum(torque - middle, 0.0) ** 2))
        low, high = (middle, high) if lost > wanted else (low, middle)
    return {"tau_max": high}


def _while(duration: float, shortest: float, longest: float, rng: np.random.Generator) -> Values:
    """An interval of one of the three fitted recordings [s]."""
    length = rng.uniform(shortest, min(longest, 0.7 * duration))
    start = rng.uniform(1.5, duration - length - 1.0)
    return {"t0": start, "t1": start + length, "recording": float(rng.integers(3))}


def contact(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values | None:
    """A force of the size that the weight of a payload of that size has."""
    force = rng.normal(size=3)
    force *= 9.81 * size / s.payload_share / np.linalg.norm(force)
    point = rng.uniform((-0.04, -0.04, 0.0), (0.04, 0.04, 0.12))
    names = ("Fx", "Fy", "Fz", "px", "py", "pz")
    return dict(zip(names, (*force, *point), strict=True)) | _while(s.duration, 1.5, 5.0, rng)


def picked_up(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values | None:
    """A payload that is there for a while."""
    return FIRST_SET["payload"](s, j, size, rng) | _while(s.duration, 5.0, 12.0, rng)


BEYOND_FIRST_SET: dict[str, Draw] = {
    "load_dependent_friction": load_dependent,
    "torque_ripple": ripple,
    "encoder_offset": encoder_offset,
    "link_inertia": link_inertia,
    "joint_elasticity": elasticity,
    "backlash": backlash,
    "presliding_hysteresis": presliding,
    "saturation": saturation,
    "contact_force": contact,
    "picked_up_payload": picked_up,
}
LISTED: dict[str, Draw] = {**FIRST_SET, **BEYOND_FIRST_SET}
DRY = {
    "coulomb_friction",
    "asymmetric_friction",
    "stribeck_friction",
    "load_dependent_friction",
    "presliding_hysteresis",
}
NAMED = {"picked_up_payload": "payload"}  # kinds that go by the name of another
PASSING = {"contact_force", "picked_up_payload"}
GEARS = {"joint_elasticity", "backlash"}
