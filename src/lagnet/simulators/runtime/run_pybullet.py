"""Run an exported model in PyBullet: what a URDF has no place for acts as motors without a target and as torques.

Needs NumPy and PyBullet alone: `python run_pybullet.py` lets the arm fall for a second; import `CorrectedArm` to
command it. friction_impulse.py lies beside it.
"""

import json
import sys
from collections import deque
from pathlib import Path

import numpy as np
import pybullet

try:
    from friction_impulse import friction_impulses
except ImportError:
    from lagnet.simulators.runtime.friction_impulse import friction_impulses

MOTOR_LINK = "_link"
FAST = 1e3  # [rad/s], above what PyBullet would cut speeds to


class CorrectedArm:
    """The arm of model.urdf and settings.json in a PyBullet world.

    Args:
        folder: where they lie.
        step: [s].
        world: a connected client; None: a new one without a window.
    """

    def __init__(self, folder, step=0.001, world=None):
        folder = Path(folder)
        self.settings = json.loads((folder / "settings.json").read_text(encoding="utf-8"))
        self.dt, self.world = step, pybullet.connect(pybullet.DIRECT) if world is None else world
        flags = pybullet.URDF_USE_INERTIA_FROM_FILE
        model = str(folder / "model.urdf")
        self.body = pybullet.loadURDF(model, useFixedBase=True, flags=flags, physicsClientId=self.world)
        self._find_joints()
        self._numbers()
        self._set_up()

    def close(self):
        """Give the world back."""
        if self.world >= 0:
            pybullet.disconnect(self.world)
            self.world = -1

    def _find_joints(self):
        count = pybullet.getNumJoints(self.body, self.world)
        info = [pybullet.getJointInfo(self.body, i, self.world) for i in range(count)]
        moving = [i for i in info if i[2] != pybullet.JOINT_FIXED]
        names = [i[1].decode() for i in moving]
        self.links, self.ids = count, [i[0] for i in moving]
        self.motors = np.array([names.index(n) for n in self.settings["joints"]])
        self.yielding = [
            (j, names.index(n + MOTOR_LINK)) for j, n in enumerate(self.settings["joints"]) if n + MOTOR_LINK in names
        ]

    def _numbers(self):
        s, n = self.settings, len(self.motors)
        self.rotors = np.zeros((len(self.ids), len(self.ids)))
        self.rotors[self.motors, self.motors] = np.array(s["rotor"]) - np.array(s["motor_body"])
        self.rows = []
        for joint, _viscous, dry, rotor, ratio in s["couplings"]:
            row = np.zeros(len(self.ids))
            row[self.motors[joint]], row[self.motors[joint - 1]] = 1.0, ratio
            self.rotors += rotor * np.outer(row, row)
            self.rows.append((row, dry))
        self.gaps = [(link, s["half_gap"][j]) for j, link in self.yielding if s["half_gap"][j]]
        self.solves = bool(self.rotors.any() or self.rows)
        self.bend, self.impulse = np.zeros(len(s["bristles"])), np.zeros(n + len(self.rows) + 2 * len(self.gaps))
        longest = max(round(d["hold"] / self.dt) for d in s["drives"])
        self.past, self.before = deque(maxlen=longest + 1), None

    def _set_up(self):
        s = self.settings
        free = {"linearDamping": 0.0, "angularDamping": 0.0, "jointDamping": 0.0, "maxJointVelocity": FAST}
        for link in range(-1, self.links):
            pybullet.changeDynamics(self.body, link, physicsClientId=self.world, **free)
        if not self.solves:
            for joint, damping in zip(self.motors, s["viscous"], strict=True):
                pybullet.changeDynamics(self.body, self.ids[joint], jointDamping=damping, physicsClientId=self.world)
        self._motors(np.zeros(len(self.ids)))
        pybullet.setGravity(*s["gravity"], physicsClientId=self.world)
        pybullet.setPhysicsEngineParameter(
            fixedTimeStep=self.dt, numSolverIterations=200, solverResidualThreshold=1e-12, physicsClientId=self.world
        )

    def _motors(self, force):
        still = [0.0] * len(self.ids)
        mode = pybullet.VELOCITY_CONTROL
        pybullet.setJointMotorControlArray(
            self.body, self.ids, mode, targetVelocities=still, forces=list(force), physicsClientId=self.world
        )

    def _state(self):
        states = pybullet.getJointStates(self.body, self.ids, physicsClientId=self.world)
        return np.array([s[0] for s in states]), np.array([s[1] for s in states])

    def put(self, q, v):
        """Set positions and speeds of the motors; yielding links follow at rest against them."""
        x, w = np.zeros(len(self.ids)), np.zeros(len(self.ids))
        x[self.motors], w[self.motors] = q, v
        for joint, position, speed in zip(self.ids, x, w, strict=True):
            pybullet.resetJointState(self.body, joint, position, speed, physicsClientId=self.world)
        self.before = None

    def read(self):
        """Positions and speeds, as encoders see them."""
        x, w = self._state()
        return x[self.motors], w[self.motors]

    def step(self, torque):
        """One step under commanded torques, as a log would hold them."""
        x, w = self._state()
        push = np.zeros(len(self.ids))
        push[self.motors] = self._driven(torque) - self._smooth(x[self.motors], w[self.motors])
        for joint, link in self.yielding:
            push[link] -= self._across(joint, x[link], w[link])
        bound = np.zeros(len(self.ids))
        bound[self.motors] = self._dry(w[self.motors], self._load(x, w))
        if self.solves:
            push = self._solved(x, w, push, bound)
        else:
            self._motors(bound)
        mode = pybullet.TORQUE_CONTROL
        pybullet.setJointMotorControlArray(self.body, self.ids, mode, forces=list(push), physicsClientId=self.world)
        pybullet.stepSimulation(physicsClientId=self.world)
        moved = self._state()[0] - x
        self.before = w
        for k, (joint, stiffness, friction) in enumerate(self.settings["bristles"]):
            way, most = moved[self.motors[joint]], friction / stiffness
            self.bend[k] = np.sign(way) * most + (self.bend[k] - np.sign(way) * most) * np.exp(-abs(way) / most)

    def _across(self, joint, twist, speed):
        """Torque that a transmission holds against a twist."""
        elasticity = self.settings["elasticity"][joint]
        spring = 0.0 if elasticity is None else elasticity * twist
        return spring + self.settings["twist_damping"][joint] * speed

    def _driven(self, torque):
        """Torque at the joints behind scale, zero, limit and clock of the log."""
        self.past.append(np.asarray(torque, dtype=float))
        out = np.zeros(len(self.motors))
        for j, d in enumerate(self.settings["drives"]):
            steps = round(d["hold"] / self.dt)
            sent = self.past[-1 - steps][j] if len(self.past) > steps else 0.0
            lower = -np.inf if d["lower"] is None else d["lower"]
            upper = np.inf if d["upper"] is None else d["upper"]
            out[j] = (min(max(sent, lower), upper) - d["offset"]) / d["gain"]
        return out

    def _smooth(self, q, v):
        """Torque that the motors lose to everything but dry friction."""
        s = self.settings
        out = np.array(s["quadratic"]) * v * np.abs(v) + np.array(s["friction_bias"])
        out = out + np.array(s["stiffness"]) * (q - np.array(s["spring_rest"]))
        if self.solves:  # else PyBullet's own damping
            out = out + np.array(s["viscous"]) * v
        for joint, order, amplitude, phase in s["ripples"]:
            out[joint] += amplitude * np.sin(order * q[joint] + phase)
        for joint, viscous, _dry, _rotor, ratio in s["couplings"]:
            drag = viscous * (v[joint] + ratio * v[joint - 1])
            out[joint] += drag
            out[joint - 1] += ratio * drag
        for bend, (joint, stiffness, _friction) in zip(self.bend, s["bristles"], strict=True):
            out[joint] += stiffness * bend
        return out

    def _load(self, x, w):
        """Torque of bodies and rotors over the step before."""
        if not any(self.settings["load_friction"]) or self.before is None:
            return np.zeros(len(self.motors))
        a = (w - self.before) / self.dt
        carried = pybullet.calculateInverseDynamics(self.body, list(x), list(w), list(a), physicsClientId=self.world)
        return (np.array(carried) + np.diag(self.rotors) * a)[self.motors]

    def _dry(self, v, load):
        by_power = np.array(self.settings["load_friction_by_power"]) * np.sign(load * v)
        out = np.array(self.settings["friction"]) + (np.array(self.settings["load_friction"]) + by_power) * np.abs(load)
        for joint, extra, speed in self.settings["stribeck"]:
            out[joint] += extra * np.exp(-((v[joint] / speed) ** 2))
        return out

    def _solved(self, x, w, push, bound):
        """Torques that give the engine's bodies the acceleration that bodies with rotors and friction have."""
        M = np.array(pybullet.calculateMassMatrix(self.body, list(x), physicsClientId=self.world))
        rest = [0.0] * len(self.ids)
        h = np.array(pybullet.calculateInverseDynamics(self.body, list(x), list(w), rest, physicsClientId=self.world))
        inverse = np.linalg.inv(M + self.rotors)
        new = w + self.dt * inverse @ (push - h)
        rows, lower, upper, bias = self._bounded(x, self.dt * bound[self.motors])
        acting = np.flatnonzero(upper > lower)
        if len(acting):
            rows = rows[acting]
            eased, free = rows @ inverse, rows @ new + bias[acting]
            found = friction_impulses(eased @ rows.T, free, lower[acting], upper[acting], self.impulse[acting])
            self.impulse[acting] = found
            new = new + eased.T @ found
        return M @ (new - w) / self.dt + h

    def _bounded(self, x, most):
        """Rows of speeds that friction or a stop acts on, with bounds of their impulses and the room left to stops."""
        unit = np.eye(len(self.ids))
        coupled = self.dt * np.array([dry for _, dry in self.rows])
        rows = [*unit[self.motors], *[row for row, _ in self.rows]]
        upper, bias = [*most, *coupled], [0.0] * (len(most) + len(coupled))
        lower = [-u for u in upper]
        for link, half in self.gaps:
            for side in (1.0, -1.0):
                rows.append(side * unit[link])
                lower.append(0.0)
                upper.append(np.inf)
                bias.append(max(half + side * x[link], 0.0) / self.dt)
        return np.array(rows), np.array(lower), np.array(upper), np.array(bias)


def main():
    """Let the arm fall for a second and print where it is."""
    arm = CorrectedArm(Path(__file__).resolve().parent)
    for _ in range(round(1.0 / arm.dt)):
        arm.step(np.zeros(len(arm.motors)))
    print("after 1 s without torque:", arm.read()[0])


if __name__ == "__main__":
    sys.exit(main())
