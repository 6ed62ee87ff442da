"""`lagnet demo`: the main job on a case of our own, with the truth in an envelope that the diagnosis never sees."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

ROBOT = "ur5"


def command(
    out: Annotated[Path, typer.Option(help="Folder to write.")] = Path("lagnet-demo"),
    seed: Annotated[int, typer.Option(help="Which effects are hidden, and all noise.")] = 4,
    route: Annotated[str, typer.Option(help="torque, or motion: recordings of commands and positions.")] = "torque",
) -> None:
    """Hide an effect in a simulated arm, diagnose it, open the envelope and compare."""
    from lagnet.cli.parts.envelope import say_opened, seal
    from lagnet.cli.parts.motion import check_route
    from lagnet.cli.parts.motion_demo import demonstrate_on_motion
    from lagnet.cli.shared.console import say
    from lagnet.diagnosis.diagnose import diagnose
    from lagnet.diagnosis.writing import write_diagnosis
    from lagnet.models.files.loading import load_any
    from lagnet.recordings.loading.load import load_recording
    from lagnet.recordings.writing import write_recording
    from lagnet.reports.diagnosis_report import write_report
    from lagnet.simulation.simulate import SimulationSettings, trajectories, truth
    from lagnet.simulation.surprise import draw_surprise

    check_route(route)
    if route == "motion":
        demonstrate_on_motion(out, seed)
        return
    robot = load_any(ROBOT)
    hidden, settings = draw_surprise(robot, seed), SimulationSettings(trajectories=4, seed=seed)
    recordings = out / "recordings"
    recordings.mkdir(parents=True, exist_ok=True)
    seal_of_truth = seal(truth(robot, hidden, settings), out)
    say(f"1. Physics is hidden in a {ROBOT.upper()}; the envelope has sha256 {seal_of_truth}")
    paths = []
    for index, recording in enumerate(trajectories(robot, hidden, settings)):
        paths.append(write_recording(recording, recordings / f"trajectory_{index}.csv"))
        say(f"   recorded {paths[-1]}")
    say("2. The diagnosis is given the recordings and the plain URDF")
    read = [load_recording(path, robot=robot) for path in paths]
    result = diagnose(read[:-1], robot, read[-1:], seed=seed)
    write_diagnosis(result, out)
    page = write_report(result.verdict.to_dict(), result.evidence, out / "report.html")
    say_opened(out, result.verdict.to_dict(), page)
