"""Run an exported servo-driven arm in PyBullet by position commands.

Needs NumPy and PyBullet alone: `python run_servo_pybullet.py` holds the arm where it is for a second; import `ServoArm`
to command it. run_pybullet.py, friction_impulse.py, servo_law.py and surface_force.py lie beside it.
"""

import sys
from pathlib import Path

import numpy as np
import pybullet

try:
    from run_pybullet import CorrectedArm
    from servo_law import ServoLaw
    from surface_force import SurfaceForce
except ImportError:
    from lagnet.simulators.runtime.run_pybullet import CorrectedArm
    from lagnet.simulators.runtime.servo_law import ServoLaw
    from lagnet.simulators.runtime.surface_force import SurfaceForce


class ServoArm(CorrectedArm):
    """The arm of model.urdf and settings.json in a PyBullet world, driven by position commands."""

    def __init__(self, folder, step=0.001, world=None):
        super().__init__(folder, step, world)
        self.servo = self.settings["servo"]
        self.law = ServoLaw(self.servo["law"], step)
        self.offset, self.brake = np.array(self.law.p["offset"]), np.array(self.law.p["back_emf"])
        self.on_link, self.twist = self.law.p["encoder_side"] > 0.5, self.law.p["twist_damping"]
        self.solves, self.motor, self.bare = True, np.zeros(len(self.motors)), self.rotors
        self.surface = self._surface(self.servo["surface"])
        for joint in self.motors:
            pybullet.changeDynamics(self.body, self.ids[joint], jointDamping=0.0, physicsClientId=self.world)

    def _surface(self, given):
        """The surface, with joints as places among all that move: behind a transmission it touches the link."""
        if given is None:
            return None
        behind, share = dict(self.yielding), np.zeros(len(self.ids))
        share[self.motors] = given["share"]
        link = behind.get(given["joint"], self.motors[given["joint"]])
        moved = {**given, "link": int(link), "share": share}
        return SurfaceForce(moved, self.body, self.ids, self.world, self.settings["gravity"])

    def put(self, q, v):
        """Start at positions and speeds; a transmission that yields starts at rest under its load."""
        super().put(q, v)
        self.law.restart()
        load = self._rest_load()
        for j, link in self.yielding:
            elasticity, half = self.settings["elasticity"][j], self.settings["half_gap"][j]
            given = -np.sign(load[j]) * half - (load[j] / elasticity if elasticity is not None else 0.0)
            pybullet.resetJointState(self.body, self.ids[link], given, v[j], physicsClientId=self.world)
            if self.on_link[j]:
                motor = self.ids[self.motors[j]]
                pybullet.resetJointState(self.body, motor, q[j] - given, v[j], physicsClientId=self.world)

    def read(self):
        """Positions and speeds, as encoders see them."""
        x, w = self._state()
        q, v = x[self.motors].copy(), w[self.motors].copy()
        for j, link in self.yielding:
            if self.on_link[j]:
                q[j], v[j] = q[j] + x[link], v[j] + w[link]
        return q, v

    def step(self, command):
        """One step under commanded positions."""
        q, v = self.read()
        self.motor = self.law.torque(self.law.wanted(command, q), v)
        self.rotors = self.bare + self.dt * self._dampers()
        pushed = np.zeros(len(self.motors))
        if self.surface is not None:
            force, beside = self.surface.acting(self._state()[1], self.dt)
            self.rotors, pushed = self.rotors + beside, force[self.motors]
        super().step(self.motor + self.offset + pushed)

    def _dampers(self):
        """Dampers, which are taken at the end of a step, as a matrix beside the rotors."""
        damping = np.zeros(len(self.ids))
        damping[self.motors] = np.array(self.settings["viscous"]) + np.where(self.on_link, 0.0, self.law.damping)
        for j, link in self.yielding:
            damping[link] = self.twist[j]
        return np.diag(damping)

    def _driven(self, torque):
        return np.asarray(torque, dtype=float)

    def _load(self, x, w):
        still = [0.0] * len(self.ids)
        held = pybullet.calculateInverseDynamics(self.body, list(x), list(w), still, physicsClientId=self.world)
        spring = np.array(self.settings["stiffness"]) * (x[self.motors] - np.array(self.settings["spring_rest"]))
        return np.array(held)[self.motors] + spring

    def _rest_load(self):
        return self._load(self._state()[0], np.zeros(len(self.ids)))

    def _dry(self, v, load):
        return self.law.friction(v, load, self.motor - self.brake * v)


def main():
    """Hold the arm where it starts for a second and print where it is."""
    arm = ServoArm(Path(__file__).resolve().parent)
    arm.put(np.zeros(len(arm.motors)), np.zeros(len(arm.motors)))
    for _ in range(round(1.0 / arm.dt)):
        arm.step(np.zeros(len(arm.motors)))
    print("after 1 s with commands of zero:", arm.read()[0])


if __name__ == "__main__":
    sys.exit(main())
