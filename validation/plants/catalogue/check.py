"""Do the plants do what they say? python -m validation.plants.catalogue.check [--seed 0]

For one plant of every kind: the costs of its causes add up to all that the torque has beyond the nominal bodies, and
PyBullet and the loop on Pinocchio's bodies run the same arm.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace

import numpy as np

from validation.plants.arm.bodies import PinocchioBodies
from validation.plants.catalogue.assemble import assemble
from validation.plants.catalogue.costs import Costs, costs_of
from validation.plants.catalogue.draw_plan import ROBOTS, SMALLEST, draw_hidden
from validation.plants.catalogue.listed import GEARS, LISTED, PASSING
from validation.plants.catalogue.plan import Plan
from validation.plants.catalogue.scale import wanted_motions
from validation.plants.catalogue.simulate import run_plan

ADD_UP = 1e-4  # of the joint's torque: forces at the middle of a step differ from those at its samples
SAME_ARM = 1e-6  # rms difference of torques between engines over their rms: their steps round differently


def plan_of(kind: str, number: int, seed: int) -> Plan:
    """A short plant with one cause hidden, raw signals and computed torque."""
    rng = np.random.default_rng([seed, number])
    plan = Plan(
        number=number,
        seed=number,
        group="check",
        robot=ROBOTS[number % len(ROBOTS)],
        hidden=(),
        noise=0.01,
        encoder_bits=0,
        angle_noise=0.0,
        current_filter=0.0,
        velocity=False,
        controller="computed_torque",
        engine="pinocchio",
        shapes=("waypoints", "sweeps"),
        speed_share=0.6,
        duration=9.0,
    )
    while True:
        hidden = draw_hidden(plan, kind, rng, size=0.1, least=SMALLEST)
        if hidden is not None:
            first = {"recording": 0.0} if "t0" in hidden.values else {}
            return replace(plan, hidden=(replace(hidden, values=hidden.values | first),))
        number += 1
        plan = replace(plan, robot=ROBOTS[number % len(ROBOTS)])


def costs(plan: Plan) -> Costs:
    """Along the first motion."""
    nominal, parts = PinocchioBodies(plan.robot), assemble(plan)
    motion = wanted_motions(plan.robot, plan.shapes[:1], plan.seed, plan.speed_share, plan.duration, plan.step_rate)[0]
    return costs_of(plan, parts, run_plan(plan, parts, nominal, motion), nominal)


def _worst(difference: np.ndarray, torque: np.ndarray) -> float:
    return float((np.sqrt(np.mean(difference**2, axis=0)) / np.sqrt(np.mean(torque**2, axis=0))).max())


def main() -> int:
    """Check every kind; exit code 1 where one fails."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    failed = 0
    for number, kind in enumerate(LISTED):
        plan = plan_of(kind, number, given.seed)
        one = costs(plan)
        other = one if kind in PASSING else costs(replace(plan, engine="pybullet"))  # which knows of no events
        left = _worst(one.beyond - one.each[0], one.shown)
        apart = _worst(one.shown - other.shown, one.shown)
        good = left < ADD_UP and (apart < SAME_ARM or kind in GEARS)  # impacts part after the first
        failed += not good
        print(
            f"{'good  ' if good else 'FAILED'} {kind} {plan.robot}: left {left:.1e}, engines apart {apart:.1e}",
            flush=True,
        )
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
