"""Plain laws by name along noise-free samples, to see which of them give the same torque as a hidden cause."""

from __future__ import annotations

import numpy as np

from validation.plants.arm.bodies import PinocchioBodies
from validation.plants.body import BodySettings
from validation.plants.catalogue.costs import Costs

SMALL = 1e-3  # rad

Laws = dict[tuple[str, str | None], np.ndarray]


def laws_of(robot: str, costs: list[Costs], nominal: PinocchioBodies, every: int) -> Laws:
    """Columns (n, dof, k) of every law at every place."""
    q, v, a, shown = (np.concatenate([getattr(c, name)[::every] for c in costs]) for name in ("q", "v", "a", "shown"))
    rates = np.concatenate([np.gradient(c.shown, axis=0)[::every] for c in costs])
    laws: Laws = {}
    bodies = nominal.link_columns(q, v, a)
    base = nominal.torque(q, v, a)
    for j, name in enumerate(nominal.joints):
        for law, columns in _local(q[:, j], v[:, j], a[:, j], shown[:, j], rates[:, j]).items():
            laws[law, name] = _placed(columns, j, q.shape[1])
        laws["link_inertia", name] = bodies[:, :, 10 * j : 10 * j + 10]
        moved = q.copy()
        moved[:, j] += SMALL
        slope = (nominal.torque(moved, v, a) - base) / SMALL
        laws["encoder_offset", name] = slope[..., None]
        laws["joint_elasticity", name] = (slope * shown[:, [j]])[..., None]
        laws["backlash", name] = (slope * np.sign(shown[:, [j]]))[..., None]
    laws["payload", None] = bodies[:, :, -10:]
    del laws["link_inertia", nominal.joints[-1]]
    laws["gravity_tilt", None] = np.stack([_tilted(robot, (q, v, a), base, way) for way in ((1, 0), (0, 1))], axis=2)
    return laws


def _local(q: np.ndarray, v: np.ndarray, a: np.ndarray, tau: np.ndarray, rate: np.ndarray) -> dict[str, np.ndarray]:
    side = np.sign(v)
    return {
        "viscous_friction": v[:, None],
        "coulomb_friction": side[:, None],
        "asymmetric_friction": np.column_stack([v > 0, v < 0]).astype(float),
        "quadratic_drag": (v * np.abs(v))[:, None],
        "load_dependent_friction": (np.abs(tau) * side)[:, None],
        "rotor_inertia": a[:, None],
        "joint_spring": np.column_stack([q, np.ones_like(q)]),
        "torque_gain": tau[:, None],
        "torque_offset": np.ones((q.size, 1)),
        "time_delay": rate[:, None],
    }


def _placed(columns: np.ndarray, j: int, dof: int) -> np.ndarray:
    out = np.zeros((columns.shape[0], dof, columns.shape[1]))
    out[:, j] = columns
    return out


def _tilted(robot: str, motion: tuple, base: np.ndarray, way: tuple[int, int]) -> np.ndarray:
    tilt = (SMALL * way[0], SMALL * way[1])
    return (PinocchioBodies(robot, BodySettings(tilt=tilt)).torque(*motion) - base) / SMALL
