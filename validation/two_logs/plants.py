"""The plants: a UR-5 that hides two of six causes, or none; and the simulator, which hides nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from validation.plants.catalogue.draw_plan import LARGEST, MOST_NOISE, SMALLEST, _clash, draw_hidden
from validation.plants.catalogue.plan import Plan
from validation.plants.spec import Hidden

ROBOT = "ur5"
KINDS = ("viscous_friction", "coulomb_friction", "payload", "rotor_inertia", "torque_offset", "torque_gain")
HIDDEN = 2  # causes of a plant
EMPTY = 6  # every so many plants, one that hides nothing
SIMULATOR = 10_007  # seed of the simulator's motions, which are not those of the real arm


def simulator(duration: float) -> Plan:
    """The arm as the simulator has it: its log is exact to the digits of the file."""
    shapes = ("waypoints", "fourier", "sweeps", "fourier")
    return Plan(
        number=0,
        seed=SIMULATOR,
        group="simulator",
        robot=ROBOT,
        hidden=(),
        noise=0.0,
        encoder_bits=0,
        angle_noise=0.0,
        current_filter=0.0,
        velocity=False,
        controller="computed_torque",
        engine="pinocchio",
        shapes=shapes,
        speed_share=0.7,
        duration=duration,
    )


def real_arm(seed: int, number: int, duration: float) -> Plan:
    """One real arm; the first of its two causes goes round the six, so that every one comes up."""
    rng = np.random.default_rng([seed, number, 11])
    bits = int(rng.choice([0, 18, 20]))
    frame = replace(
        simulator(duration),
        number=number,
        seed=int(rng.integers(2**31)),
        group="empty" if number % EMPTY == EMPTY - 1 else "listed",
        noise=float(np.exp(rng.uniform(np.log(0.005), np.log(MOST_NOISE)))),
        encoder_bits=bits,
        angle_noise=0.0 if bits else float(rng.choice([0.0, 5e-6, 2e-5])),
        velocity=bool(rng.random() < 0.3),
        speed_share=float(rng.uniform(0.5, 0.9)),
    )
    return frame if frame.group == "empty" else replace(frame, hidden=_hidden(frame, number, rng))


def _hidden(frame: Plan, number: int, rng: np.random.Generator) -> tuple[Hidden, ...]:
    rank = number - number // EMPTY
    hidden: list[Hidden] = []
    while len(hidden) < HIDDEN:
        kind = KINDS[rank % len(KINDS)] if not hidden else str(rng.choice(KINDS))
        size = float(np.exp(rng.uniform(np.log(SMALLEST), np.log(LARGEST))))
        entry = draw_hidden(frame, kind, rng, size=size)
        if entry is not None and not any(_clash(entry, other) for other in hidden):
            hidden.append(entry)
    return tuple(hidden)
