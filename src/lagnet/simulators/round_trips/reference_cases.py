"""Effects of a size that matters on a small arm: the cases on which every claim of an exporter is measured."""

from __future__ import annotations

from collections.abc import Mapping

CASES: Mapping[str, Mapping[str, float]] = {
    "viscous_friction": {"Fv": 0.8},
    "coulomb_friction": {"Fc": 0.6},
    "asymmetric_friction": {"Fc_plus": 0.8, "Fc_minus": 0.4},
    "stribeck_friction": {"Fc": 0.4, "Fs": 0.4, "vs": 0.15},
    "quadratic_drag": {"Fd": 0.8},
    "rotor_inertia": {"Ia": 0.15},
    "payload": {
        "m": 0.8,
        "cx": 0.02,
        "cy": -0.01,
        "cz": 0.06,
        "Ixx": 2e-3,
        "Ixy": 0.0,
        "Iyy": 2e-3,
        "Ixz": 0.0,
        "Iyz": 0.0,
        "Izz": 1e-3,
    },
    "link_inertia": {
        "dm": 1.0,
        "dmcx": 0.06,
        "dmcy": 0.01,
        "dmcz": -0.05,
        "dIxx": 9e-3,
        "dIxy": 0.0,
        "dIyy": 1e-2,
        "dIxz": 0.0,
        "dIyz": 0.0,
        "dIzz": 1e-2,
    },
    "gravity_tilt": {"theta_1": 0.06, "theta_2": -0.04},
    "joint_spring": {"k": 3.0, "q0": 0.3},
    "torque_gain": {"g": 1.15},
    "torque_offset": {"b": 0.5},
    "time_delay": {"T": -0.018},
    "load_dependent_friction": {"K": 0.2},
    "torque_ripple": {"N": 12.0, "amplitude": 0.5, "phase": 0.4},
    "encoder_offset": {"delta": 0.12},
    "joint_elasticity": {"K": 60.0, "D": 0.3},
    "backlash": {"h": 0.01},
    "presliding_hysteresis": {"sigma0": 25.0, "Fc": 0.6},
    "saturation": {"tau_max": 2.0},
    "coupled_transmission": {"Fv": 0.4, "Fc": 0.3, "Ia": 0.05, "ratio": 1.0},
}


def case_values(name: str) -> dict[str, float]:
    """Parameters of the case of an effect."""
    return dict(CASES[name])


COMPANIONS: Mapping[str, Mapping[str, Mapping[str, float]]] = {
    "joint_elasticity": {"rotor_inertia": {"Ia": 0.15}},
    "backlash": {"rotor_inertia": {"Ia": 0.15}},
}
"""What stands beside an effect in its case, and on both sides of the comparison: a motor that yields has a rotor."""
