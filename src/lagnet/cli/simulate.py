"""`lagnet simulate`: a robot moved in PyBullet, with known effects added, to recordings and a separate truth."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from lagnet.cli.shared.options import Hold
from lagnet.cli.shared.robots import held_joints


def command(
    robot: Annotated[str, typer.Option(help="Nominal model: URDF or MJCF path, or a name such as ur5.")],
    out: Annotated[Path, typer.Option(help="New folder to write recordings and truth.json to.")],
    hold: Hold = None,
    effects: Annotated[
        Path | None, typer.Option(help='TOML file of effects to add: [[effect]] name="..." joint="..." parameters.')
    ] = None,
    trajectories: Annotated[int, typer.Option(help="Number of recordings.")] = 4,
    seed: Annotated[int, typer.Option(help="Seed of motions and noise.")] = 0,
    engine: Annotated[str, typer.Option(help="Physics engine: pybullet.")] = "pybullet",
    duration: Annotated[float, typer.Option(help="Length of each recording [s].")] = 20.0,
    rate: Annotated[float, typer.Option(help="Samples a second [Hz].")] = 100.0,
    step_rate: Annotated[float, typer.Option(help="Steps of engine and controller a second [Hz].")] = 1000.0,
    torque_noise: Annotated[float, typer.Option(help="Torque noise as a share of each joint's torque.")] = 0.01,
    encoder_bits: Annotated[int, typer.Option(help="Encoder steps of a turn as a power of two; 0 for none.")] = 20,
    clock_jitter: Annotated[float, typer.Option(help="Jitter of the sampling clock [s].")] = 0.0,
    velocity: Annotated[bool, typer.Option(help="Record speeds too.")] = False,
    motion: Annotated[
        Path | None, typer.Option(help="Recording whose motion is followed, such as one that diagnose suggests.")
    ] = None,
) -> None:
    """Move a robot under torque control, with known effects added, and write recordings; the truth is kept apart."""
    from lagnet.cli.shared.console import above_zero, not_negative, say
    from lagnet.recordings.loading.load import load_recording
    from lagnet.rigid_body.robot import load_description
    from lagnet.simulation.effects_file import read_effects
    from lagnet.simulation.follow import follow
    from lagnet.simulation.motions import MotionSettings
    from lagnet.simulation.sensors import SensorSettings
    from lagnet.simulation.simulate import SimulationSettings, truth
    from lagnet.simulation.simulate import trajectories as simulated
    from lagnet.simulation.writing import TRUTH, check_free, write_simulation

    above_zero(step_rate, "--step-rate")
    not_negative(seed, "--seed")
    check_free(out)
    model = load_description(robot, held_joints(hold))
    model.require_mass()
    injected = read_effects(effects, model) if effects is not None else ()
    settings = SimulationSettings(
        trajectories=trajectories,
        seed=seed,
        engine=engine,
        motion=MotionSettings(duration=duration, rate=step_rate),
        sensors=SensorSettings(rate, torque_noise, encoder_bits, velocity, clock_jitter=clock_jitter),
    )
    known = truth(model, injected, settings)
    if motion is None:
        recordings = simulated(model, injected, settings)
    else:
        given = load_recording(motion, robot=model)
        parts = enumerate(given.parts())
        recordings = (follow(model, injected, p.time, p.q, replace(settings, seed=seed + n)) for n, p in parts)
        known |= {"motion": {"path": str(motion), "sha256": given.sha256}}
    for path in write_simulation(out, known, recordings):
        say(f"wrote {path}")
    say(f"the injected effects stand in {out / TRUTH}")
