"""One plant under several conditions: its motion is simulated once, and measured with more noise or for longer."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

import lagnet
from validation.concealed.fair_names import claims_of, match
from validation.plants.arm.bodies import PinocchioBodies
from validation.plants.arm.loop import TrueRun
from validation.plants.catalogue.assemble import Parts, assemble
from validation.plants.catalogue.costs import costs_of
from validation.plants.catalogue.draw_plan import draw_hidden
from validation.plants.catalogue.measure import record
from validation.plants.catalogue.plan import Plan
from validation.plants.catalogue.scale import wanted_motions
from validation.plants.catalogue.simulate import run_plan
from validation.plants.catalogue.witness import bear_witness
from validation.plants.simulate import write_csv

ROBOTS = ("ur5", "panda", "z1")
SHAPES = ("waypoints", "fourier", "sweeps", "fourier")
LONGEST = 20.0  # [s] of a recording


@dataclass(frozen=True)
class Condition:
    """Noise over the torque's rms [–], and length of each recording [s]."""

    noise: float
    duration: float


def plan_of(kind: str, seed: int, number: int, size: float) -> Plan | None:
    """A plant that hides one cause of a size; None where none of that size can be built."""
    rng = np.random.default_rng([seed, number, *kind.encode()])
    frame = Plan(
        number=number,
        seed=int(rng.integers(2**31)),
        group="detection",
        robot=ROBOTS[number % len(ROBOTS)],
        hidden=(),
        noise=0.01,
        encoder_bits=20,
        angle_noise=0.0,
        current_filter=0.0,
        velocity=False,
        controller="computed_torque",
        engine="pinocchio",
        shapes=SHAPES,
        speed_share=0.7,
        duration=LONGEST,
    )
    hidden = draw_hidden(frame, kind, rng, size=size, least=0.0)
    return None if hidden is None else replace(frame, hidden=(hidden,))


@dataclass(frozen=True, eq=False)
class Bench:
    """A plant whose true motions are known, to be measured and diagnosed.

    Args:
        plan: of the plant.
        runs: of each recording the parts of the arm and its true run at the plant's step.
    """

    plan: Plan
    runs: tuple[tuple[Parts, TrueRun], ...]

    def found(self, condition: Condition) -> bool:
        """Whether the cause is found in recordings made under a condition, the first seconds of each run."""
        plan = replace(self.plan, noise=condition.noise, duration=condition.duration)
        runs = [(parts, _first(run, round(condition.duration * plan.step_rate))) for parts, run in self.runs]
        verdict = _diagnosed(plan, runs)
        if not verdict["effects"]:
            return False
        nominal = PinocchioBodies(plan.robot)
        witness = bear_witness(plan, [costs_of(plan, parts, run, nominal) for parts, run in runs[:-1]], nominal)
        return bool(match(plan, witness, claims_of(verdict)))


def set_up(plan: Plan) -> Bench:
    """The plant after its simulation.

    Raises:
        RuntimeError: the closed loop was lost.
    """
    nominal = PinocchioBodies(plan.robot)
    wanted = wanted_motions(plan.robot, plan.shapes, plan.seed, plan.speed_share, plan.duration, plan.step_rate)
    parts = [assemble(plan, index) for index in range(len(wanted))]
    runs = [run_plan(plan, p, nominal, motion) for p, motion in zip(parts, wanted, strict=True)]
    return Bench(plan, tuple(zip(parts, runs, strict=True)))


def _first(run: TrueRun, samples: int) -> TrueRun:
    parts = {name: getattr(run, name)[:samples] for name in ("q", "v", "a", "tau")}
    return replace(run, **parts, own={number: cost[:samples] for number, cost in run.own.items()})


def _diagnosed(plan: Plan, runs: list[tuple[Parts, TrueRun]]) -> dict:
    robot = lagnet.load_robot(plan.robot)
    read = []
    with tempfile.TemporaryDirectory() as folder:
        for index, (name, (parts, run)) in enumerate(zip(plan.recordings, runs, strict=True)):
            file = Path(folder) / f"{name}.csv"
            write_csv(file, record(plan, parts, run, np.random.default_rng([plan.seed, index, 1])))
            read.append(lagnet.load_recording(str(file), robot=robot))
    return lagnet.diagnose(read[:-1], robot=robot, holdout=read[-1:]).verdict.to_dict()
