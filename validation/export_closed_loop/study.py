"""A concealed MuJoCo arm: its logs diagnosed, the verdict exported, the user's MJCF before and after against the arm.

python -m validation.export_closed_loop.study [--quick]
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np

from lagnet.diagnosis.diagnose import diagnose
from lagnet.models.corrected.folder import save_corrected
from lagnet.models.files.loading import load_any
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import Robot, load_description
from lagnet.simulators.export import export_model
from lagnet.simulators.exported import write_export_json
from lagnet.simulators.registry import exporter_named
from lagnet.simulators.replay import ReplaySettings, Servo, replay

HERE = Path(__file__).resolve().parent
SEEDS, LINE = (0, 1, 2), 0.05
STEP, PERIOD = 2.5e-4, 1e-3  # [s] of the concealed arm, and of its servo and log
OMEGA = 25.0  # [rad/s], bandwidth of the servo


@dataclass(frozen=True)
class Hidden:
    """What the concealed arm has and the user's MJCF lacks."""

    viscous: tuple[int, float]
    dry: tuple[int, float]
    rotor: tuple[int, float]
    spring: tuple[int, float, float]
    load: float


def draw(robot: Robot, seed: int) -> Hidden:
    """Sizes of a few tenths of the torque that gravity puts on a joint."""
    rng = np.random.default_rng([seed, 77])
    joints = rng.permutation(4)
    level = np.array([20.0, 40.0, 20.0, 6.0])
    v, d, r, s = (int(j) for j in joints)
    return Hidden(
        (v, float(rng.uniform(0.2, 0.4) * level[v])),
        (d, float(rng.uniform(0.15, 0.3) * level[d])),
        (r, float(rng.uniform(0.05, 0.1) * level[r])),
        (s, float(rng.uniform(0.2, 0.4) * level[s]), float(rng.uniform(-0.4, 0.4))),
        float(rng.uniform(0.8, 2.0)),
    )


def conceal(mjcf: Path, robot: Robot, hidden: Hidden) -> mujoco.MjModel:
    """The real arm, changed in MuJoCo's own terms."""
    spec = mujoco.MjSpec.from_file(str(mjcf))
    names = robot.joints
    spec.joint(names[hidden.viscous[0]]).damping[0] = hidden.viscous[1]
    dry = spec.joint(names[hidden.dry[0]])
    dry.frictionloss = hidden.dry[1]
    dry.solref_friction, dry.solimp_friction = [5e-4, 1.0], [0.9999, 0.9999, 1e-3, 0.5, 2.0]
    spec.joint(names[hidden.rotor[0]]).armature = hidden.rotor[1]
    spring = spec.joint(names[hidden.spring[0]])
    spring.stiffness[0], spring.springref = hidden.spring[1], hidden.spring[2]
    tool = spec.body(robot.links[-1]).add_body(name="tool", pos=[0.0, 0.06, 0.03])
    tool.explicitinertial, tool.mass, tool.inertia = True, hidden.load, np.full(3, 4e-4 * hidden.load)
    for name in names:
        spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
    spec.option.timestep, spec.option.integrator = STEP, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    return spec.compile()


def gains(robot: Robot) -> Servo:
    """The servo of the arm, known to its user."""
    inertia = np.diagonal(robot.mass_matrix(np.zeros((1, robot.n_dof)))[0]) + 0.05
    return Servo(tuple(OMEGA**2 * inertia), tuple(1.6 * OMEGA * inertia))


def commands(seed: int, seconds: float) -> np.ndarray:
    """Sums of sines that set in smoothly, shape (n, 6) [rad]."""
    rng = np.random.default_rng(seed)
    time = np.arange(round(seconds / PERIOD)) * PERIOD
    omega, phase = 2 * np.pi * rng.uniform(0.05, 0.45, (4, 6)), rng.uniform(0.0, 2 * np.pi, (4, 6))
    size = rng.uniform(0.08, 0.28, (4, 6)) * np.array([1.0, 0.7, 1.0, 1.2, 1.2, 1.2])
    wave = (size * np.sin(omega * time[:, None, None] + phase)).sum(axis=1)
    on = np.clip(time / 1.5, 0.0, 1.0)[:, None]
    return np.array([0.0, -1.2, 1.0, -0.6, 0.5, 0.0]) + on**3 * (10 - 15 * on + 6 * on**2) * wave


def record(model: mujoco.MjModel, robot: Robot, servo: Servo, seed: int, seconds: float) -> Recording:
    """The arm under its servo, logged with noise."""
    wanted, data = commands(seed, seconds), mujoco.MjData(model)
    kp, kd = np.array(servo.kp), np.array(servo.kd)
    data.qpos[:] = wanted[0]
    mujoco.mj_forward(model, data)
    q, tau = np.empty_like(wanted), np.empty_like(wanted)
    for k, target in enumerate(wanted):
        data.ctrl[:] = kp * (target - data.qpos) - kd * data.qvel
        q[k], tau[k] = data.qpos, data.ctrl
        for _ in range(round(PERIOD / STEP)):
            mujoco.mj_step(model, data)
    rng = np.random.default_rng([seed, 5])
    noise = 0.005 * np.sqrt(np.mean(tau**2, axis=0))
    time = np.arange(len(wanted)) * PERIOD
    seen, felt = q + 1e-5 * rng.standard_normal(q.shape), tau + noise * rng.standard_normal(q.shape)
    return Recording(time, seen, felt, robot.joints, command=wanted)


def run(seed: int, seconds: float) -> dict:
    """One concealed arm from MJCF to replay."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        load_description("ur5").write_mjcf(folder / "user.xml")
        robot = load_description(folder / "user.xml")
        hidden, servo = draw(robot, seed), gains(robot)
        arm = conceal(folder / "user.xml", robot, hidden)
        *fitted, kept = (record(arm, robot, servo, 100 * seed + k, seconds) for k in range(4))
        verdict = diagnose(fitted, robot, seed=seed)
        corrected = load_any(save_corrected(verdict.corrected, folder / "corrected"))
        exported = export_model(corrected, exporter_named("mjcf"), folder / "export")
        write_export_json(exported, folder / "export")
        settings = ReplaySettings(servo=servo, longest=seconds)
        before, after = replay(robot, [kept], settings), replay(corrected, [kept], settings)
    errors = [float(np.sqrt(np.mean(r.rmse() ** 2))) for r in (before, after)]
    row = {
        "seed": seed,
        "hidden": vars(hidden),
        "joint_with_largest_error": int(np.argmax(after.rmse())),
        "named": [f"{e.effect}@{'arm' if e.joint is None else e.joint}" for e in corrected.effects],
        "error_original_rad": errors[0],
        "error_exported_rad": errors[1],
        "share": errors[1] / errors[0],
        "rmse_original": before.rmse().tolist(),
        "rmse_exported": after.rmse().tolist(),
    }
    print(
        f"seed {seed}: original {errors[0]:.4g} rad, exported {errors[1]:.4g} rad, {100 * row['share']:.2f} %",
        flush=True,
    )
    print(f"  hidden {hidden}\n  named {row['named']}", flush=True)
    for effect in corrected.effects:
        print(f"  {effect.effect} {effect.joint} " + ", ".join(f"{k} {v:.4g}" for k, v in effect.values.items()))
    return row


def main() -> int:
    """Run, judge, write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    rows = [run(seed, 8.0 if options.quick else 20.0) for seed in (SEEDS[:1] if options.quick else SEEDS)]
    worst = max(row["share"] for row in rows)
    print(f"worst {100 * worst:.2f} % (line {100 * LINE:g} %)")
    if not options.quick:
        result = {"line": LINE, "worst": worst, "passed": worst <= LINE, "rows": rows}
        (HERE / "result.json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    return 0 if worst <= LINE else 1


if __name__ == "__main__":
    sys.exit(main())
