"""Diagnoses that rules are consulted in: real arms, other splits of these, and plants of four kinds."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import count, islice, product
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from lagnet.recordings.recording import Recording
from validation.ablations.plan import SIMULATED, TEXTURED, Source
from validation.another_simulator.mujoco_arm import CameApartError
from validation.another_simulator.plants import plant as mujoco_plant
from validation.far_models.plants import FarPlant, draw
from validation.plants.catalogue.draw_plan import GROUPS
from validation.real_arms.layers import cases, read
from validation.real_arms.loaded import FILES, UR10E, calibrated, halves
from validation.real_arms.splits import splits

Posed = tuple[Any, Sequence[Recording], Sequence[Recording] | None]
"""Nominal model, fitted and held-out recordings; None: the last fifth of each."""
SECONDS = 22.0  # of a run of the other simulator
MADE_ON, FRESH = (2, 3), 5  # seeds of the other simulator: those that `reversals_only` was made on, and a fresh one
UNLISTED_MADE_ON, UNLISTED_FRESH = (101, 102, 103), 51
LATE = (0.3, 0.6)  # [s]; delays up to 0.25 s are searched
FIRST_FAR = 200  # the study of far models has the numbers below 60


@dataclass(frozen=True)
class Case:
    """One diagnosis.

    Args:
        kind: of the data.
        name: of the case, in its kind.
        posed: makes what is diagnosed, and the hidden causes; None where they are not known.
    """

    kind: str
    name: str
    posed: Callable[[], tuple[Posed, list[str] | None]]


def real_arms(data: Path, home: Path) -> Iterator[Case]:
    """All seven sets, the load that is mounted twice, and ten other splits."""
    for kind, known in (("real_arms", cases(data)), ("real_splits", splits(data))):
        for name, case in known.items():
            yield Case(kind, name, lambda case=case: (case(), None))

    def loaded() -> tuple[Posed, None]:
        robot = calibrated(data, home / "calibrated")
        parts = [halves(read(data / "ur10e_loaded" / file, robot, UR10E))[0] for file in FILES]
        return (robot, parts, None), None

    yield Case("real_arms", "loaded_both", loaded)


def concealed(data: Path, home: Path, simulated: int, textured: int) -> Iterator[Case]:
    """Plants of the concealed study's kind and with the texture of real arms, of fresh seeds."""
    for source in (Source(SIMULATED, 49, simulated, 0), Source(TEXTURED, 50, textured, 0)):
        for number in range(source.all):

            def posed(source: Source = source, number: int = number) -> tuple[Posed, list[str]]:
                return _kept(source, number, home, data)

            yield Case(source.kind, f"plant {number}", posed)


def unlisted(home: Path, each: int) -> Iterator[Case]:
    """Plants with physics in no catalogue: of the seeds that `surrogate_terms` was made on, and of a fresh one."""
    for seed in (*UNLISTED_MADE_ON, UNLISTED_FRESH):
        numbers = (n for n in count() if GROUPS[n % len(GROUPS)] == "unlisted")
        for number in islice(numbers, each):

            def posed(seed: int = seed, number: int = number) -> tuple[Posed, list[str]]:
                return _kept(Source(SIMULATED, seed, 0, 0), number, home, home)

            yield Case("unlisted", f"seed {seed}, plant {number}", posed)


def late_logs(data: Path, home: Path, plants: int) -> Iterator[Case]:
    """Plants whose torque is stamped later than any delay that is searched, of one joint or of all."""
    for number in range(plants):
        for joints, late in product(("all", "one"), LATE):

            def posed(number: int = number, joints: str = joints, late: float = late) -> tuple[Posed, list[str]]:
                (robot, fit, held), hidden = _kept(Source(SIMULATED, 49, 0, 0), number, home, data)
                at = slice(None) if joints == "all" else [number % robot.n_dof]
                fit, held = ([_later(r, at, late) for r in part] for part in (fit, held or ()))
                return (robot, fit, held), [*hidden, f"log of {joints} {late} s late"]

            yield Case("late_logs", f"plant {number}, {joints}, {late} s", posed)


def _later(recording: Recording, joints: Any, late: float) -> Recording:
    """Torque of some joints stamped that much later [s]."""
    tau = np.array(recording.tau)
    then = np.maximum(recording.time - late, recording.time[0])
    tau[:, joints] = CubicSpline(recording.time, tau[:, joints])(then)
    return replace(recording, tau=tau)


def _kept(source: Source, number: int, home: Path, data: Path) -> tuple[Posed, list[str]]:
    plant = source.plant(number, home, data)
    if plant is None:
        raise CameApartError(f"plant {number}: its closed loop was lost")
    robot, recordings = plant.read()
    return (robot, recordings[:-1], recordings[-1:]), [_place(h) for h in plant.plan.hidden]


def far_models(plants: int) -> Iterator[Case]:
    """Models with masses missing, halved or doubled."""
    for seed in range(FIRST_FAR, FIRST_FAR + plants):

        def posed(seed: int = seed) -> tuple[Posed, list[str]]:
            plant = draw(seed)
            return (plant.nominal, [plant.record(1), plant.record(2)], [plant.record(3)]), _hidden_in(plant)

        yield Case("far_models", f"plant {seed}", posed)


def _hidden_in(plant: FarPlant) -> list[str]:
    """Friction and rotors of all joints, and the links whose masses are wrong."""
    masses = zip(
        plant.nominal.joints, *(r.inertial_parameters()[:, 0] for r in (plant.nominal, plant.true)), strict=True
    )
    links = [f"link_inertia @ {joint}" for joint, modelled, true in masses if modelled != true]
    return [*(f"{effect} @ {joint}" for joint in plant.nominal.joints for effect in OF_ALL_JOINTS), *links]


OF_ALL_JOINTS = ("coulomb_friction", "asymmetric_friction", "torque_offset", "viscous_friction", "rotor_inertia")


def another_simulator(plants: int) -> Iterator[Case]:
    """Arms that MuJoCo moves."""
    for seed in (*MADE_ON, FRESH):
        for index in range(plants):

            def posed(seed: int = seed, index: int = index) -> tuple[Posed, list[str]]:
                plant = mujoco_plant(seed, index, SECONDS)
                hidden = [
                    f"{h.effect} @ {None if h.joint is None else plant.robot.joints[h.joint]}" for h in plant.hidden
                ]
                return (plant.robot, plant.recordings[:-1], plant.recordings[-1:]), hidden

            yield Case("another_simulator", f"seed {seed}, plant {index}", posed)


def _place(hidden: Any) -> str:
    return f"{hidden.effect} @ {hidden.joint}"
