"""Real recordings with the torque of a known load added: is it found, in its recording, with its mass and centre?

The load is a body on the last link; its torque along the recorded motion is added to the recorded torque. What a real
load changes beside it, such as friction that grows with load, is left out. Three ways of asking: against a model that
was calibrated on other recordings of the arm, beside a recording without the load against the maker's model, and of two
loads in two recordings against the maker's model, where their difference is determined. And without any load.

python -m validation.real_arms.added_loads [--quick] [--data DIR]
"""

from __future__ import annotations

import json
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.signal import butter, sosfiltfilt
from validation.real_arms.arms import UR10E
from validation.real_arms.joint_states import read_joint_states
from validation.real_arms.layers import cases, cut, read
from validation.real_arms.options import parser_of

from lagnet.diagnosis.diagnose import Diagnosis, diagnose
from lagnet.diagnosis.writing import write_diagnosis
from lagnet.models.files.loading import load_any
from lagnet.recordings.recording import Recording

HERE = Path(__file__).resolve().parent
SEEDS = (11, 12, 13)  # of the loads; the method was looked at with 1
RATED = {"ur10e": 12.5, "panda": 3.0, "ur10": 10.0}  # [kg], payload by the makers' data sheets
SHARES = (0.1, 0.6)  # of the rated payload, between which masses are drawn
REACH = np.array([[-0.1, 0.1], [-0.1, 0.1], [0.0, 0.2]])  # [m], of the centre in the frame of the last joint
RADIUS = (0.03, 0.08)  # [m], of the sphere that the load is
BAND = 15.0  # [Hz] of the motion along which the load's torque is computed
NEAR = 0.1  # relative error of a mass
APART = 0.03  # [m] by which a centre may be off
TWO = -1  # in the place of a recording's number: what the second has more than the first
Found = tuple[int | None, float, np.ndarray]
"""Recording, mass [kg] and centre [m] of a load."""


@dataclass(frozen=True)
class Load:
    """A sphere on the last link: mass [kg], centre [m] in the frame of the last joint, radius [m]."""

    mass: float
    centre: np.ndarray
    radius: float

    def torque(self, robot: Any, recording: Recording) -> np.ndarray:
        """Along a recorded motion, shape (n, dof) [N m]."""
        step = float(np.median(np.diff(recording.time)))
        clock = np.arange(recording.time[0], recording.time[-1], step)
        even = np.column_stack([np.interp(clock, recording.time, x) for x in recording.q.T])
        q = sosfiltfilt(butter(2, min(0.9, 2.0 * BAND * step), output="sos"), even, axis=0)
        v = np.gradient(q, step, axis=0)
        motion = q, v, np.gradient(v, step, axis=0)
        inertia = 0.4 * self.mass * self.radius**2 * np.eye(3)
        loaded = robot.with_payload(self.mass, self.centre, inertia)
        added = loaded.inverse_dynamics(*motion) - robot.inverse_dynamics(*motion)
        return np.column_stack([np.interp(recording.time, clock, x) for x in added.T])

    def on(self, robot: Any, recording: Recording) -> Recording:
        """The recording as if the arm had carried it."""
        return replace(recording, tau=recording.torque + self.torque(robot, recording))

    def beyond(self, other: Load) -> tuple[float, np.ndarray]:
        """Mass and centre of what it has more than another."""
        mass = self.mass - other.mass
        return mass, (self.mass * self.centre - other.mass * other.centre) / mass


def drawn(draw: np.random.Generator, rated: float) -> Load:
    """A load within the shares of what the arm may carry."""
    mass = rated * float(np.exp(draw.uniform(*np.log(SHARES))))
    return Load(mass, draw.uniform(*REACH.T), float(draw.uniform(*RADIUS)))


@dataclass(frozen=True)
class Arm:
    """The maker's model, recordings to calibrate it with, and two others."""

    robot: Any
    calibration: list[Recording]
    pair: tuple[Recording, Recording]


def arms(data: Path) -> dict[str, Callable[[], Arm]]:
    """The real arms with more than ten seconds of motion in two parts."""

    def ur10e() -> Arm:
        robot = load_any(data / UR10E.folder / UR10E.urdf)
        first, second, *pair = (read(data / UR10E.folder / f, robot, UR10E) for f in UR10E.fit)
        return Arm(robot, [first, second], (pair[0], pair[1]))

    def panda() -> Arm:
        robot, fit, held = cases(data)["panda"]()
        return Arm(robot, fit, (fit[0], held[0]))

    def ur10() -> Arm:
        robot = load_any("ur10")
        whole = read_joint_states(data / "bags" / "ur10_exciting_trajectory.db3", robot.joints)
        first, later = cut(whole, 0.6)
        return Arm(robot, first, (first[0], later[0]))

    return {"ur10e": ur10e, "panda": panda, "ur10": ur10}


def calibrated(arm: Arm) -> Any:
    """The maker's model as corrected by recordings without a load."""
    with tempfile.TemporaryDirectory() as scratch:
        write_diagnosis(diagnose(arm.calibration, arm.robot, seed=0), Path(scratch))
        return load_any(Path(scratch) / "corrected")


def questions(arm: Arm, model: Any, one: Load, two: Load) -> Iterator[tuple[str, Any, list[Recording], Any]]:
    """What is asked: its name, the model, the recordings, and the number of the loaded one with mass and centre."""
    first, second = arm.pair
    light = replace(two, mass=0.5 * one.mass)
    yield "calibrated", model, [one.on(arm.robot, second)], (None, one.mass, one.centre)
    yield "beside a free one", arm.robot, [first, one.on(arm.robot, second)], (1, one.mass, one.centre)
    both = [light.on(arm.robot, first), one.on(arm.robot, second)]
    yield "two loads", arm.robot, both, (TWO, *one.beyond(light))


def without_load(arm: Arm, model: Any) -> Iterator[tuple[str, Any, list[Recording], Any]]:
    """The same recordings as they are: no load may be found."""
    yield "calibrated, no load", model, [arm.pair[1]], None
    yield "two free ones", arm.robot, [*arm.pair], None


def answer(model: Any, recordings: list[Recording], truth: Any) -> dict[str, Any]:
    """What a diagnosis finds, and whether it is the load that was added."""
    named = [replace(r, path=f"recording_{n}") for n, r in enumerate(recordings)]
    cpu = time.process_time()
    result = diagnose(named, model, seed=0)
    loads = [_load_of(e) for e in result.effects if e.effect == "payload"]
    told = {
        "added": None if truth is None else _told(*truth),
        "found": [_told(*one) for one in loads],
        "others_named": len(result.effects) - len(loads),
        "nmse": _errors(result),
        "seconds_of_processor": round(time.process_time() - cpu, 1),
    }
    return {"right": _is_right(loads, truth, len(recordings)), **told}


def _load_of(effect: Any) -> Found:
    number = None if effect.recording is None else int(effect.recording.rsplit("_", 1)[1])
    return number, effect.value("m"), np.array([effect.value(c) for c in ("cx", "cy", "cz")])


def _told(number: int | None, mass: float, centre: np.ndarray) -> dict[str, Any]:
    return {"recording": number, "m": round(float(mass), 3), "centre": [round(float(x), 3) for x in centre]}


def _errors(result: Diagnosis) -> dict[str, list[float]]:
    layers = ("nominal", "named", "identified", "full")
    return {k: [round(float(getattr(f, f"nmse_{k}")), 5) for f in result.verdict.fit] for k in layers}


def _is_right(found: Sequence[Found], truth: Found | None, recordings: int) -> bool:
    """Whether the loads are those that were added; of two recordings, whether the second has what it has more.

    A load that both have, and a further one in the second, is what it has more.
    """
    if truth is None:
        return not [one for one in found if one[0] is not None or recordings == 1]
    if truth[0] == TWO and {one[0] for one in found} == {None, 1}:
        found = [one for one in found if one[0] is not None]
    if len(found) == 2 and truth[0] == TWO:
        (_, less, at_less), (_, more, at_more) = sorted(found, key=lambda one: one[0] or 0)
        mass = more - less
        found = [(TWO, mass, (more * at_more - less * at_less) / mass)]
    if len(found) != 1:
        return False
    (number, mass, centre), (where, true_mass, true_centre) = found[0], truth
    near = abs(mass - true_mass) <= NEAR * true_mass and bool(np.all(np.abs(centre - true_centre) <= APART))
    return number in ((1, TWO) if where == TWO else (where,)) and near


def main() -> int:
    """Run the study; 0 if every load is found where it is, and none where there is none."""
    options = parser_of(__doc__, "one arm, one load").parse_args()
    found: dict[str, Any] = {}
    for name, make in list(arms(options.data).items())[: 1 if options.quick else None]:
        arm = make()
        model = calibrated(arm)
        asked = [] if options.quick else [("", q) for q in without_load(arm, model)]
        for seed in SEEDS[: 1 if options.quick else None]:
            draw = np.random.default_rng(seed)
            pair = [drawn(draw, RATED[name]) for _ in range(2)]
            asked += [(f" {seed}", q) for q in questions(arm, model, *pair)]
        for which, (question, nominal, recordings, truth) in asked[: 1 if options.quick else None]:
            key = f"{name}: {question}{which}"
            found[key] = answer(nominal, recordings, truth)
            print("right" if found[key]["right"] else "WRONG", key, json.dumps(found[key]), flush=True)
    right = sum(one["right"] for one in found.values())
    told = {"study": "added_loads", "passed": right == len(found), "right": right, "asked": len(found), "cases": found}
    if not options.quick:
        (HERE / "added_loads.json").write_text(json.dumps(told, indent=1, ensure_ascii=False) + "\n")
    print(f"{right} of {len(found)} right")
    return 0 if told["passed"] else 1


if __name__ == "__main__":
    raise SystemExit(main())
