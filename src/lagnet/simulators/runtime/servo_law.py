"""Position controllers and dry friction of servos, step by step: from commands to torques.

u is the command T ago, e = dead_band(u − q − δ; b), x = clip(kp e + ki ∫e dt − kd v, ±kp E),
τ = clip(x / (1 + σ |x|), ±τ_max);
friction ≤ Fc + Fs g + (K± |load| + K_m |τ| + K₂ load²)(1 + s g), g = exp(−(v/v_s)²). Needs NumPy alone.
"""

from collections import deque

import numpy as np

STILL = 1e-3  # [rad/s], below it a joint is at rest


class ServoLaw:
    """The servos of one arm, joint by joint.

    Args:
        law: parameters by name, each of shape (dof,), as settings.json has them under "servo".
        step: [s].
    """

    def __init__(self, law, step):
        self.p = {name: np.array(values, dtype=float) for name, values in law.items()}
        self.step = step
        self.late = self.p["delay"] / step
        self.whole = np.floor(self.late).astype(int)
        self.restart()

    def restart(self):
        """Forget commands and integrals."""
        self.past = deque(maxlen=int(self.whole.max()) + 2)
        self.total, self.damping = np.zeros(len(self.late)), np.zeros(len(self.late))

    def command(self, sent):
        """The command that the drives work on in this step, shape (dof,); the first one was held before."""
        sent = np.asarray(sent, dtype=float)
        self.past.append(sent)
        while len(self.past) < self.past.maxlen:
            self.past.appendleft(sent)
        history, joints, share = np.array(self.past), np.arange(len(sent)), self.late - self.whole
        newest = len(history) - 1 - self.whole
        return (1.0 - share) * history[newest, joints] + share * history[newest - 1, joints]

    def wanted(self, sent, q):
        """kp e + ki ∫e dt, shape (dof,) [N m]."""
        p = self.p
        error = self.command(sent) - q - p["bias"]
        error = np.sign(error) * np.maximum(np.abs(error) - p["dead_band"], 0.0)
        self.total = self.total + self.step * p["ki"] * error
        return p["kp"] * error + self.total

    def torque(self, wanted, v):
        """Torque of the controllers for what they want and the speed that they measure, shape (dof,) [N m].

        Its slope −∂τ/∂v is kept as `damping`.
        """
        p = self.p
        full = p["kp"] * p["full_error"]
        asked = wanted - p["kd"] * v
        x = np.clip(asked, -full, full)
        lost = 1.0 + p["saturation"] * np.abs(x)
        torque = np.clip(x / lost, -p["torque_limit"], p["torque_limit"])
        free = (np.abs(asked) <= full) & (np.abs(x / lost) <= p["torque_limit"])
        self.damping = np.where(free, p["kd"] / lost**2, 0.0)
        return torque

    def friction(self, v, load, motor):
        """Greatest dry friction at speeds, loads and motor torques, shape (dof,) [N m]."""
        p = self.p
        still = np.abs(v) < STILL
        pace = np.maximum(p["stribeck_speed"], 1e-12)
        g = np.where(still, 1.0, np.exp(-np.minimum((v / pace) ** 2, 700.0)))
        side = np.where(still, np.sign(motor + p["offset"] - load), np.sign(v))
        size = np.abs(load)
        gear = np.where(side * load > 0.0, p["load_driving"], p["load_driven"]) * size
        gear = gear + p["load_squared"] * size**2 + p["load_motor"] * np.abs(motor)
        return p["coulomb"] + p["static"] * g + gear * (1.0 + p["load_stribeck"] * g)
