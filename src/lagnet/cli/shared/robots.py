"""Robots of a command, some of whose joints no recording tells of: `--hold finger_joint1=0.04,finger_joint2=0.04`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from lagnet.errors import LagnetError

HELP = "Joints that no recording tells of, held still: NAME=POSITION [rad or m], comma-separated, e.g. fingers."


def held_joints(text: str | None) -> dict[str, float]:
    """Position of each joint of a `--hold` option.

    Raises:
        LagnetError: a part that is not NAME=POSITION.
    """
    held = {}
    for part in text.split(",") if text else ():
        name, _, position = part.strip().rpartition("=")
        try:
            held[name] = float(position)
            name = name if math.isfinite(held[name]) else ""
        except ValueError:
            name = ""
        if not name:
            what, mended = (
                f"{part.strip()!r} is not a joint and its position",
                "write NAME=POSITION, like finger_joint1=0.04",
            )
            raise LagnetError(what, where="--hold", next_step=mended)
    return held


def load_models(specs: Sequence[str], hold: str | None) -> list[Any]:
    """What `lagnet.load_robot` makes of each; joints are held still in every URDF, MJCF and named robot.

    Raises:
        LagnetError: joints to hold, and folders alone, whose models have the joints they were made with.
    """
    from lagnet.models.files.loading import load_any

    held, folders = held_joints(hold), [Path(spec).is_dir() for spec in specs]
    if all(folders):
        return [load_any(spec, held) for spec in specs]
    return [load_any(spec) if folder else load_any(spec, held) for spec, folder in zip(specs, folders, strict=True)]
