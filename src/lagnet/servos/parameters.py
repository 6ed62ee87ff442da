"""The parameters of one servo-driven joint, in the order in which compiled laws take them.

e   = dead_band(u(t − T) − q − δ; b)                     command error behind delay, bias and dead band
x   = clip(r (kp e + ki ∫e dt − kd v), ±r kp E)           controller; r = voltage over nominal voltage, 1 if unknown
τ_m = clip(x / (1 + σ |x|), ±r τ_max) − kb v               motor
(M_ii + Ia) a = τ_m + τ_0 − gain · load(q) − k (q − q0) − friction     joint; load holds gravity and the other joints
friction = [Fc + Fs g + (K_± |load| + K_m |τ_m| + K₂ load²)(1 + s g)] sign(v) + Fv v + Fd v |v|, g = exp(−(v/v_s)²);
at rest the bracket bounds it
Where motor and link part (stiffness or gap not 0), P passes between a motor at θ and a link at q:
Ia θ'' = τ_m + τ_0 − friction − P,  M_ii a = P − gain · load − k (q − q0),
P = K dz(θ − q; gap) + D (θ' − v) beyond the gap, of hard stops for K = 0. The drive measures θ or q, see encoder_side.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class LawParameter:
    """One number of a servo-driven joint: name, unit of a revolute joint, meaning, neutral value and bounds."""

    name: str
    unit: str
    meaning: str
    neutral: float
    lower: float
    upper: float


NO_LIMIT = 1e9

LAW = (
    LawParameter("kp", "N m/rad", "proportional gain", 10.0, 1e-6, 1e6),
    LawParameter("kd", "N m s/rad", "gain on measured speed, within the torque limit", 0.0, 0.0, 1e5),
    LawParameter("ki", "N m/(rad s)", "integral gain", 0.0, 0.0, 1e5),
    LawParameter("bias", "rad", "position at which the drive sees itself, beyond the recorded one", 0.0, -1.0, 1.0),
    LawParameter("delay", "s", "time from the recorded command to torque", 0.0, 0.0, 0.5),
    LawParameter("dead_band", "rad", "half-width of the command error that gives no torque", 0.0, 0.0, 0.5),
    LawParameter(
        "torque_limit", "N m", "greatest torque of the controller at nominal voltage", NO_LIMIT, 1e-6, NO_LIMIT
    ),
    LawParameter("voltage_share", "", "1: torque in proportion to voltage; 0: voltage regulated away", 0.0, 0.0, 1.0),
    LawParameter("rotor", "kg m²", "inertia of rotor and gears felt at the joint", 0.0, 0.0, 1e3),
    LawParameter("viscous", "N m s/rad", "viscous friction and back-EMF", 0.0, 0.0, 1e5),
    LawParameter("quadratic", "N m s²/rad²", "drag with the square of speed", 0.0, 0.0, 1e5),
    LawParameter("coulomb", "N m", "dry friction", 0.0, 0.0, 1e5),
    LawParameter("static", "N m", "dry friction at rest beyond that of motion", 0.0, 0.0, 1e5),
    LawParameter("stribeck_speed", "rad/s", "speed over which static friction fades; 0: at once", 0.0, 0.0, 1e2),
    LawParameter("load_driving", "", "friction per load while the motor moves it", 0.0, 0.0, 10.0),
    LawParameter("load_driven", "", "friction per load while the load drives the motor", 0.0, 0.0, 10.0),
    LawParameter("load_squared", "1/(N m)", "friction per square of the load", 0.0, 0.0, 1e3),
    LawParameter("offset", "N m", "constant torque", 0.0, -1e4, 1e4),
    LawParameter("load_gain", "", "load over the nominal model's load", 1.0, 0.0, 1e3),
    LawParameter("stiffness", "N m/rad", "stiffness between motor and link; 0: rigid", 0.0, 0.0, 1e6),
    LawParameter("back_emf", "N m s/rad", "damping by the motor's own voltage while enabled", 0.0, 0.0, 1e5),
    LawParameter("gap", "rad", "half-width of the play between motor and link", 0.0, 0.0, 0.5),
    LawParameter("load_motor", "", "friction per torque of the motor", 0.0, 0.0, 0.9),
    LawParameter("spring", "N m/rad", "stiffness of a spring between link and base of the joint", 0.0, 0.0, 1e6),
    LawParameter("spring_rest", "rad", "position at which that spring is relaxed", 0.0, -10.0, 10.0),
    LawParameter("full_error", "rad", "command error of full duty at the law's gain", NO_LIMIT, 1e-6, NO_LIMIT),
    LawParameter("saturation", "1/(N m)", "share of the motor's torque that is lost, per torque", 0.0, 0.0, 1e3),
    LawParameter("load_stribeck", "", "further share of load-dependent friction near rest", 0.0, 0.0, 10.0),
    LawParameter("twist_damping", "N m s/rad", "damping between motor and link", 0.0, 0.0, 1e5),
    LawParameter("encoder_side", "", "where the drive measures: 0 on the motor, 1 on the link", 0.0, 0.0, 1.0),
)
NAMES = tuple(p.name for p in LAW)
INDEX = {name: i for i, name in enumerate(NAMES)}
NEUTRAL = np.array([p.neutral for p in LAW])
(KP, KD, KI, BIAS, DELAY, DEAD_BAND, LIMIT, VOLTAGE_SHARE, ROTOR, VISCOUS, QUADRATIC) = range(11)
(
    COULOMB,
    STATIC,
    STRIBECK_SPEED,
    DRIVING,
    DRIVEN,
    LOAD_SQUARED,
    OFFSET,
    LOAD_GAIN,
    STIFFNESS,
    BACK_EMF,
    GAP,
    LOAD_MOTOR,
    SPRING,
    SPRING_REST,
    FULL_ERROR,
    SATURATION,
    LOAD_STRIBECK,
    TWIST_DAMPING,
    ENCODER_SIDE,
) = range(11, 30)


def law_vector(**values: float) -> np.ndarray:
    """Parameters by name, the others neutral, shape (len(LAW),).

    Raises:
        KeyError: no such parameter.
    """
    vector = NEUTRAL.copy()
    for name, value in values.items():
        vector[INDEX[name]] = value
    return vector
