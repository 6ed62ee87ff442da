"""Run a plant: closed loop, forward dynamics in PyBullet, recordings as CSV."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from validation.plants.body import Body, BodySettings, Payload, joint_limits, joint_names
from validation.plants.drive import Drive, DrySurface
from validation.plants.events import Event, EventfulBody, event_of
from validation.plants.motions import MotionSettings, Reference, reference
from validation.plants.sensors import Sensors
from validation.plants.sizes import scale_of
from validation.plants.spec import Hidden, PlantSpec

FIT_SHAPES = ("waypoints", "fourier", "sweeps")
HOLDOUT_SHAPE = "fourier"


@dataclass(frozen=True, eq=False)
class Truth:
    """The parts of the true arm that a spec asks for; `events` holds what happens in which recording."""

    body: BodySettings
    drive: Drive
    sensors: Sensors
    events: tuple[tuple[int, Event], ...] = ()


@dataclass(frozen=True, eq=False)
class Run:
    """One true run at the plant's step: q, v, a and motor torque at the same instants, shape (n, dof)."""

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    tau: np.ndarray
    step: float


def build(spec: PlantSpec) -> Truth:
    """The true arm of a spec."""
    names = joint_names(spec.robot)
    truth = Truth(
        BodySettings(),
        Drive.ideal(len(names)),
        Sensors.ideal(len(names), noise=spec.noise, encoder_bits=spec.encoder_bits, velocity=spec.velocity),
    )
    for hidden in spec.hidden:
        if event := event_of(hidden):
            truth = replace(truth, events=(*truth.events, (int(hidden.values["recording"]), event)))
            continue
        truth = _with(truth, hidden, -1 if hidden.joint is None else names.index(hidden.joint))
    return truth


def _set(array: np.ndarray, joint: int, value: float) -> np.ndarray:
    changed = array.copy()
    changed[joint] = value
    return changed


def _with(truth: Truth, hidden: Hidden, j: int) -> Truth:
    x, body, drive, sensors = hidden.values, truth.body, truth.drive, truth.sensors
    match hidden.effect:
        case "viscous_friction":
            drive = replace(drive, damping=_set(drive.damping, j, x["Fv"]))
        case "quadratic_drag":
            drive = replace(drive, drag=_set(drive.drag, j, x["Fd"]))
        case "rotor_inertia":
            drive = replace(drive, armature=_set(drive.armature, j, x["Ia"]))
        case "joint_spring":
            drive = replace(drive, stiffness=_set(drive.stiffness, j, x["k"]), rest=_set(drive.rest, j, x["q0"]))
        case "coulomb_friction":
            drive = replace(drive, surfaces=(*drive.surfaces, DrySurface(j, x["Fc"], x["Fc"])))
        case "asymmetric_friction":
            drive = replace(drive, surfaces=(*drive.surfaces, DrySurface(j, x["Fc_plus"], x["Fc_minus"])))
        case "stribeck_friction":
            surface = DrySurface(j, x["Fc"], x["Fc"], x["Fs"], x["vs"])
            drive = replace(drive, surfaces=(*drive.surfaces, surface))
        case "payload":
            body = replace(body, payload=Payload(x["m"], (x["cx"], x["cy"], x["cz"]), x["radius"]))
        case "gravity_tilt":
            body = replace(body, tilt=(x["theta_1"], x["theta_2"]))
        case "torque_gain":
            sensors = replace(sensors, gain=_set(sensors.gain, j, x["g"]))
        case "torque_offset":
            sensors = replace(sensors, offset=_set(sensors.offset, j, x["b"]))
        case "time_delay":
            sensors = replace(sensors, delay=_set(sensors.delay, j, x["T"]))
        case other:
            raise ValueError(f"no plant physics for {other}")
    return replace(truth, body=body, drive=drive, sensors=sensors)


def run(truth: Truth, robot: str, wanted: Reference, recording: int = -1) -> Run:
    """Track a reference by computed torque of the nominal bodies, with the events of one recording."""
    step = float(wanted.time[1] - wanted.time[0])
    nominal = Body(robot, step=step)
    happens = [event for index, event in truth.events if index == recording]
    plant = EventfulBody(robot, truth.body, step, happens) if happens else Body(robot, truth.body, step=step)
    omega = _bandwidth(robot, step)
    n, dof = wanted.q.shape
    seen = np.empty((4, n, dof))
    plant.put(wanted.q[0], wanted.v[0] - step / 2 * wanted.a[1])
    a = wanted.a[1]
    for k in range(n):
        q, v = plant.state()
        v_mid = v + step / 2 * a  # the engine's speed lags its position by half a step
        pull = omega**2 * (wanted.q[k] - q) + 2 * omega * (wanted.v[k] - v_mid)
        tau = nominal.bias(q, v_mid) + nominal.inertia(q) @ (wanted.a[k] + pull)
        h = plant.bias(q, v_mid)
        links, a = truth.drive.transmit(tau, q, v, v_mid, plant.inertia(q), h, step)
        plant.push(links + plant.bias(q, v) - h)
        seen[:, k] = q, v + step / 2 * a, a, tau
    nominal.close()
    plant.close()
    return Run(seen[0], seen[1], seen[2], seen[3], step)


def _bandwidth(robot: str, step: float) -> np.ndarray:
    """Feedback bandwidth [rad/s]: a joint's typical torque moves it by a hundredth of a radian."""
    scale = scale_of(robot)
    return np.clip(np.sqrt(scale.torque / (0.01 * scale.inertia)), 40.0, 0.15 / step)


def simulate_plant(spec: PlantSpec, folder: Path) -> np.ndarray:
    """Write three recordings to fit and one to hold out into `folder`; the truth is not among them.

    Returns:
        What the held-out torque truly has beyond the nominal bodies, without noise, at the recorded samples, (n, dof).
    """
    truth = build(spec)
    folder.mkdir(parents=True, exist_ok=True)
    names = [f"fit_{i}" for i in range(len(FIT_SHAPES))] + ["holdout"]
    beyond = np.empty((0, 0))
    for index, (name, shape) in enumerate(zip(names, (*FIT_SHAPES, HOLDOUT_SHAPE), strict=True)):
        rng = np.random.default_rng([spec.seed, index])
        settings = MotionSettings(spec.duration, spec.step_rate, speed_share=spec.speed_share)
        true_run = run(truth, spec.robot, reference(shape, joint_limits(spec.robot), settings, rng), index)
        every = round(spec.step_rate / spec.rate)
        columns = truth.sensors.record(true_run.q, true_run.v, true_run.tau, true_run.step, every, rng)
        write_csv(folder / f"{name}.csv", columns)
        beyond = _beyond(spec.robot, truth.sensors, true_run, every)
    return beyond


def _beyond(robot: str, sensors: Sensors, true_run: Run, every: int) -> np.ndarray:
    shown = sensors.delayed(true_run.tau * sensors.gain + sensors.offset, true_run.step)[::every]
    body = Body(robot, step=true_run.step)
    rows = zip(true_run.q[::every], true_run.v[::every], true_run.a[::every], strict=True)
    rigid = [body.inertia(q) @ a + body.bias(q, v) for q, v, a in rows]
    body.close()
    return shown - np.stack(rigid)


def write_csv(path: Path, columns: dict[str, np.ndarray]) -> None:
    """A recording file with the column names of the recording contract."""
    header, data = ["time"], [columns["time"][:, None]]
    for name in ("q", "v", "tau"):
        if name in columns:
            header += [f"{name}_{i}" for i in range(columns[name].shape[1])]
            data.append(columns[name])
    np.savetxt(path, np.hstack(data), fmt="%.9g", delimiter=",", header=",".join(header), comments="")


def add_torque(path: Path, further: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> None:
    """Write a recording again with more torque.

    Args:
        path: of the file.
        further: torque to be added, shape (n, dof) [N m], from positions and torque, each of shape (n, dof).
    """
    header = path.read_text().splitlines()[0].split(",")
    table = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
    columns = {
        name: table[:, [n for n, column in enumerate(header) if column.startswith(f"{name}_")]]
        for name in ("q", "v", "tau")
    }
    columns["tau"] = columns["tau"] + further(columns["q"], columns["tau"])
    write_csv(path, {"time": table[:, 0]} | {name: x for name, x in columns.items() if x.size})
