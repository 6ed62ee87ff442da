"""Run an exported model in MuJoCo, with friction that follows speed and load set at every step.

Needs NumPy and MuJoCo alone: `python run_mujoco.py` lets the arm fall for a second; import `CorrectedArm` to command
it.
"""

# pyright: reportAttributeAccessIssue=false, reportMissingImports=false
import json
import sys
from pathlib import Path

import mujoco
import numpy as np


class CorrectedArm:
    """The arm of model.xml and settings.json.

    Args:
        folder: where they lie.
        step: [s]; None: the step of the file.
    """

    def __init__(self, folder, step=None):
        folder = Path(folder)
        self.settings = json.loads((folder / "settings.json").read_text(encoding="utf-8"))
        self.model = mujoco.MjModel.from_xml_path(str(folder / "model.xml"))
        if step is not None:
            self.model.opt.timestep = step  # histories of delays have room for steps down to 2.5e-5 s
        self.data = mujoco.MjData(self.model)
        names = self.settings["joints"]
        joints = [self.model.joint(name).id for name in names]
        self.position = self.model.jnt_qposadr[joints]
        self.speed = self.model.jnt_dofadr[joints]
        actuators = [self.model.actuator(name).id for name in names]
        address = getattr(self.model, "actuator_ctrladr", None)  # since MuJoCo 4 an actuator may have several inputs
        self.command = np.array(actuators if address is None else address[actuators])
        self._friction = np.array(self.settings["friction"])
        self._per_load = np.array(self.settings["load_friction"])
        self._by_power = np.array(self.settings["load_friction_by_power"])
        self._follows = bool(self.settings["stribeck"]) or self._per_load.any()

    def put(self, q, v):
        """Set positions and speeds."""
        mujoco.mj_resetData(self.model, self.data)
        self.data.qpos[self.position], self.data.qvel[self.speed] = q, v
        mujoco.mj_forward(self.model, self.data)

    def read(self):
        """Positions and speeds, as encoders see them."""
        return self.data.qpos[self.position].copy(), self.data.qvel[self.speed].copy()

    def step(self, torque):
        """One step under commanded torques, as a log would hold them."""
        self.data.ctrl[self.command] = torque
        if self._follows:
            self.model.dof_frictionloss[self.speed] = self.friction()
        mujoco.mj_step(self.model, self.data)

    def friction(self):
        """Dry friction of every joint at the present speed and load."""
        out = self._friction.copy()
        if self._per_load.any():
            load = self.load()
            out += (self._per_load + self._by_power * np.sign(load * self.data.qvel[self.speed])) * np.abs(load)
        for joint, extra, speed in self.settings["stribeck"]:
            out[joint] += extra * np.exp(-((self.data.qvel[self.speed[joint]] / speed) ** 2))
        return out

    def load(self):
        """Torque of bodies and rotors over the step before."""
        carried = np.zeros(self.model.nv)
        mujoco.mj_mulM(self.model, self.data, carried, self.data.qacc)
        return (carried + self.data.qfrc_bias)[self.speed]


def main():
    """Let the arm fall for a second and print where it is."""
    arm = CorrectedArm(Path(__file__).resolve().parent)
    for _ in range(round(1.0 / arm.model.opt.timestep)):
        arm.step(np.zeros(len(arm.command)))
    print("after 1 s without torque:", arm.read()[0])


if __name__ == "__main__":
    sys.exit(main())
