"""Every law again, written by hand from the catalogue of left-out physics, without the code under test."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from lagnet.effects.catalogue import CATALOGUE, effect_named
from lagnet.effects.gap import lag_in_gap

ORACLE = 1e-8  # relative: two algorithms in float64
SPLINE = 1e-4  # relative: a cubic spline between samples of smooth torque, four milliseconds apart
DIFFERENCES = 0.02  # relative: twice differentiated torque, by differences of samples against those of the exact motion
TINY = 1e-4  # [s] step of differences of the exact motion

few = settings(max_examples=6, deadline=None)
seeds = st.integers(0, 2**31)
Law = Callable[..., np.ndarray]


def body(values: dict) -> tuple[float, np.ndarray, np.ndarray]:
    xx, xy, yy, xz, yz, zz = (values[f"I{n}"] for n in ("xx", "xy", "yy", "xz", "yz", "zz"))
    centre = np.array([values["cx"], values["cy"], values["cz"]])
    return values["m"], centre, np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def with_robot(robot, sweep) -> np.ndarray:
    m = sweep.motion
    return robot.inverse_dynamics(m.q, m.v, m.a) - m.load


def payload(sweep, joint, values):
    return with_robot(sweep.motion.model.with_payload(*body(values)), sweep)


def link_inertia(sweep, joint, values):
    parameters = sweep.motion.model.inertial_parameters().copy()
    parameters[joint] += np.array(list(values.values()))
    return with_robot(sweep.motion.model.with_inertial_parameters(parameters), sweep)


def gravity_tilt(sweep, joint, values):
    turn = Rotation.from_rotvec([values["theta_1"], values["theta_2"], 0.0])  # x and y of a base that stood level
    return with_robot(sweep.motion.model.with_gravity(turn.inv().apply([0.0, 0.0, -9.81])), sweep)


def dry(sweep, joint):
    m = sweep.motion
    return np.tanh(m.v[:, joint] / m.slow[joint])


def asymmetric(sweep, joint, values):
    forward = sweep.motion.v[:, joint] > 0
    return np.where(forward, values["Fc_plus"], values["Fc_minus"]) * dry(sweep, joint)


def drag(sweep, joint, values):
    v = sweep.motion.v[:, joint]
    return values["Fd"] * np.sign(v) * v**2


def stribeck(sweep, joint, values):
    near = np.exp(-((sweep.motion.v[:, joint] / values["vs"]) ** 2))
    return (values["Fc"] + values["Fs"] * near) * dry(sweep, joint)


def delay(sweep, joint, values):
    time = sweep.motion.time
    earlier = np.maximum(time - values["T"], time[0])
    return sweep.load_at(earlier)[:, joint] - sweep.motion.load[:, joint]


def encoder(sweep, joint, values):
    m = sweep.motion
    q = m.q.copy()
    q[:, joint] += values["delta"]
    return m.model.inverse_dynamics(q, m.v, m.a) - m.load


def elasticity(sweep, joint, values):
    m = sweep.motion
    before, here, after = (sweep.load_at(m.time + dt)[:, joint] / values["K"] for dt in (-TINY, 0.0, TINY))
    q, v, a = m.q.copy(), m.v.copy(), m.a.copy()
    q[:, joint] -= here
    v[:, joint] -= (after - before) / (2.0 * TINY)
    a[:, joint] -= (after - 2.0 * here + before) / TINY**2
    return m.model.inverse_dynamics(q, v, a) - m.load


def coupled(sweep, joint, values):
    m, before = sweep.motion, joint - 1
    c = values["ratio"]
    speed, rate = m.v[:, joint] + c * m.v[:, before], m.a[:, joint] + c * m.a[:, before]
    blur = np.sqrt(m.slow[joint] ** 2 + (c * m.slow[before]) ** 2)
    drag_ = values["Fv"] * speed + values["Fc"] * np.tanh(speed / blur) + values["Ia"] * rate
    out = np.zeros_like(m.q)
    out[:, joint], out[:, before] = drag_, c * drag_  # the power of the drag is drag · (v_j + c v_(j−1))
    return out


def dahl(sweep, joint, values):
    time = sweep.motion.time

    def rate(t, z):
        v = sweep.at(np.array([t]))[1][0, joint]
        return v - abs(v) * values["sigma0"] * z / values["Fc"]

    path = solve_ivp(rate, (time[0], time[-1]), [0.0], t_eval=time, max_step=0.005, rtol=1e-8, atol=1e-10)
    return values["sigma0"] * path.y[0]


# name: (example parameters, law(sweep, joint, values), relative tolerance)
LAWS: dict[str, tuple[dict[str, float], Law, float]] = {
    "viscous_friction": ({"Fv": 3.0}, lambda s, j, p: p["Fv"] * s.motion.v[:, j], ORACLE),
    "coulomb_friction": ({"Fc": 2.0}, lambda s, j, p: p["Fc"] * dry(s, j), ORACLE),
    "asymmetric_friction": ({"Fc_plus": 2.0, "Fc_minus": 0.7}, asymmetric, ORACLE),
    "stribeck_friction": ({"Fc": 2.0, "Fs": 1.1, "vs": 0.3}, stribeck, ORACLE),
    "load_dependent_friction": (
        {"K": 0.1},
        lambda s, j, p: p["K"] * np.abs(s.motion.load[:, j]) * dry(s, j),
        ORACLE,
    ),
    "quadratic_drag": (
        {"Fd": 0.6},
        lambda s, j, p: p["Fd"] * np.sign(s.motion.v[:, j]) * s.motion.v[:, j] ** 2,
        ORACLE,
    ),
    "rotor_inertia": ({"Ia": 0.8}, lambda s, j, p: p["Ia"] * s.motion.a[:, j], ORACLE),
    "payload": (
        {"m": 2.0, "cx": 0.03, "cy": -0.02, "cz": 0.1}
        | {"Ixx": 0.02, "Ixy": 0.001, "Iyy": 0.03, "Ixz": -0.002, "Iyz": 0.0005, "Izz": 0.015},
        payload,
        ORACLE,
    ),
    "link_inertia": (
        {"dm": 0.4, "dmcx": 0.02, "dmcy": -0.03, "dmcz": 0.05}
        | {"dIxx": 0.01, "dIxy": 0.002, "dIyy": 0.02, "dIxz": -0.003, "dIyz": 0.001, "dIzz": 0.03},
        link_inertia,
        ORACLE,
    ),
    "gravity_tilt": ({"theta_1": 0.2, "theta_2": -0.13}, gravity_tilt, ORACLE),
    "joint_spring": ({"k": 7.0, "q0": 0.4}, lambda s, j, p: p["k"] * (s.motion.q[:, j] - p["q0"]), ORACLE),
    "torque_ripple": (
        {"N": 25.0, "amplitude": 0.7, "phase": 1.1},
        lambda s, j, p: p["amplitude"] * np.sin(p["N"] * s.motion.q[:, j] + p["phase"]),
        ORACLE,
    ),
    "torque_gain": ({"g": 0.83}, lambda s, j, p: 0.83 * s.motion.load[:, j] - s.motion.load[:, j], ORACLE),
    "torque_offset": ({"b": -1.7}, lambda s, j, p: np.full(s.motion.time.size, -1.7), ORACLE),
    "encoder_offset": ({"delta": 0.07}, encoder, ORACLE),
    "time_delay": ({"T": 0.013}, delay, SPLINE),
    "joint_elasticity": ({"K": 4000.0, "D": 0.0}, elasticity, DIFFERENCES),
    "coupled_transmission": ({"Fv": 1.0, "Fc": 2.0, "Ia": 0.3, "ratio": -1.7}, coupled, ORACLE),
    "presliding_hysteresis": ({"sigma0": 60.0, "Fc": 2.0}, dahl, DIFFERENCES),
    "saturation": (
        {"tau_max": 3.0},
        lambda s, j, p: np.minimum(np.maximum(s.motion.load[:, j], -3.0), 3.0) - s.motion.load[:, j],
        ORACLE,
    ),
}


@pytest.mark.parametrize("name", LAWS)
@given(seed=seeds)
@few
def test_torque_is_the_law_of_the_catalogue(name: str, ur5, sweep, seed: int) -> None:
    values, law, tolerance = LAWS[name]
    effect, drawn = CATALOGUE[name], sweep(ur5, seed)
    joint = None if effect.whole_arm else seed % (5 if name == "link_inertia" else 6)
    if name == "coupled_transmission":
        joint = 1 + seed % 5
    # a transmission bends under the torque that passes through it, which is recorded
    motion = replace(drawn.motion, recorded=drawn.motion.load) if name == "joint_elasticity" else drawn.motion
    torque = effect.torque(motion, joint, values)
    expected = law(drawn, joint, values)
    inside = slice(None) if tolerance == ORACLE else slice(8, -8)
    scale = max(np.abs(expected).max(), 1e-9 * np.abs(drawn.motion.load).max())
    if name == "time_delay":  # what a spline misses is a part of the torque, not of its change
        scale = np.abs(drawn.motion.load).max()
    np.testing.assert_allclose(torque[inside], expected[inside], rtol=0, atol=tolerance * scale)


@given(seed=seeds)
@few
def test_backlash_shifts_the_link_to_the_flank_that_carries(ur5, sweep, seed: int) -> None:
    drawn, joint, half_gap = sweep(ur5, seed), 1 + seed % 5, 2e-4
    m = drawn.motion
    torque = CATALOGUE["backlash"].torque(m, joint, {"h": half_gap})
    load = m.load[:, joint]
    inertia = m.model.mass_matrix(m.q)[:, joint, joint]
    changes = np.flatnonzero(np.diff(np.sign(load)))
    firm = np.zeros(load.size, dtype=bool)
    for begun, ended in zip([-1, *changes], [*changes, load.size - 1], strict=True):  # one flank all along
        push = np.abs(load / inertia)[begun + 1 : ended + 1]
        flown = np.cumsum(np.cumsum(push)) * np.median(np.diff(m.time)) ** 2
        firm[begun + 1 : ended + 1] = (flown > 8.0 * half_gap) if begun >= 0 else True
    firm &= np.roll(firm, 2) & np.roll(firm, -2) & np.roll(firm, 1) & np.roll(firm, -1)
    firm[:3] = firm[-3:] = False
    q = m.q.copy()
    q[:, joint] -= half_gap * np.sign(load)
    expected = m.model.inverse_dynamics(q, m.v, m.a) - m.load
    np.testing.assert_allclose(torque[firm], expected[firm], rtol=0, atol=1e-4 * np.abs(m.load).max())
    assert firm.any()


@given(seed=seeds)
@few
def test_backlash_lets_the_link_fall_free_between_the_flanks(ur5, sweep, seed: int) -> None:
    """In flight the transmission carries nothing: the nominal torque and what the law adds cancel at the joint."""
    drawn, joint, half_gap = sweep(ur5, seed), 1 + seed % 5, 0.1
    m = drawn.motion
    inertia = m.model.mass_matrix(m.q)[:, joint, joint]
    lag = lag_in_gap(m.time, m.load[:, joint] / inertia, half_gap)
    free = np.abs(lag) < 0.99 * half_gap
    free &= np.roll(free, 2) & np.roll(free, -2) & np.roll(free, 1) & np.roll(free, -1)
    free[:3] = free[-3:] = False
    q, v, a = m.q.copy(), m.v.copy(), m.a.copy()
    q[:, joint] -= lag
    v[:, joint] -= np.gradient(lag, m.time)
    a[:, joint] -= m.load[:, joint] / inertia
    expected = m.model.inverse_dynamics(q, v, a) - m.load
    torque = CATALOGUE["backlash"].torque(m, joint, {"h": half_gap})
    scale = np.abs(m.load).max()
    np.testing.assert_allclose(torque[free], expected[free], rtol=0, atol=DIFFERENCES * scale)


@given(seed=seeds, constant=st.floats(1e-3, 0.2))
@few
def test_a_damped_transmission_winds_until_spring_and_damper_hold_its_load(
    ur5, sweep, seed: int, constant: float
) -> None:
    m = sweep(ur5, seed).motion
    motion, joint, stiffness = replace(m, recorded=m.load), seed % 6, 4000.0
    lag, speed, _ = CATALOGUE["joint_elasticity"].shift(motion, joint, {"K": stiffness, "D": constant * stiffness})
    held, load = -stiffness * (lag + constant * speed), m.load[:, joint]
    np.testing.assert_allclose(held[1:-1], load[1:-1], rtol=0, atol=0.02 * np.abs(load).max())


def test_one_of_many_intervals_leaves_out_its_absence_by_chance() -> None:
    law = effect_named("link_inertia")
    open_ = {name: (-1.0, 1.0) for name, _ in law.absence}
    first = law.absence[0][0]
    assert not law.is_determined(open_)
    assert not law.is_determined({**open_, first: (0.01, 2.0)})  # 2 standard deviations of one out of ten
    assert law.is_determined({**open_, first: (0.7, 2.7)})  # 3.3
    assert effect_named("viscous_friction").is_determined({"Fv": (0.01, 2.0)})  # alone


def test_every_effect_has_a_law_written_by_hand() -> None:
    elsewhere = {"backlash", "contact_force"}  # above; and an external wrench, which has a test of its own
    assert set(CATALOGUE) <= set(LAWS) | elsewhere


def test_a_lag_within_the_clock_is_no_delay() -> None:
    law = effect_named("time_delay")
    assert not law.is_determined({"T": (-0.0006, -0.0004)})
    assert not law.is_determined({"T": (-0.004, 0.006)})
    assert law.is_determined({"T": (0.0008, 0.0014)})
    assert law.is_determined({"T": (-0.009, -0.004)})
