"""Read which effects to inject from a TOML file of `[[effect]]` tables."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

from lagnet.errors import EffectError
from lagnet.files import read_bounded
from lagnet.rigid_body.robot import Robot
from lagnet.simulation.injection import InjectedEffect, inject

LARGEST = 1_000_000  # bytes; a list of effects is a few lines
FAR_TOO_LARGE = 1e9  # in SI units
MOST = 200  # effects; a few for every joint
EXAMPLE = '[[effect]] with name = "viscous_friction", joint = "elbow_joint", Fv = 2.0'


def read_effects(path: str | Path, robot: Robot) -> tuple[InjectedEffect, ...]:
    """The effects of a file, checked against the catalogue and the robot.

    Args:
        path: TOML with one `[[effect]]` table for each effect: `name`, `joint` (not for effects of the whole arm), and
            every parameter by name.
        robot: whose joints are meant.

    Raises:
        EffectError: naming the file, the entry, what is wrong and the valid choices.
    """
    path = Path(path)
    tables = _tables(path)
    return tuple(_one(table, robot, f"{path}, effect {i + 1}") for i, table in enumerate(tables))


def _tables(path: Path) -> list[dict]:
    try:
        size = path.stat().st_size
        if size > LARGEST:
            raise EffectError(f"{size} bytes are too many for a list of effects", where=str(path))
        content = tomllib.loads(read_bounded(path, LARGEST).decode("utf-8"))
    except OSError as error:
        raise EffectError(error.strerror or "cannot be read", where=str(path)) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        reason = str(error).splitlines()[0] if str(error) else "too deep"
        raise EffectError(f"is no TOML: {reason}", where=str(path), next_step=f"write {EXAMPLE}") from None
    others = [key for key in content if key != "effect"]
    if others:
        raise EffectError(f"unknown table {others[0]!r}", where=str(path), choices=["effect"])
    tables = content.get("effect", [])
    if not isinstance(tables, list) or not all(isinstance(t, dict) for t in tables):
        raise EffectError("effect is not a list of tables", where=str(path), next_step=f"write {EXAMPLE}")
    if len(tables) > MOST:
        raise EffectError(f"{len(tables)} effects, at most {MOST} can be injected", where=str(path))
    return tables


def _one(table: dict, robot: Robot, where: str) -> InjectedEffect:
    name, joint = table.get("name"), table.get("joint")
    if not isinstance(name, str):
        raise EffectError("the name is missing", where=where, next_step=f"write {EXAMPLE}")
    if joint is not None and not isinstance(joint, str):
        raise EffectError(f"the joint is {joint!r}, not a name", where=where, choices=robot.joints)
    values = {key: value for key, value in table.items() if key not in ("name", "joint")}
    for key, value in values.items():
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise EffectError(f"{key} is {value!r}, not a number", where=where)
        if math.isfinite(value) and abs(value) >= FAR_TOO_LARGE:
            raise EffectError(f"{key} is {value:.3g}, which no arm has", where=where)
    return inject(robot, name, joint, {key: float(value) for key, value in values.items()}, where)
