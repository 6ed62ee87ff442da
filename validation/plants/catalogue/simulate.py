"""Run a plan: its recordings as CSV, and the witness of what was hidden in them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from validation.plants.arm.bodies import PinocchioBodies
from validation.plants.arm.controllers import CONTROLLERS
from validation.plants.arm.loop import Arm, TrueRun, run
from validation.plants.body import Body
from validation.plants.catalogue.assemble import Parts, assemble
from validation.plants.catalogue.costs import Costs, costs_of
from validation.plants.catalogue.measure import record
from validation.plants.catalogue.plan import Plan
from validation.plants.catalogue.scale import LEAD, wanted_motions
from validation.plants.catalogue.witness import Witness, bear_witness
from validation.plants.motions import Reference
from validation.plants.simulate import write_csv

SAG = 0.01  # [rad] by which a joint's typical torque may push it off the reference
BANDWIDTH = {"computed_torque": (40.0, 120.0), "pd_with_gravity": (25.0, 50.0), "pd_with_integral": (25.0, 50.0)}
BESIDE_A_GEAR = 35.0  # [rad/s]: the controller of a two-mass joint stays below its resonance


def simulate(plan: Plan, folder: Path) -> tuple[Witness, Costs]:
    """Write the recordings of a plan into `folder`; the truth is not among them.

    Returns:
        What the recordings can show of each hidden cause, and what each costs along the held-out one.
    """
    folder.mkdir(parents=True, exist_ok=True)
    nominal = PinocchioBodies(plan.robot)
    wanted = wanted_motions(plan.robot, plan.shapes, plan.seed, plan.speed_share, plan.duration, plan.step_rate)
    costs: list[Costs] = []
    for index, (name, motion) in enumerate(zip(plan.recordings, wanted, strict=True)):
        parts = assemble(plan, index)
        true_run = run_plan(plan, parts, nominal, motion)
        rng = np.random.default_rng([plan.seed, index, 1])
        write_csv(folder / f"{name}.csv", record(plan, parts, true_run, rng))
        costs.append(costs_of(plan, parts, true_run, nominal))
    return bear_witness(plan, costs[:-1], nominal), costs[-1]


def run_plan(plan: Plan, parts: Parts, nominal: PinocchioBodies, motion: Reference) -> TrueRun:
    """Follow one motion, its lead left out.

    Raises:
        RuntimeError: the arm did not follow.
    """
    step = 1 / plan.step_rate
    engine = Body(plan.robot, parts.body, step) if plan.engine == "pybullet" else None
    arm = Arm(
        PinocchioBodies(plan.robot, parts.body),
        parts.armature,
        parts.angle_offset,
        engine,
        tuple(parts.pulls),
        tuple(parts.surfaces),
        tuple(parts.gears),
        tuple(parts.grasps),
    )
    controller = CONTROLLERS[plan.controller](nominal, motion, _bandwidth(plan, parts, nominal, motion), step)
    true_run = run(arm, motion, controller, step)
    if engine is not None:
        engine.close()
    if not np.all(np.isfinite(true_run.tau)) or np.abs(true_run.q - parts.angle_offset - motion.q).max() > 1.0:
        raise RuntimeError(f"{plan.name}: the closed loop was lost")
    return _after_lead(true_run, round(LEAD * plan.step_rate))


def _after_lead(true_run: TrueRun, start: int) -> TrueRun:
    own = {number: cost[start:] for number, cost in true_run.own.items()}
    q, v, a, tau = (x[start:] for x in (true_run.q, true_run.v, true_run.a, true_run.tau))
    return replace(true_run, q=q, v=v, a=a, tau=tau, own=own)


def _bandwidth(plan: Plan, parts: Parts, nominal: PinocchioBodies, motion: Reference) -> np.ndarray:
    """Of the position loop [rad/s], shape (dof,)."""
    few = motion.q[:: max(1, motion.q.shape[0] // 50)]
    inertia = np.mean([np.diag(nominal.inertia(q)) for q in few], axis=0)
    weight = np.sqrt(np.mean([nominal.gravity(q) ** 2 for q in few], axis=0)) + inertia
    omega = np.clip(np.sqrt(weight / (SAG * inertia)), *BANDWIDTH[plan.controller])
    return np.minimum(omega, BESIDE_A_GEAR) if parts.gears else omega
