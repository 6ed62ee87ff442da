"""The mapping file that `lagnet data inspect` writes: what was recognised as comments, what must be stated to edit."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

from lagnet.recordings.inspection.describe import Description

SECTIONS = ("columns", "scale", "offset", "torque_constant")
DEGREES = (
    "# q = 0.0174532925        # degrees to rad; the same for command, v (degrees per second) and command_velocity",
    "# time = 0.001            # milliseconds to seconds",
)


def mapping_file(found: Description, joints: Sequence[str], effort: Mapping[str, Sequence[str]] | None = None) -> str:
    """The text of a mapping file, valid TOML as it is written.

    Args:
        found: what is known of the log.
        joints: the robot's joints, or the log's without a robot.
        effort: lines of what was found out about the column of effort, by section.
    """
    lines = [
        f"# {_one_line(found.path)}: {found.origin.format}, recognised by {_one_line(found.origin.recognised_by)}",
        f"# clock: {_one_line(found.origin.clock)}",
        *[f"# note: {_one_line(text)}" for text in (found.recording.warnings if found.recording else ())],
        *([f"# refused as it stands: {_one_line(found.refused)}"] if found.refused else []),
        "# Edit, then give it with --columns. Lines that begin with # are not read.",
    ]
    sections = {name: list((effort or {}).get(name, ())) for name in SECTIONS}
    sections["columns"] = [*_columns(found, joints), *sections["columns"]]
    sections["scale"] += DEGREES
    for name in SECTIONS:
        if name == "torque_constant" and not sections[name]:
            continue
        lines += ["", f"[{name}]", *sections[name]]
    return "\n".join(lines) + "\n"


def _columns(found: Description, joints: Sequence[str]) -> list[str]:
    lines = []
    if found.match is not None:
        for joint, k in zip(joints, found.match.index, strict=True):
            text = f"{joint} is not in the log" if k is None else f"{joint} is {found.joints[k]} (by {found.match.how})"
            lines.append(f"# {_one_line(text)}")
        if not found.match.complete:
            lines += [f'# "q_{_bare(joint)}" = "q_0"  # give its column' for joint in joints]
    lines += [f"{json.dumps(ours)} = {json.dumps(theirs)}  # a guess" for ours, theirs in found.guessed.items()]
    shown = ", ".join(found.columns[:40]) + (", …" if len(found.columns) > 40 else "")
    return [*lines, f"# the file's columns: {_one_line(shown)}"]


def _bare(joint: str) -> str:
    return json.dumps(joint)[1:-1]


def _one_line(text: str) -> str:
    """Names in a file may hold line ends, which would end a comment."""
    return "".join(sign if sign.isprintable() else " " for sign in text)
