"""Draws arms with something hidden, simulates them and writes down what their sensors say."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lagnet.recordings.recording import Recording
from lagnet.rigid_body.random_arm import random_arm_urdf
from lagnet.rigid_body.robot import Robot, load_description
from validation.another_simulator import motions
from validation.another_simulator.hidden import ALONE, BESIDE, NEEDS_TORQUE, UNLISTED, Hidden, Usual, drawn
from validation.another_simulator.mujoco_arm import CameApartError, MujocoArm, Reference, Written

KINDS = (*ALONE, "nothing", *UNLISTED, "nothing")
ARMS = ("ur3", "kinova", "xarm7", "z1")
RUNS = 4  # the last is held out
HELD_OUT_FREE = (1, 3)  # runs in which nothing touches the arm
REACH, SPEED = 2.6, 2.0  # [rad], [rad/s] where the arm says nothing, or more
STARTS = 2.0  # [s] cut off
TRIES = 12
SHOWN = 0.5  # of the noise, that the torque of a cause must reach at some joint to be asked for


@dataclass(frozen=True)
class Plant:
    """An arm, what is hidden in it, and its recordings, the last to be held out.

    Args:
        shown: whether each cause has a torque of at least half the noise in the first recording.
    """

    name: str
    robot: Robot
    hidden: tuple[Hidden, ...]
    recordings: tuple[Recording, ...]
    shown: tuple[bool, ...]


def plant(seed: int, index: int, seconds: float) -> Plant:
    """The plant of a seed and an index; drawn again where the simulation comes apart.

    Raises:
        CameApartError: it came apart every time.
    """
    rng = np.random.default_rng([seed, index])
    for _ in range(TRIES):
        try:
            return _drawn(f"{KINDS[index % len(KINDS)]}_{index}", KINDS[index % len(KINDS)], seconds, rng)
        except CameApartError:
            continue
    raise CameApartError(f"plant {index} of seed {seed}: {TRIES} draws came apart")


def _drawn(name: str, kind: str, seconds: float, rng: np.random.Generator) -> Plant:
    robot, urdf = _arm(rng)
    free = MujocoArm(urdf)
    lower, upper, speed = _limits(robot)
    style = str(rng.choice(["sines", "moves"]))
    references = [motions.drawn(style, lower, upper, speed, seconds, rng) for _ in range(RUNS)]
    usual = free.usual(references[0], seconds)
    hidden = _hidden(kind, usual, rng)
    rate, noise = float(rng.choice([100, 125, 200])), float(rng.choice([0.003, 0.01]))
    written = [_run(urdf, free, _present(hidden, k), r, seconds, rate) for k, r in enumerate(references)]
    scatter = noise * np.maximum(np.sqrt(np.mean([np.mean(w.tau**2, axis=0) for w in written], axis=0)), 1e-3)
    step, speeds = float(rng.choice([1e-5, 1e-4])), bool(rng.random() < 0.5)
    recordings = tuple(_sensed(w, robot.joints, hidden, scatter, step, speeds, rng) for w in written)
    others = [_run(urdf, free, [h for h in hidden if h is not cause], references[0], seconds, rate) for cause in hidden]
    shown = [_shows(robot, written[0], other, hidden, h, scatter) for h, other in zip(hidden, others, strict=True)]
    return Plant(name, robot, hidden, recordings, tuple(shown))


def _arm(rng: np.random.Generator) -> tuple[Robot, str]:
    """An arm drawn at random, in three of five, or a maker's."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "arm.urdf"
        if rng.random() < 0.6:
            file.write_text(random_arm_urdf(int(rng.integers(4, 8)), int(rng.integers(2**31)), ("revolute",)))
        else:
            load_description(str(rng.choice(ARMS))).write_bare_urdf(file)
        return load_description(str(file)), file.read_text()


def _limits(robot: Robot) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Position and speed limits, each of shape (dof,), with our own where the arm has none."""
    lower = np.maximum(np.nan_to_num(robot.position_lower, nan=-REACH, neginf=-REACH), -REACH)
    upper = np.minimum(np.nan_to_num(robot.position_upper, nan=REACH, posinf=REACH), REACH)
    fast = np.nan_to_num(robot.velocity_limit, nan=SPEED, posinf=SPEED)
    return lower, upper, np.where(fast > 0, np.minimum(fast, SPEED), SPEED)


def _hidden(kind: str, usual: Usual, rng: np.random.Generator) -> tuple[Hidden, ...]:
    """The kind, and in three of five a plain cause beside it."""
    if kind == "nothing":
        return ()
    n = usual.torque.size
    carried = np.flatnonzero(usual.torque >= 0.1 * usual.torque.max())
    joints = carried if kind in NEEDS_TORQUE else np.arange(n - 1 if kind in ("rotor_inertia", "link_inertia") else n)
    out = [drawn(kind, int(rng.choice(joints)), usual, rng)]
    beside = str(rng.choice([b for b in BESIDE if b != kind]))
    clash = kind == "stribeck_friction" and beside == "coulomb_friction"
    if kind not in UNLISTED and not clash and rng.random() < 0.6:
        out.append(drawn(beside, int(rng.integers(0, n - 1)), usual, rng))
    return tuple(out)


def _present(hidden: Sequence[Hidden], run: int) -> list[Hidden]:
    return [h for h in hidden if h.effect != "contact_force" or run not in HELD_OUT_FREE]


def _run(
    urdf: str, free: MujocoArm, hidden: Sequence[Hidden], reference: Reference, seconds: float, rate: float
) -> Written:
    return MujocoArm(urdf, hidden).run(free, reference, seconds, rate)


def _shows(
    robot: Robot, with_it: Written, without: Written, hidden: Sequence[Hidden], cause: Hidden, scatter: np.ndarray
) -> bool:
    """Whether what the model leaves unexplained differs with a cause by half of the noise, at some joint."""
    left = []
    for written, causes in ((with_it, hidden), (without, [h for h in hidden if h is not cause])):
        q, tau = _faulty(written, causes)
        a = np.gradient(written.v, written.time, axis=0)
        left.append((tau - robot.inverse_dynamics(q, written.v, a))[written.time >= STARTS])
    return bool(np.any(np.sqrt(np.mean((left[0] - left[1]) ** 2, axis=0)) >= SHOWN * scatter))


def _faulty(written: Written, hidden: Sequence[Hidden]) -> tuple[np.ndarray, np.ndarray]:
    """Positions and torque as faulty sensors read them, without noise."""
    time, q, tau = written.time, written.q.copy(), written.tau.copy()
    for cause in hidden:
        j, values = cause.joint, cause.values
        match cause.effect:
            case "torque_gain":
                tau[:, j] *= values["g"]
            case "torque_offset":
                tau[:, j] += values["b"]
            case "encoder_offset":
                q[:, j] += values["dq"]
            case "saturation":
                tau[:, j] = np.clip(tau[:, j], -values["most"], values["most"])
            case "time_delay":
                tau[:, j] = np.interp(time - values["T"], time, tau[:, j])
    return q, tau


def _sensed(
    written: Written,
    joints: tuple[str, ...],
    hidden: Sequence[Hidden],
    scatter: np.ndarray,
    step: float,
    speeds: bool,
    rng: np.random.Generator,
) -> Recording:
    """The recording: faulty sensors, noise of torque, positions in steps of the encoder."""
    time, v = written.time, written.v
    q, tau = _faulty(written, hidden)
    tau += scatter * rng.standard_normal(tau.shape)
    seen = v + 0.002 * np.sqrt(np.mean(v**2, axis=0)) * rng.standard_normal(v.shape) if speeds else None
    keep = time >= STARTS
    return Recording(
        time[keep], step * np.round(q[keep] / step), tau[keep], joints, v=None if seen is None else seen[keep]
    )
