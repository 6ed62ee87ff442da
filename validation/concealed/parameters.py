"""Errors of claimed parameters against hidden ones, and whether the 95 % intervals hold them."""

from __future__ import annotations

import numpy as np

from validation.concealed.fair_names import Claim
from validation.plants.spec import Hidden

VECTORS = (
    ("cx", "cy", "cz"),
    ("theta_1", "theta_2"),
    ("Fx", "Fy", "Fz"),
    ("px", "py", "pz"),
)  # a small component has no relative error of its own
ABSOLUTE = ("q0", "phase", "t0", "t1")  # their zero means nothing: errors in radians and seconds
NOT_THE_SAME = {"joint_elasticity": ("damping", "rotor"), "backlash": ("K", "damping", "rotor")}  # the plant's own


def errors_of(hidden: Hidden, claim: Claim) -> tuple[dict[str, float], dict[str, bool]]:
    """Relative errors and coverage of the parameters that both sides have, by "effect.parameter"."""
    errors: dict[str, float] = {}
    covered: dict[str, bool] = {}
    own = NOT_THE_SAME.get(hidden.effect, ())
    shared = {k: x for k, x in hidden.values.items() if k in claim.parameters and k not in own}
    for name, true in shared.items():
        given = claim.parameters[name]
        turn = 2 * np.pi * round((given["value"] - true) / (2 * np.pi)) if name == "phase" else 0.0
        low, high = (bound - turn for bound in given["ci95"])
        covered[f"{hidden.effect}.{name}"] = bool(low <= true <= high)
        if not any(name in group for group in VECTORS):
            scale = 1.0 if name in ABSOLUTE else max(abs(true), 1e-12)
            errors[f"{hidden.effect}.{name}"] = abs(given["value"] - turn - true) / scale
    for group in VECTORS:
        if all(name in shared for name in group):
            true = np.array([shared[name] for name in group])
            seen = np.array([claim.parameters[name]["value"] for name in group])
            errors[f"{hidden.effect}.{'+'.join(group)}"] = float(np.linalg.norm(seen - true) / np.linalg.norm(true))
    return errors, covered
