"""What `lagnet data inspect` prints and writes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from lagnet.errors import LagnetError


def inspect_file(
    file: Path, robot: str | None, columns: Path | None, progress: Callable[[str, int, int | None], None] | None
) -> tuple[list[str], str]:
    """Lines for a terminal, and the text of the mapping file."""
    from lagnet.recordings.inspection.describe import describe
    from lagnet.recordings.inspection.mapping_file import mapping_file
    from lagnet.recordings.inspection.sentences import sentences

    model = None
    if robot is not None:
        from lagnet.models.files.loading import load_any

        model = load_any(robot)
    found = describe(file, model, columns, progress)
    said, mapping = _effort(found, model) if model is not None else ([NO_ROBOT], {})
    joints = tuple(model.joints) if model is not None else found.joints
    return [*sentences(found), *said], mapping_file(found, joints, mapping)


NO_ROBOT = "effort: give --robot to have it compared with the model's torque"


def _effort(found: Any, model: Any) -> tuple[list[str], dict[str, list[str]]]:
    """What the column of effort most likely holds, its evidence, and the lines that read it so."""
    from lagnet.diagnosis.effort_column.decide import effort_column

    recording = found.recording
    if recording is None or recording.joints != tuple(model.joints):
        return ["effort: not compared, as the joints are not those of the robot"], {}
    column = next((kind for kind in ("tau", "current", "duty") if getattr(recording, kind) is not None), None)
    if column is None:
        return ["effort: none was recorded"], {}
    try:
        finding = effort_column([recording], model, column)
    except LagnetError as error:
        return [f"effort: not compared ({error})"], {}
    index = found.match.index if found.match is not None and found.match.complete else range(len(model.joints))
    mapping = finding.mapping([f"tau_{k}" for k in index]) if column == "tau" else {}
    shares = ", ".join(f"{name} {max(share, 0):.0%}" for name, share in finding.explained.items())
    evidence = [f"  {text}" for text in finding.evidence]
    return [f"effort: {finding.sentence()}", *evidence, *([f"  predicted of it: {shares}"] if shares else [])], mapping
