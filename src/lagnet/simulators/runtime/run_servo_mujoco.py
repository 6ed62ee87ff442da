"""Run an exported servo-driven arm in MuJoCo by position commands.

Needs NumPy and MuJoCo alone: `python run_servo_mujoco.py` holds the arm where it is for a second; import `ServoArm` to
command it. servo_law.py lies beside it. Joints whose law a position actuator states in full are left to model.xml; the
controllers of the others, and dry friction that follows speed and load, are set at every step.
"""

# pyright: reportAttributeAccessIssue=false, reportMissingImports=false
import json
import sys
from pathlib import Path

import mujoco
import numpy as np

try:
    from servo_law import ServoLaw
except ImportError:
    from lagnet.simulators.runtime.servo_law import ServoLaw

LINK, GAP = "_link", "_gap"


class ServoArm:
    """The arm of model.xml and settings.json.

    Args:
        folder: where they lie.
        step: [s]; None: the step of the file.
    """

    def __init__(self, folder, step=None):
        folder = Path(folder)
        self.settings = json.loads((folder / "settings.json").read_text(encoding="utf-8"))
        self.servo, names = self.settings["servo"], self.settings["joints"]
        spec = mujoco.MjSpec.from_file(str(folder / "model.xml"))
        if step is not None:
            spec.option.timestep = step
        self.scripted = np.array(self.servo["scripted_drive"])
        self.friction_follows = np.array(self.servo["scripted_friction"])
        law = self.servo["law"]
        self.whole = np.array(law["saturation"]) + np.array(law["encoder_side"]) > 0.0  # no gain on speed of MuJoCo's
        for name, scripted, whole in zip(names, self.scripted, self.whole, strict=True):
            if scripted:
                self._as_motor(spec.actuator(name), whole)
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.law = ServoLaw(self.servo["law"], self.model.opt.timestep)
        self._find(names)

    def _as_motor(self, actuator, whole):
        """An actuator that takes torques, whole or less its gain on speed."""
        damping = 0.0 if whole else actuator.biasprm[2]
        actuator.gainprm[0], actuator.biasprm[:3] = 1.0, (0.0, 0.0, damping)
        actuator.delay, actuator.nsample = 0.0, 0

    def _find(self, names):
        model = self.model
        joints = [model.joint(name).id for name in names]
        self.position, self.speed = model.jnt_qposadr[joints], model.jnt_dofadr[joints]
        self.actuators = np.array([model.actuator(name).id for name in names])
        address = getattr(model, "actuator_ctrladr", None)  # since MuJoCo 4 an actuator may have several inputs
        self.command = np.array(self.actuators if address is None else address[self.actuators])
        known = {model.joint(i).name: i for i in range(model.njnt)}
        self.links = [[known[n + end] for end in (LINK, GAP) if n + end in known] for n in names]

    def put(self, q, v):
        """Start at positions and speeds; a transmission that yields starts at rest under its load."""
        mujoco.mj_resetData(self.model, self.data)
        self.data.qpos[self.position], self.data.qvel[self.speed] = q, v
        mujoco.mj_forward(self.model, self.data)
        self.law.restart()
        self._started = False
        for j, links in enumerate(self.links):
            if links:
                self._twist(j, links, self.data.qfrc_bias[self.speed[j]])
        mujoco.mj_forward(self.model, self.data)

    def _twist(self, j, links, load):
        elasticity, half = self.settings["elasticity"][j], self.settings["half_gap"][j]
        for link in links:
            spring = self.model.joint(link).name.endswith(LINK)
            given = -load / elasticity if spring else -np.sign(load) * half
            self.data.qpos[self.model.jnt_qposadr[link]] = given
            if self.servo["law"]["encoder_side"][j] > 0.5:
                self.data.qpos[self.position[j]] -= given

    def read(self):
        """Positions and speeds, as encoders see them."""
        q, v = self.data.qpos[self.position].copy(), self.data.qvel[self.speed].copy()
        for j, links in enumerate(self.links):
            if self.servo["law"]["encoder_side"][j] > 0.5:
                q[j] += sum(self.data.qpos[self.model.jnt_qposadr[i]] for i in links)
                v[j] += sum(self.data.qvel[self.model.jnt_dofadr[i]] for i in links)
        return q, v

    def step(self, command):
        """One step under commanded positions."""
        command = np.asarray(command, dtype=float)
        if not self._started:
            self._hold(command)
        q, v = self.read()
        wanted = self.law.wanted(command, q)
        motor = self.law.torque(wanted, v)
        sent = np.where(self.whole, motor, wanted)
        self.data.ctrl[self.command] = np.where(self.scripted, sent, command)
        if self.friction_follows.any():
            load = self.data.qfrc_bias[self.speed] - self.data.qfrc_spring[self.speed]
            brake = np.array(self.servo["law"]["back_emf"]) * v
            friction = self.law.friction(v, load, motor - brake)
            at = self.speed[self.friction_follows]
            self.model.dof_frictionloss[at] = friction[self.friction_follows]
        mujoco.mj_step(self.model, self.data)

    def _hold(self, command):
        """Before the first step the first command was held."""
        self._started = True
        self.data.ctrl[self.command] = command
        for actuator, late, sent in zip(self.actuators, self.law.p["delay"], command, strict=True):
            samples = int(np.ravel(self.model.actuator_history[actuator])[0])
            if late > 0.0 and samples:
                held = np.full((samples, 1), sent)
                mujoco.mj_initCtrlHistory(self.model, self.data, int(actuator), None, held)


def main():
    """Hold the arm where it starts for a second and print where it is."""
    arm = ServoArm(Path(__file__).resolve().parent)
    arm.put(np.zeros(len(arm.position)), np.zeros(len(arm.position)))
    for _ in range(round(1.0 / arm.model.opt.timestep)):
        arm.step(np.zeros(len(arm.position)))
    print("after 1 s with commands of zero:", arm.read()[0])


if __name__ == "__main__":
    sys.exit(main())
