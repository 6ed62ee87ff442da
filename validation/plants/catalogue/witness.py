"""What recordings can show of a hidden cause: its torque against noise, and the names that are the same torque.

Both follow from the plant alone, before any diagnosis: nothing here reads a verdict.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass

import numpy as np

from validation.plants.arm.bodies import PinocchioBodies
from validation.plants.catalogue.costs import Costs
from validation.plants.catalogue.listed import DRY
from validation.plants.catalogue.measure import noise_level
from validation.plants.catalogue.plan import Plan
from validation.plants.catalogue.same_torque import laws_of

SHOWN = 0.5  # rms over that of the raw noise, at the joint that shows it best: below, the recordings hide the cause
SAME = 0.2  # of the noise: another law that leaves less of a cause than this, at every joint, is the same torque
RESEMBLES = 0.9  # of the power of an unlisted cause that a near law must explain for its name to be fair
WIDER = ("asymmetric_friction", "joint_spring")  # they hold Coulomb friction and an offset: fitting these is no merit
AT_REST = 0.02  # of a joint's top speed
THIN = 4  # every so many samples are enough to compare laws


@dataclass(frozen=True)
class Sight:
    """What the fitted recordings can show of one hidden cause.

    Args:
        share: rms of its torque over that of the joint's torque, at the joint where this is largest.
        over_noise: rms of its torque over that of the raw noise, likewise; of a passing cause, while it lasts.
        same_as: (name, joint) of laws whose torque is the same within a fifth of the noise.
        resembled_by: (name, joint) of laws that explain nine tenths of its power.
    """

    share: float
    over_noise: float
    same_as: tuple[tuple[str, str | None], ...]
    resembled_by: tuple[tuple[str, str | None], ...]

    @property
    def shown(self) -> bool:
        """Whether the cause stands out of the noise at all."""
        return self.over_noise >= SHOWN


@dataclass(frozen=True)
class Witness:
    """Sights of all hidden causes, in the plan's order."""

    sights: tuple[Sight, ...]

    def to_json(self) -> bytes:
        """Plain content of witness.json."""
        return json.dumps(asdict(self), indent=1).encode()


def read_witness(content: bytes) -> Witness:
    """Inverse of `to_json`."""

    def pairs(entries: list) -> tuple[tuple[str, str | None], ...]:
        return tuple((name, joint) for name, joint in entries)

    sights = json.loads(content)["sights"]
    fresh = (Sight(s["share"], s["over_noise"], pairs(s["same_as"]), pairs(s["resembled_by"])) for s in sights)
    return Witness(tuple(fresh))


def bear_witness(plan: Plan, costs: list[Costs], nominal: PinocchioBodies) -> Witness:
    """Sights on the recordings that are fitted."""
    if not plan.hidden:
        return Witness(())
    shown = np.concatenate([c.shown for c in costs])
    noise = np.maximum(noise_level(plan, shown), 1e-9)
    level = np.maximum(np.sqrt(np.mean(shown**2, axis=0)), 1e-9)
    laws = laws_of(plan.robot, costs, nominal, THIN)
    sights = []
    for i in range(len(plan.hidden)):
        cost = np.concatenate([c.each[i] for c in costs])
        rms = np.sqrt(np.mean(_while_it_lasts(plan, i, cost) ** 2, axis=0))
        clear = _clear(plan, i, costs, nominal)
        thin = np.concatenate([c.each[i][::THIN] for c in costs])[clear] / noise
        same, near = [], []
        for key, columns in laws.items() if "t0" not in plan.hidden[i].values else ():
            left = _left(thin, columns[clear] / noise[None, :, None])
            wider = key[0] in WIDER and key[0] != plan.hidden[i].effect
            if not wider and np.sqrt(np.mean(left**2, axis=0)).max() < SAME:
                same.append(key)
            if np.sum(left**2) < (1 - RESEMBLES) * np.sum(thin**2):
                near.append(key)
        sights.append(Sight(float((rms / level).max()), float((rms / noise).max()), tuple(same), tuple(near)))
    return Witness(tuple(sights))


def _while_it_lasts(plan: Plan, i: int, cost: np.ndarray) -> np.ndarray:
    """The samples at which a passing cause acts; all of them for a lasting one."""
    return cost[np.any(cost != 0, axis=1)] if "t0" in plan.hidden[i].values else cost


def _clear(plan: Plan, i: int, costs: list[Costs], nominal: PinocchioBodies) -> np.ndarray:
    """Samples on which laws are compared, shape (n,): for dry friction, those in motion."""
    v = np.concatenate([c.v[::THIN] for c in costs])
    if plan.hidden[i].effect not in DRY:
        return np.ones(v.shape[0], dtype=bool)
    speed = np.abs(v[:, nominal.joints.index(str(plan.hidden[i].joint))])
    return speed > AT_REST * speed.max()


def _left(target: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """What least squares leaves of (n, dof) on columns (n, dof, k)."""
    flat = columns.reshape(-1, columns.shape[2])
    gram = flat.T @ flat
    scale = np.sqrt(np.maximum(np.diag(gram), 1e-30))
    weights = np.linalg.lstsq(gram / np.outer(scale, scale), (flat.T @ target.ravel()) / scale, rcond=1e-10)[0] / scale
    return target - columns @ weights
