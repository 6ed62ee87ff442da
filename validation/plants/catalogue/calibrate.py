"""Size a gear with a second mass by trial: how far its swings and impacts change torques has no formula."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from validation.plants.arm.bodies import PinocchioBodies
from validation.plants.catalogue.assemble import assemble
from validation.plants.catalogue.costs import costs_of
from validation.plants.catalogue.plan import Plan
from validation.plants.catalogue.scale import TINY_JOINT, wanted_motions
from validation.plants.catalogue.simulate import run_plan
from validation.plants.spec import Hidden

TRIAL = 8.0  # [s] of the plant's first motions
STEPS = 5
CLOSE = 1.5  # times too large or too small is close enough


def calibrated(plan: Plan, hidden: Hidden, wanted: float) -> Hidden | None:
    """The cause with its gap or compliance scaled to a wanted size; None where no trial came close."""
    for _ in range(STEPS):
        try:
            size = _size(replace(plan, hidden=(hidden,), duration=TRIAL))
        except RuntimeError:
            size = np.inf
        if wanted / CLOSE <= size <= wanted * CLOSE:
            return replace(hidden, size=size)
        hidden = replace(hidden, values=_scaled(hidden, float(np.clip(wanted / max(size, 1e-9), 0.2, 3.0))))
    return None


def _size(plan: Plan) -> float:
    """Rms of the cost over that of the torque, at the joint where this is largest, on two short motions."""
    parts, nominal = assemble(plan), PinocchioBodies(plan.robot)
    shapes = plan.shapes[:2]
    motions = wanted_motions(plan.robot, shapes, plan.seed, plan.speed_share, plan.duration, plan.step_rate)
    costs = [costs_of(plan, parts, run_plan(plan, parts, nominal, motion), nominal) for motion in motions]
    cost, shown = (_rms(np.concatenate(x)) for x in ([c.each[0] for c in costs], [c.shown for c in costs]))
    seen = shown >= TINY_JOINT * shown.max()
    return float((cost / shown)[seen].max())


def _rms(x: np.ndarray) -> np.ndarray:
    return np.sqrt(np.mean(x**2, axis=0))


def _scaled(hidden: Hidden, factor: float) -> dict[str, float]:
    """A gap times the factor, with flanks as much stiffer as it is narrower; or a stiffness over the factor."""
    x = hidden.values
    shared = {"K": x["K"] / factor, "damping": x["damping"] / factor**0.5}
    return {**x, **shared, "h": x["h"] * factor} if "h" in x else {**x, **shared}
