"""Physics in nobody's catalogue: each kind draws its values and builds its pulls or surfaces.

`contains` names what a kind truly holds besides, so that a claim of it there is true; `resembles` what may come so
close that the name is fair where that law explains nine tenths of the cause. Both were set before any diagnosis ran;
the reasons stand beside them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from validation.plants.arm.pulls import Coupling, Drag, Field, Pull
from validation.plants.arm.surfaces import Plain, Surface, Warming, Worn
from validation.plants.catalogue.scale import OwnScale

Values = dict[str, float]


@dataclass(frozen=True)
class Unlisted:
    """One kind: how it is drawn, and built from its values at a joint index of an arm with so many joints."""

    draw: Callable[[OwnScale, int, float, np.random.Generator], Values]
    build: Callable[[int, int, Values], tuple[list[Pull], list[Surface]]]
    contains: tuple[str, ...] = ()
    resembles: tuple[str, ...] = ()
    partner: bool = False  # whether a second joint, `partner` joints on, feels it too


def _unit(law: Callable[[np.ndarray], np.ndarray], sample: np.ndarray) -> float:
    return float(np.sqrt(np.mean(law(sample) ** 2)))


def _angles(s: OwnScale, j: int) -> np.ndarray:
    return s.middle[j] + s.spread[j] * np.linspace(-1.7, 1.7, 200)


def _kinked(x: Values) -> Callable[[np.ndarray], np.ndarray]:
    """A cable that pulls tight past one angle, and hard past another."""
    return lambda q: np.maximum(q - x["tight"], 0) + x["harder"] * np.maximum(q - x["hard"], 0)


def _draw_cable(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values:
    x = {"tight": s.middle[j] + s.spread[j] * rng.uniform(0.2, 0.6), "harder": rng.uniform(2.0, 5.0)}
    x["hard"] = x["tight"] + 0.5 * s.spread[j]
    return x | {"k": size * s.torque[j] / max(_unit(_kinked(x), _angles(s, j)), 1e-9)}


def _build_cable(j: int, dof: int, x: Values) -> tuple[list[Pull], list[Surface]]:
    tight, hard, harder, k = x["tight"], x["hard"], x["harder"], x["k"]
    return [Field(j, lambda t, q: -k * (max(q[j] - tight, 0.0) + harder * max(q[j] - hard, 0.0)))], []


def _draw_gyroscope(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values:
    return {"c": float(rng.choice([-1, 1])) * size * s.torque[j] / s.speed[_next(j, s.speed.size)]}


def _build_gyroscope(j: int, dof: int, x: Values) -> tuple[list[Pull], list[Surface]]:
    other = _next(j, dof)

    def law(t: float, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        force = np.zeros(dof)
        force[j], force[other] = x["c"] * v[other], -x["c"] * v[j]
        return force

    return [Coupling(law)], []


def _next(j: int, dof: int) -> int:
    return j + 1 if j + 1 < dof else j - 1


def _draw_slip(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values:
    return {"Fc": size * s.torque[j], "rho": float(rng.choice([-1, 1])) * rng.uniform(0.4, 0.7)}


def _build_slip(j: int, dof: int, x: Values) -> tuple[list[Pull], list[Surface]]:
    return [], [Plain(((j, 1.0), (_next(j, dof), x["rho"])), x["Fc"], x["Fc"])]


def _draw_hum(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values:
    return {"A": np.sqrt(2) * size * s.torque[j], "f": rng.uniform(0.4, 3.0), "phase": rng.uniform(0, 2 * np.pi)}


def _build_hum(j: int, dof: int, x: Values) -> tuple[list[Pull], list[Surface]]:
    return [Field(j, lambda t, q: x["A"] * float(np.sin(2 * np.pi * x["f"] * t + x["phase"])))], []


def _draw_strut(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values:
    rest = s.middle[j] + rng.uniform(-0.2, 0.2) * s.spread[j]
    k = size * s.torque[j] / _unit(lambda q: (q - rest) ** 2, _angles(s, j))
    return {"k": float(rng.choice([-1, 1])) * k, "q0": rest, "rub": rng.uniform(0.15, 0.3)}


def _build_strut(j: int, dof: int, x: Values) -> tuple[list[Pull], list[Surface]]:
    def law(t: float, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        push = x["k"] * (q[j] - x["q0"]) ** 2
        force = np.zeros(dof)
        force[j] = -push - x["rub"] * abs(push) * np.tanh(v[j] / 0.02)
        return force

    return [Coupling(law)], []


def _draw_belt(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values:
    other = _next(j, s.torque.size)
    rho = float(rng.choice([-1, 1])) * rng.uniform(0.6, 1.4)
    return {
        "k": size * s.torque[j] / np.hypot(s.spread[j], rho * s.spread[other]),
        "rho": rho,
        "q0": s.middle[j] + rho * s.middle[other],
    }


def _build_belt(j: int, dof: int, x: Values) -> tuple[list[Pull], list[Surface]]:
    other = _next(j, dof)

    def law(t: float, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        pull = x["k"] * (q[j] + x["rho"] * q[other] - x["q0"])
        force = np.zeros(dof)
        force[j], force[other] = -pull, -x["rho"] * pull
        return force

    return [Coupling(law)], []


def _draw_warming(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values:
    cold = 1.6 * size * s.torque[j]
    return {"cold": cold, "warm": cold * rng.uniform(0.15, 0.35), "time": rng.uniform(4.0, 10.0)}


def _build_warming(j: int, dof: int, x: Values) -> tuple[list[Pull], list[Surface]]:
    return [], [Warming(((j, 1.0),), x["cold"], x["warm"], x["time"])]


def _draw_cubic(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values:
    return {"c": size * s.torque[j] / (s.drag_speed[j] * s.speed[j] * 1.3)}


def _draw_worn(s: OwnScale, j: int, size: float, rng: np.random.Generator) -> Values:
    turns = float(rng.integers(1, 4)) * max(1.0, 0.5 / s.spread[j])
    return {"mean": size * s.torque[j], "swing": rng.uniform(0.6, 0.95), "turns": turns, "phase": rng.uniform(0, 6.28)}


def _build_worn(j: int, dof: int, x: Values) -> tuple[list[Pull], list[Surface]]:
    return [], [Worn(((j, 1.0),), x["mean"], x["swing"], x["turns"], x["phase"])]


UNLISTED: dict[str, Unlisted] = {
    "kinked_cable": Unlisted(_draw_cable, _build_cable, resembles=("joint_spring",)),
    "gyroscope": Unlisted(_draw_gyroscope, _build_gyroscope, partner=True),
    # both joints rub against each other: the one mechanism that the catalogue calls a coupled transmission, at a ratio
    # other than one; along either joint alone it is dry friction
    "cross_friction": Unlisted(_draw_slip, _build_slip, ("coulomb_friction",), ("coupled_transmission",), True),
    "hum": Unlisted(_draw_hum, _build_hum),
    # an even law: no spring; what rubs grows with the strut's own force, not with the joint's load
    "gas_strut": Unlisted(_draw_strut, _build_strut),
    # the part along each joint's own angle is a spring in every sense
    "belt": Unlisted(_draw_belt, _build_belt, contains=("joint_spring",), partner=True),
    # friction that falls has a mean, and that is Coulomb friction; the same for a worn track
    "warming_friction": Unlisted(_draw_warming, _build_warming, contains=("coulomb_friction",)),
    "cubic_drag": Unlisted(_draw_cubic, lambda j, dof, x: ([Drag(j, x["c"], 3.0)], []), resembles=("quadratic_drag",)),
    "worn_track": Unlisted(_draw_worn, _build_worn, contains=("coulomb_friction",)),
}
