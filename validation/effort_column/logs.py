"""Simulated logs whose column of effort holds something known."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

import lagnet
from lagnet.recordings.recording import Recording

ROBOTS = ("ur3", "ur5", "ur10", "panda", "kinova", "xarm7", "z1")
KINDS = (
    "torque",
    "link-side torque",
    "torque without gravity",
    "current",
    "current in mA",
    "torque in N mm",
    "magnitude of torque",
    "magnitude of current",
    "duty",
    "position",
    "position error",
    "constant",
)
TRUE = {"current in mA": ("current", "drive's own"), "torque in N mm": ("torque", "N mm")}
MASS_ERROR = 0.08


@dataclass(frozen=True, eq=False)
class Log:
    """A log, its nominal model and the truth."""

    recording: Recording
    robot: Any
    kind: str
    arm: str


@cache
def nominal(name: str) -> Any:
    """A maker's arm."""
    return lagnet.load_robot(name)


def make_log(kind: str, seed: int) -> Log:
    """One log of a kind."""
    rng = np.random.default_rng([seed, KINDS.index(kind)])
    arm = ROBOTS[int(rng.integers(len(ROBOTS)))]
    robot = nominal(arm)
    time, q, v, a = motion(robot, rng)
    real = other_arm(robot, rng)
    gravity = real.gravity_torque(q)
    link = real.inverse_dynamics(q, v, a)
    size = np.percentile(np.abs(link), 95, axis=0) + 1e-3 * np.abs(link).max()
    motor = link + drive(robot, q, v, a, size, rng)
    y, command = column(kind, robot, rng, {"link": link, "motor": motor, "gravity": gravity, "q": q, "v": v}, size)
    y = noisy(y, rng) if kind not in ("constant", "position") else y
    seen = q + rng.choice([1e-5, 1e-4]) * rng.standard_normal(q.shape)
    if kind == "position":
        y = np.degrees(seen)
    if kind.startswith("magnitude"):
        y = np.abs(y)
    recording = Recording(time, seen, y, robot.joints, command=command)
    return Log(recording, robot, kind, arm)


def other_arm(robot: Any, rng: np.random.Generator) -> Any:
    """The arm that moves: other masses, perhaps a tool."""
    parameters = robot.inertial_parameters()
    changed = parameters * (1 + MASS_ERROR * rng.standard_normal((robot.n_dof, 1)))
    real = robot.with_inertial_parameters(changed)
    if rng.random() < 0.5:
        mass = rng.uniform(0.1, 0.6)
        real = real.with_payload(mass, np.array([0.0, 0.0, rng.uniform(0.0, 0.1)]), 1e-3 * np.eye(3))
    return real


def motion(robot: Any, rng: np.random.Generator) -> tuple[np.ndarray, ...]:
    """Time, position, velocity and acceleration: sums of sines, or moves with pauses."""
    rate, duration = rng.choice([50.0, 100.0, 125.0, 250.0]), rng.uniform(20.0, 40.0)
    time = np.arange(int(rate * duration)) / rate
    lower = np.maximum(np.nan_to_num(robot.position_lower, neginf=-2.0), -2.0)
    upper = np.minimum(np.nan_to_num(robot.position_upper, posinf=2.0), 2.0)
    middle, reach = 0.5 * (lower + upper), 0.4 * (upper - lower)
    limit = np.where(np.isfinite(robot.velocity_limit) & (robot.velocity_limit > 0), robot.velocity_limit, 2.0)
    q, v, a = (np.zeros((time.size, robot.n_dof)) for _ in range(3))
    if rng.random() < 0.7:
        for _ in range(5):
            rate_, phase = rng.uniform(0.05, 0.6, robot.n_dof) * 2 * np.pi, rng.uniform(0, 2 * np.pi, robot.n_dof)
            size = rng.uniform(0.3, 1.0, robot.n_dof) * np.minimum(reach, 0.7 * limit / rate_) / 3
            angle = rate_ * time[:, None] + phase
            q += size * np.sin(angle)
            v += size * rate_ * np.cos(angle)
            a -= size * rate_**2 * np.sin(angle)
        return time, q + middle, v, a
    return time, *moves(time, middle, reach, limit, rng)


def moves(time: np.ndarray, middle: np.ndarray, reach: np.ndarray, limit: np.ndarray, rng: np.random.Generator):
    """Moves from point to point, fifth order, with pauses."""
    q, v, a = (np.zeros((time.size, middle.size)) for _ in range(3))
    start, t0 = middle.copy(), 0.0
    while t0 < time[-1]:
        goal = middle + reach * rng.uniform(-1, 1, middle.size)
        span = max(1.9 * np.max(np.abs(goal - start) / (rng.uniform(0.3, 0.8) * limit)), 0.3)
        s = np.clip((time - t0) / span, 0, 1)[:, None]
        rows = (time >= t0) & (time < t0 + span + 0.4)
        step = goal - start
        q[rows] = (start + step * (10 * s**3 - 15 * s**4 + 6 * s**5))[rows]
        v[rows] = (step * (30 * s**2 - 60 * s**3 + 30 * s**4) / span)[rows]
        a[rows] = (step * (60 * s - 180 * s**2 + 120 * s**3) / span**2)[rows]
        start, t0 = goal, t0 + span + 0.4
    return q, v, a


def drive(
    robot: Any, q: np.ndarray, v: np.ndarray, a: np.ndarray, size: np.ndarray, rng: np.random.Generator
) -> np.ndarray:
    """Friction and rotors of the drives [N m]."""
    n = robot.n_dof
    fast = np.percentile(np.abs(v), 95, axis=0)
    dry, wet = rng.uniform(0.08, 0.3, n) * size, rng.uniform(0.05, 0.3, n) * size / fast
    rotor = rng.uniform(0.0, 0.5, n) * np.mean(np.diagonal(robot.mass_matrix(q[::50]), axis1=1, axis2=2), axis=0)
    return dry * np.tanh(v / (0.01 * fast)) + wet * v + rotor * a


def column(
    kind: str, robot: Any, rng: np.random.Generator, of: dict[str, np.ndarray], size: np.ndarray
) -> tuple[np.ndarray, np.ndarray | None]:
    """The column, and the command where there is one."""
    n, motor = robot.n_dof, of["motor"]
    constants = rng.uniform(3.0, 20.0) * np.exp(0.3 * rng.standard_normal(n))
    bearing = 0.015 * size * np.tanh(of["v"] / 0.01)
    command = commanded(of, size, rng)
    limit = np.where(np.isfinite(robot.velocity_limit) & (robot.velocity_limit > 0), robot.velocity_limit, 2.0)
    full, stall = rng.choice([1.0, 100.0, 885.0]), rng.uniform(1.5, 3.0, n) * np.abs(motor).max(axis=0)
    duty = full * (motor / stall + of["v"] / (rng.uniform(1.1, 2.0, n) * limit))
    with_command = rng.random() < 0.5 or kind == "position error"
    y = {
        "torque": motor,
        "link-side torque": of["link"] + bearing,
        "torque without gravity": motor - of["gravity"],
        "current": motor / constants,
        "current in mA": 1000 * motor / constants,
        "torque in N mm": 1000 * motor,
        "magnitude of torque": motor,
        "magnitude of current": motor / constants,
        "duty": np.clip(duty, -full, full),
        "position": of["q"],
        "position error": rng.uniform(1.0, 100.0) * (command - of["q"]),
        "constant": np.zeros_like(motor),
    }[kind]
    return y, command if with_command else None


def commanded(of: dict[str, np.ndarray], size: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """What a controller was told that drives the motors: proportional, mostly with damping, gravity half of the time
    given by an integrator or a feed-forward."""
    damped = rng.random() < 0.75
    effort = of["motor"] - (of["gravity"] if rng.random() < 0.5 else 0.0)
    damping = rng.uniform(0.2, 1.0) * size / np.percentile(np.abs(of["v"]), 95, axis=0) if damped else 0.0
    return of["q"] + (effort + damping * of["v"]) / (rng.uniform(50.0, 200.0) * size)


def noisy(y: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Noise and rounding of the column."""
    spread = y.std(axis=0)
    found = y + rng.uniform(0.003, 0.02) * spread * rng.standard_normal(y.shape)
    if rng.random() < 0.5:
        step = 0.01 * spread.max()
        found = np.round(found / step) * step
    return found
