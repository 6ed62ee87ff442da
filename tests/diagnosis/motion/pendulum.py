"""One servo with a pendulum in MuJoCo: a plant for tests, written apart from the rollouts that are tested."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np

from lagnet.recordings.recording import Recording

ENCODER = 2.0 * np.pi / 4096.0
STILL = 2e-3  # [rad/s] below which a joint has to break away
FINER = 4  # steps of the engine in a millisecond, by which dry friction stops in time
MJCF = """<mujoco model="pendulum"><compiler angle="radian"/><worldbody><body name="arm">
<joint name="servo" type="hinge" axis="0 1 0" range="-3 3" damping="{damping}" frictionloss="{friction}"
armature="{rotor}"/>
<inertial pos="0 0 -0.1" mass="{mass}" diaginertia="1e-4 1e-4 1e-4"/></body></worldbody>
<actuator><position joint="servo" kp="{kp}" kv="{kv}" forcerange="-6 6"/></actuator></mujoco>"""
NOMINAL = {"damping": 0.2, "friction": 0.02, "rotor": 0.01, "mass": 0.5, "kp": 8.0, "kv": 0.4}


def write_model(path: Path, **changed: float) -> Path:
    """The pendulum's MJCF with some values changed."""
    path.write_text(MJCF.format(**(NOMINAL | changed)), encoding="utf-8")
    return path


def commands(seconds: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Steps and sines of several speeds at 50 Hz: time (n,), command (n, 1)."""
    rng, time = np.random.default_rng(seed), np.arange(0.0, seconds, 0.02)
    steps = rng.uniform(-1.2, 1.2, size=int(seconds / 2.0) + 1)[(time / 2.0).astype(int)]
    chirp = 0.5 * np.sin(2.0 * np.pi * (0.1 + 0.05 * time) * time)
    return time, np.where((time % 20.0 < 10.0), steps, chirp)[:, None]


def rests(data: mujoco.MjData) -> bool:
    """Whether the joint rests, or comes to rest within the next step of the engine: where it turns, too."""
    coming = -data.qvel[0] * data.qacc[0] * 0.001 / FINER
    return abs(data.qvel[0]) < STILL or coming > data.qvel[0] ** 2


def record(
    path: Path, seconds: float, seed: int, delay: int = 0, dead_band: float = 0.0, break_away: float = 0.0
) -> Recording:
    """A recording of the plant in a file; delay in steps of 1 ms; dry friction almost rigid, not viscous near rest."""
    model = mujoco.MjModel.from_xml_path(str(path))
    model.opt.timestep, model.opt.integrator = 0.001 / FINER, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    model.dof_solimp[:], model.dof_solref[:] = [0.9999, 0.9999, 0.001, 0.5, 2.0], [0.002 / FINER, 1.0]
    data = mujoco.MjData(model)
    time, command = commands(seconds, seed)
    sliding = float(model.dof_frictionloss[0])
    held, q = np.repeat(command[:, 0], 20), np.empty((time.size, 1))
    for k in range(time.size):
        q[k] = data.qpos
        for i in range(20):
            u = held[max(0, 20 * k + i - delay)]
            error = u - data.qpos[0]
            beyond = np.sign(error) * max(abs(error) - dead_band, 0.0)
            data.ctrl[0] = data.qpos[0] + beyond
            for _ in range(FINER):
                model.dof_frictionloss[0] = sliding + (break_away if rests(data) else 0.0)
                mujoco.mj_step(model, data)
    return Recording(time, ENCODER * np.round(q / ENCODER), None, ("servo",), command=command, path=f"run_{seed}")
