"""Draw a plant from a seed: robot, hidden effects, joints, sizes, noise, motions."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from validation.plants.body import arm_joints, joint_names
from validation.plants.sizes import Scale, scale_of
from validation.plants.spec import Hidden, PlantSpec

ROBOTS = ("ur5", "ur10", "panda", "xarm7", "kinova", "z1")
FRICTION_LEVELS = {"coulomb_friction", "asymmetric_friction", "stribeck_friction", "torque_offset"}
Draw = Callable[[Scale, int, float, np.random.Generator], dict[str, float]]


def _sign(rng: np.random.Generator) -> float:
    return float(rng.choice([-1.0, 1.0]))


def _asymmetric(s: Scale, j: int, size: float, rng: np.random.Generator) -> dict[str, float]:
    lean = _sign(rng) * rng.uniform(0.2, 0.5)
    return {"Fc_plus": size * s.torque[j] * (1 + lean), "Fc_minus": size * s.torque[j] * (1 - lean)}


def _stribeck(s: Scale, j: int, size: float, rng: np.random.Generator) -> dict[str, float]:
    level = size * s.torque[j]
    return {"Fc": level, "Fs": level * rng.uniform(0.5, 1.2), "vs": s.top_speed[j] * rng.uniform(0.05, 0.15)}


def _spring(s: Scale, j: int, size: float, rng: np.random.Generator) -> dict[str, float]:
    rest = s.middle[j] + rng.uniform(-0.5, 0.5) * s.spread[j]
    return {"k": size * s.torque[j] / np.hypot(s.spread[j], s.middle[j] - rest), "q0": rest}


def _payload(s: Scale, j: int, size: float, rng: np.random.Generator) -> dict[str, float]:
    x, y, z = rng.uniform(-0.04, 0.04), rng.uniform(-0.04, 0.04), rng.uniform(0.03, 0.12)
    return {"m": float(np.clip(size / s.payload_share, 0.02, 10.0)), "cx": x, "cy": y, "cz": z, "radius": 0.04}


def _tilt(s: Scale, j: int, size: float, rng: np.random.Generator) -> dict[str, float]:
    angle, heading = min(size / s.tilt_share, 0.2), rng.uniform(0, 2 * np.pi)
    return {"theta_1": angle * np.cos(heading), "theta_2": angle * np.sin(heading)}


FIRST_SET: dict[str, Draw] = {
    "viscous_friction": lambda s, j, size, rng: {"Fv": size * s.torque[j] / s.speed[j]},
    "coulomb_friction": lambda s, j, size, rng: {"Fc": size * s.torque[j]},
    "asymmetric_friction": _asymmetric,
    "stribeck_friction": _stribeck,
    "quadratic_drag": lambda s, j, size, rng: {"Fd": size * s.torque[j] / s.drag_speed[j]},
    "rotor_inertia": lambda s, j, size, rng: {"Ia": size * s.torque[j] / s.acceleration[j]},
    "payload": _payload,
    "gravity_tilt": _tilt,
    "joint_spring": _spring,
    "torque_gain": lambda s, j, size, rng: {"g": 1 + _sign(rng) * size},
    "torque_offset": lambda s, j, size, rng: {"b": _sign(rng) * size * s.torque[j]},
    "time_delay": lambda s, j, size, rng: {"T": float(np.clip(size * s.torque[j] / s.torque_rate[j], 1e-3, 0.04))},
}
WHOLE_ARM = {"payload", "gravity_tilt"}


def draw_plant(
    seed: int,
    number: int = 0,
    kinds: Sequence[str] = tuple(FIRST_SET),
    n_effects: int = 1,
    robots: Sequence[str] = ROBOTS,
    noise: float = 0.01,
) -> PlantSpec:
    """A plant with `n_effects` hidden effects; the same seed and number draw the same plant."""
    rng = np.random.default_rng([seed, number])
    robot = str(rng.choice(list(robots)))
    hidden: list[Hidden] = []
    while len(hidden) < n_effects:
        entry = _draw_effect(str(rng.choice(list(kinds))), robot, rng)
        if not any(_same_thing(entry, other) for other in hidden):
            hidden.append(entry)
    return PlantSpec(
        number=number,
        seed=int(rng.integers(2**31)),
        robot=robot,
        hidden=tuple(hidden),
        noise=noise,
        encoder_bits=int(rng.choice([0, 18, 20])),
        velocity=bool(rng.random() < 0.3),
        speed_share=float(rng.uniform(0.5, 0.9)),
    )


def _draw_effect(effect: str, robot: str, rng: np.random.Generator) -> Hidden:
    joint = int(rng.choice(arm_joints(robot)))
    size = float(np.exp(rng.uniform(np.log(0.03), np.log(0.4))))
    values = FIRST_SET[effect](scale_of(robot), joint, size, rng)
    size = _clipped_size(effect, scale_of(robot), joint, size, values)
    name = None if effect in WHOLE_ARM else joint_names(robot)[joint]
    return Hidden(effect, name, {k: float(v) for k, v in values.items()}, size)


def _clipped_size(effect: str, s: Scale, j: int, size: float, values: dict[str, float]) -> float:
    """The size that is left where a parameter was held inside what is physically sensible."""
    match effect:
        case "time_delay":
            return float(values["T"] * s.torque_rate[j] / s.torque[j])
        case "payload":
            return values["m"] * s.payload_share
        case "gravity_tilt":
            return float(np.hypot(values["theta_1"], values["theta_2"]) * s.tilt_share)
        case _:
            return size


def _same_thing(one: Hidden, other: Hidden) -> bool:
    """Whether two effects on one joint would be one effect under another name."""
    if one.joint != other.joint:
        return False
    return one.effect == other.effect or {one.effect, other.effect} <= FRICTION_LEVELS
