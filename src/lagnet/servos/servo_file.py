"""SERVO.toml: the servos of a robot, one table a joint, `[all]` for every joint.

    [all]
    kp = 17.8            # N m/rad
    delay = 0.02         # s
    [shoulder_lift]
    torque_limit = 2.9   # N m

Names are those of `lagnet.servos.parameters.LAW`; `damping`, `frictionloss` and `armature` are understood as well.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.errors import LagnetError, closest
from lagnet.files import read_bounded
from lagnet.servos.nominal import NominalServo
from lagnet.servos.parameters import INDEX, LAW, NAMES, NEUTRAL

ALIASES = {"damping": "viscous", "frictionloss": "coulomb", "armature": "rotor", "kv": "kd"}
EVERY = "all"
MOST_BYTES = 1_000_000


def read_servo_file(path: str | Path, joints: Sequence[str], armature: np.ndarray) -> NominalServo:
    """The nominal servos that a file describes.

    Args:
        path: of the TOML; joints: names in model order.
        armature: shape (dof,), rotors of the robot's description, used where the file gives none [kg m²].

    Raises:
        LagnetError: unreadable, an unknown joint or parameter, or a value out of its bounds.
    """
    where = str(path)
    try:
        tables = tomllib.loads(read_bounded(path, MOST_BYTES).decode("utf-8"))
    except OSError as error:
        raise LagnetError(
            f"cannot be read ({error.strerror})", where=where, next_step="see the docs on servos"
        ) from None
    except (UnicodeDecodeError, tomllib.TOMLDecodeError, RecursionError) as error:
        raise LagnetError(f"cannot be read ({error})", where=where, next_step="see the docs on servos") from None
    for name in tables:
        if name != EVERY and name not in joints:
            near = closest(name, joints)
            hint = f"did you mean {near}?" if near else None
            raise LagnetError(
                f"has a table for the unknown joint {name!r}", where=where, choices=joints, next_step=hint
            )
    given = {joint: _values(tables, joint, where) for joint in joints}
    return servo_of_values(given, joints, armature, "file")


def _values(tables: Mapping[str, Any], joint: str, where: str) -> dict[str, float]:
    merged: dict[str, Any] = {}
    for name in (EVERY, joint):
        table = tables.get(name, {})
        if not isinstance(table, dict):
            raise LagnetError(f"{name} is no table of parameters", where=where, next_step=f"write [{name}]")
        merged |= table
    out = {}
    for name, value in merged.items():
        ours = ALIASES.get(name, name)
        if ours not in INDEX:
            raise LagnetError(f"{joint} has the unknown parameter {name!r}", where=where, choices=NAMES)
        law = LAW[INDEX[ours]]
        is_number = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
        if not is_number or not law.lower <= value <= law.upper:
            limits = f"a number from {law.lower:g} to {law.upper:g} {law.unit}".rstrip()
            raise LagnetError(f"{joint}.{name} is {value!r}", where=where, next_step=f"give {limits}")
        out[ours] = float(value)
    return out


def servo_of_values(
    given: Mapping[str, Mapping[str, float]],
    joints: Sequence[str],
    armature: np.ndarray,
    source: str,
    warnings: Sequence[str] = (),
) -> NominalServo:
    """Servos from numbers by joint and law parameter; a joint without `kp` is one whose servo is not known."""
    laws = np.tile(NEUTRAL, (len(joints), 1))
    laws[:, INDEX["rotor"]] = armature
    for row, joint in zip(laws, joints, strict=True):
        for name, value in given.get(joint, {}).items():
            row[INDEX[name]] = value
    known = tuple("kp" in given.get(joint, {}) for joint in joints)
    return NominalServo(laws, known, source if any(known) else "estimated", tuple(warnings))
