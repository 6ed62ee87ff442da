"""Simulate an arm with left-out physics: motions, closed loop, sensors, and the truth kept apart."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field

import numpy as np

from lagnet.errors import LagnetError
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import Robot
from lagnet.simulation.closed_loop import LoopSettings, run_closed_loop
from lagnet.simulation.injection import InjectedEffect, StepPhysics, seen_torque
from lagnet.simulation.motions import SHAPES, MotionSettings, draw_motion
from lagnet.simulation.pybullet_arm import load_pybullet
from lagnet.simulation.sensors import SensorSettings, record

ENGINES = ("pybullet",)


@dataclass(frozen=True)
class SimulationSettings:
    """Everything that shapes a simulation; the same settings and seed give the same recordings, bit for bit.

    Args:
        trajectories: number of recordings.
        seed: of motions and noise.
        engine: a name of `ENGINES`.
        shapes: motions, taken in turn.
        slow: speed below which the sign of the velocity is blurred in the injected laws [rad/s].
        motion, loop, sensors: settings of the parts.
    """

    trajectories: int = 4
    seed: int = 0
    engine: str = "pybullet"
    shapes: tuple[str, ...] = ("random_moves", "fourier", "slow_sweeps", "fourier")
    slow: float = 0.005
    motion: MotionSettings = field(default_factory=MotionSettings)
    loop: LoopSettings = field(default_factory=LoopSettings)
    sensors: SensorSettings = field(default_factory=SensorSettings)


@dataclass(frozen=True, eq=False)
class Simulation:
    """Recordings as a laboratory would give them, and the truth that it would not have."""

    recordings: tuple[Recording, ...]
    truth: dict


def simulate(
    robot: Robot, effects: Sequence[InjectedEffect] = (), settings: SimulationSettings | None = None
) -> Simulation:
    """Move a robot whose simulation lacks the given effects, and record it.

    Args:
        robot: the nominal model.
        effects: what the recordings show and the nominal model lacks.
        settings: the whole simulation; the defaults where None.

    Raises:
        LagnetError: settings that make no sense.
        MissingExtraError: the engine is not installed.
    """
    settings = settings or SimulationSettings()
    return Simulation(tuple(trajectories(robot, effects, settings)), truth(robot, effects, settings))


def trajectories(robot: Robot, effects: Sequence[InjectedEffect], settings: SimulationSettings) -> Iterator[Recording]:
    """The recordings of `simulate`, one by one as they are finished; settings are checked before the first."""
    check_settings(settings)
    load_pybullet()
    return (_trajectory(robot, effects, settings, index) for index in range(settings.trajectories))


def _trajectory(robot: Robot, effects: Sequence[InjectedEffect], settings: SimulationSettings, index: int) -> Recording:
    slow = np.full(robot.n_dof, settings.slow)
    shape = settings.shapes[index % len(settings.shapes)]
    motion_seed, noise_seed = np.random.SeedSequence([settings.seed, index]).generate_state(2)
    wanted = draw_motion(robot, shape, settings.motion, int(motion_seed))
    run = run_closed_loop(robot, StepPhysics.of(robot, effects, slow), wanted, settings.loop)
    tau = seen_torque(effects, robot, slow, (run.time, run.q, run.v, run.a, run.tau))
    return record(run, tau, robot.joints, settings.sensors, int(noise_seed))


def check_settings(settings: SimulationSettings) -> None:
    """Hold settings against what can be simulated.

    Raises:
        LagnetError: naming the setting and what would be valid.
    """
    if settings.engine not in ENGINES:
        raise LagnetError(f"unknown engine {settings.engine!r}", choices=ENGINES)
    if settings.trajectories < 1:
        raise LagnetError(f"{settings.trajectories} trajectories are none", next_step="ask for at least 1")
    if settings.seed < 0:
        raise LagnetError(f"the seed is {settings.seed}", next_step="give a whole number from 0")
    if not set(settings.shapes) <= set(SHAPES) or not settings.shapes:
        raise LagnetError(f"unknown motions in {', '.join(settings.shapes) or 'an empty list'}", choices=SHAPES)
    if not 500.0 <= settings.motion.rate <= 10_000.0:
        raise LagnetError(f"a step rate of {settings.motion.rate:g} Hz", next_step="take 500 to 10000 Hz")
    if not 1.0 <= settings.motion.duration <= 3600.0:
        raise LagnetError(f"a duration of {settings.motion.duration:g} s", next_step="take 1 to 3600 s")
    if not 0 <= settings.sensors.torque_noise <= 1:
        raise LagnetError(
            f"a torque noise of {settings.sensors.torque_noise:g}", next_step="give a share of the torque, 0 to 1"
        )
    if not 0 <= settings.sensors.encoder_bits <= 40:
        raise LagnetError(f"an encoder of {settings.sensors.encoder_bits} bits", next_step="take 0 to 40")
    if not 0 <= settings.sensors.clock_jitter <= 1:
        raise LagnetError(f"a clock jitter of {settings.sensors.clock_jitter:g} s", next_step="take 0 to 1 s")
    if not 0 < settings.sensors.rate <= settings.motion.rate:
        raise LagnetError("recordings cannot be faster than the engine", where=f"{settings.sensors.rate:g} Hz")


def truth(robot: Robot, effects: Sequence[InjectedEffect], settings: SimulationSettings) -> dict:
    """What was injected, as plain data: the envelope that a diagnosis must not open."""
    return {
        "schema": "lagnet-truth/1",
        "robot": {"kind": robot.kind, "source": robot.source, "sha256": robot.sha256, "joints": list(robot.joints)},
        "effects": [
            {
                "effect": e.effect.name,
                "joint": None if e.joint is None else robot.joints[e.joint],
                "parameters": e.values,
            }
            for e in effects
        ],
        "settings": asdict(settings),
    }
