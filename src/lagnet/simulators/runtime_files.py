"""What runs beside an exported model without lagnet: its numbers as JSON, and the modules of `runtime/` as they are."""

from __future__ import annotations

import json
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from lagnet.rigid_body.descriptions.writing import write_text
from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics
from lagnet.simulators.corrected_arm.forward_motion import motor_inertia
from lagnet.simulators.urdf_text import BODY_SHARE

SETTINGS = "settings.json"
NOTHING: Mapping[str, Any] = MappingProxyType({})


def settings_of(arm: ArmPhysics) -> dict[str, Any]:
    """Everything but the bodies, as plain data; infinite numbers are null."""
    vectors = {
        "shift": arm.shift,
        "rotor": motor_inertia(arm),
        "motor_body": np.where(arm.compliant, BODY_SHARE * motor_inertia(arm), 0.0),
        "viscous": arm.viscous,
        "quadratic": arm.quadratic,
        "friction": arm.mean_friction,
        "friction_bias": arm.friction_bias,
        "load_friction": arm.load_friction,
        "load_friction_by_power": arm.load_friction_by_power,
        "stiffness": arm.stiffness,
        "spring_rest": arm.spring_rest,
        "elasticity": arm.elasticity,
        "twist_damping": arm.twist_damping,
        "half_gap": arm.half_gap,
        "gravity": arm.robot.gravity,
    }
    return {
        "joints": list(arm.robot.joints),
        **{key: [_finite(x) for x in value] for key, value in vectors.items()},
        "stribeck": [[t.joint, t.extra, t.speed] for t in arm.stribeck],
        "ripples": [[t.joint, t.order, t.amplitude, t.phase] for t in arm.ripples],
        "couplings": [[t.joint, t.viscous, t.dry, t.rotor, t.ratio] for t in arm.couplings],
        "bristles": [[t.joint, t.stiffness, t.friction] for t in arm.bristles],
        "drives": [
            {
                "gain": d.gain,
                "offset": d.offset,
                "lower": _finite(d.lower),
                "upper": _finite(d.upper),
                "hold": d.hold,
                "late": d.late,
            }
            for d in arm.drives
        ],
    }


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def write_runtime(arm: ArmPhysics, folder: Path, *modules: str, more: Mapping[str, Any] = NOTHING) -> tuple[Path, ...]:
    """Writes the settings, with `more` beside them, and copies of modules of `runtime/` beside a model."""
    settings = folder / SETTINGS
    write_text(settings, json.dumps(settings_of(arm) | dict(more), indent=1, allow_nan=False) + "\n")
    out = [settings]
    for name in modules:
        path = folder / name
        write_text(path, files("lagnet.simulators.runtime").joinpath(name).read_text(encoding="utf-8"))
        out.append(path)
    return tuple(out)
