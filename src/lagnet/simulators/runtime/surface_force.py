"""A level surface in PyBullet on which a point of an arm may rest: f = k max(0, h − z) upwards, μ f against sliding.

Joints feel Jᵀ of both forces. In a step f is taken at its end, so that a hard surface stays stable: what depends on the
new speeds goes beside the masses. Needs NumPy and PyBullet alone.
"""

import numpy as np
import pybullet

SLOW = 0.01  # [m/s] over which sliding friction sets in: a point that rests creeps by less


class SurfaceForce:
    """What a surface does to an arm.

    Args:
        surface: link (place among `ids`), point in its frame [m], height along gravity above the world's origin [m],
            hardness [N/m], friction, and share of each moving joint in the force, as settings.json has it.
        body, ids, world: the arm, its moving joints and the client in PyBullet.
        gravity: shape (3,) [m/s²].
    """

    def __init__(self, surface, body, ids, world, gravity):
        self.surface, self.body, self.ids, self.world = surface, body, ids, world
        self.share = np.array(surface["share"], dtype=float)
        up = -np.array(gravity) / np.linalg.norm(gravity)
        level = np.cross(up, np.eye(3)[np.argmin(np.abs(up))])
        level /= np.linalg.norm(level)
        self.axes = np.array([up, level, np.cross(up, level)])
        parents = {i: pybullet.getJointInfo(body, i, physicsClientId=world)[16] for i in range(self._count())}
        self.chain, link = [], ids[surface["link"]]
        while link >= 0:
            self.chain.append(link)
            link = parents[link]

    def _count(self):
        return pybullet.getNumJoints(self.body, physicsClientId=self.world)

    def point(self):
        """Its position in the world, shape (3,) [m], and its Jacobian, shape (3, moving joints)."""
        tip = self._link(self.ids[self.surface["link"]])
        at = np.array(tip[4]) + _turn(tip[5]) @ np.array(self.surface["point"])
        jacobian = np.zeros((3, len(self.ids)))
        for link in self.chain:
            if link not in self.ids:
                continue
            info, state = pybullet.getJointInfo(self.body, link, physicsClientId=self.world), self._link(link)
            axis = _turn(state[1]) @ np.array(info[13])
            sliding = info[2] == pybullet.JOINT_PRISMATIC
            jacobian[:, self.ids.index(link)] = axis if sliding else np.cross(axis, at - np.array(state[4]))
        return at, jacobian

    def _link(self, link):
        return pybullet.getLinkState(self.body, link, computeForwardKinematics=1, physicsClientId=self.world)

    def acting(self, speed, step):
        """Torques at the moving joints, shape (n,), and what stands beside their masses, shape (n, n), in a step.

        Args:
            speed: shape (n,).
            step: [s].
        """
        at, jacobian = self.point()
        rises, *slides = self.axes @ jacobian
        height = float(self.axes[0] @ at) - self.surface["height"]
        stiff, slides = self.surface["hardness"], np.array(slides)
        ahead = height + step * float(rises @ speed)
        push, beside = np.zeros(len(speed)), np.zeros((len(speed), len(speed)))
        if ahead < 0.0:
            push -= stiff * ahead * rises
            beside += 0.5 * step**2 * stiff * np.outer(rises, rises)
        if height < 0.0 and self.surface["friction"]:
            across = slides @ speed
            rub = -self.surface["friction"] * stiff * height / max(float(np.linalg.norm(across)), SLOW)
            push -= rub * across @ slides
            beside += step * rub * slides.T @ slides
        return self.share * push, self.share[:, None] * beside


def _turn(quaternion):
    return np.array(pybullet.getMatrixFromQuaternion(quaternion)).reshape(3, 3)
