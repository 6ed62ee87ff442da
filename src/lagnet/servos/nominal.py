"""The servos that a simulation assumes: one law a joint, and where it came from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.servos.parameters import INDEX, NEUTRAL


@dataclass(frozen=True, eq=False)
class NominalServo:
    """Laws of the nominal servos.

    Args:
        laws: shape (dof, len(LAW)).
        known: for each joint whether a gain was given; where not, a diagnosis estimates it.
        source: 'mjcf', 'file' or 'estimated'.
        warnings: what was given and is left out.
    """

    laws: np.ndarray
    known: tuple[bool, ...]
    source: str
    warnings: tuple[str, ...] = ()


def unknown_servo(armature: np.ndarray) -> NominalServo:
    """No servo is known; rotors of the robot's description, shape (dof,), are kept."""
    laws = np.tile(NEUTRAL, (len(armature), 1))
    laws[:, INDEX["rotor"]] = armature
    return NominalServo(laws, (False,) * len(armature), "estimated")
