"""A level surface on which a point of an arm may rest: f = k max(0, h − z_p(q)) upwards, and μ f against its sliding.

p is fixed to one body, z its height along gravity above the base's origin; joints feel Jᵀ of both forces. k is what
surface, gripper and links give way together. In a step f is taken at its end, as is friction: the minimum of the same
convex function, with ½ k min(0, z + h/2 J (v + v') − h)² besides. Sliding friction is μ f u / max(|u|, `SLOW`) for a
point that slides at u, with f and |u| of the step's begin: a point that rests creeps, by less than `SLOW`.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
from numba import njit

from lagnet.rigid_body.kinematic_tree import KinematicTree
from lagnet.rollout.rigid_bodies import place

SURFACE = ("body", "px", "py", "pz", "height", "hardness", "friction")  # joint that moves it, m, m, m, m, N/m, 1
BODY, PX, PY, PZ, HEIGHT, HARDNESS, FRICTION = range(7)
SLOW = 0.01  # [m/s]


def heights_of(tree: KinematicTree, surface: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Height of the point above the surface in every pose, shape (n,) [m].

    Args:
        tree: the rigid bodies.
        surface: shape (len(SURFACE),).
        q: shape (n, dof).
    """
    out, poses = np.empty(len(q)), np.ascontiguousarray(q, dtype=float)
    _heights(tree.arrays(), np.ascontiguousarray(surface, dtype=float), poses, out)
    return out


def levers_of(tree: KinematicTree, surface: np.ndarray, q: np.ndarray) -> np.ndarray:
    """∂z/∂q of the point in every pose, shape (n, dof) [m, or 1 of a sliding joint].

    z is a sinusoid of every turning joint and linear in every sliding one, so half of its difference between a quarter
    turn to either side (or one metre) is its slope.
    """
    poses, out = np.asarray(q, dtype=float), np.empty(np.shape(q))
    for j, sliding in enumerate(tree.sliding):
        step = np.eye(poses.shape[1])[j] * (1.0 if sliding else np.pi / 2.0)
        out[:, j] = (heights_of(tree, surface, poses + step) - heights_of(tree, surface, poses - step)) / 2.0
    return out


@njit(cache=True, error_model="numpy")
def _heights(tree, surface, q, out):  # pragma: no cover - compiled
    dof = q.shape[1]
    rotation, origin = np.empty((dof, 3, 3)), np.empty((dof, 3))
    ux, uy, uz = _upwards(tree[7])
    for n in range(q.shape[0]):
        place(tree, q[n], rotation, origin)
        x, y, z = _point(surface, rotation, origin)
        out[n] = ux * x + uy * y + uz * z - surface[HEIGHT]


@njit(cache=True, error_model="numpy")
def _upwards(gravity):  # pragma: no cover - compiled
    size = sqrt(gravity[0] ** 2 + gravity[1] ** 2 + gravity[2] ** 2)
    return -gravity[0] / size, -gravity[1] / size, -gravity[2] / size


@njit(cache=True, error_model="numpy")
def _point(surface, rotation, origin):  # pragma: no cover - compiled
    body = int(surface[BODY])
    r, at = rotation[body], origin[body]
    p0, p1, p2 = surface[PX], surface[PY], surface[PZ]
    x = at[0] + r[0, 0] * p0 + r[0, 1] * p1 + r[0, 2] * p2
    y = at[1] + r[1, 0] * p0 + r[1, 1] * p1 + r[1, 2] * p2
    z = at[2] + r[2, 0] * p0 + r[2, 1] * p1 + r[2, 2] * p2
    return x, y, z


@njit(cache=True, error_model="numpy")
def height_above(tree, surface, work, slopes):  # pragma: no cover - compiled
    """Height of the point above the surface [m], after `dynamics` at a pose; its Jacobian is written into slopes.

    slopes: shape (3, dof), first ∂z/∂q, then those along two level axes at right angles.
    """
    parents, sliding = tree[0], tree[4]
    origin, axis = work[1][0], work[1][1]
    ux, uy, uz = _upwards(tree[7])
    sx, sy, sz = _level(ux, uy, uz)
    tx, ty, tz = uy * sz - uz * sy, uz * sx - ux * sz, ux * sy - uy * sx
    px, py, pz = _point(surface, work[0], origin)
    slopes[:] = 0.0
    j = int(surface[BODY])
    while j >= 0:
        x, y, z = axis[j, 0], axis[j, 1], axis[j, 2]
        if not sliding[j]:
            dx, dy, dz = px - origin[j, 0], py - origin[j, 1], pz - origin[j, 2]
            x, y, z = y * dz - z * dy, z * dx - x * dz, x * dy - y * dx
        slopes[0, j] = ux * x + uy * y + uz * z
        slopes[1, j] = sx * x + sy * y + sz * z
        slopes[2, j] = tx * x + ty * y + tz * z
        j = parents[j]
    return ux * px + uy * py + uz * pz - surface[HEIGHT]


@njit(cache=True, error_model="numpy")
def _level(x, y, z):  # pragma: no cover - compiled
    """A unit vector at right angles to another."""
    if abs(x) < 0.9:
        size = sqrt(y * y + z * z)
        return 0.0, z / size, -y / size
    size = sqrt(x * x + z * z)
    return -z / size, 0.0, x / size


@njit(cache=True, error_model="numpy")
def sliding_friction(surface, slopes, height, v):  # pragma: no cover - compiled
    """Force against sliding over its speed [N s/m] of a point at a height above the surface."""
    if surface[FRICTION] == 0.0 or height >= 0.0:
        return 0.0
    along, across = 0.0, 0.0
    for j in range(v.size):
        along += slopes[1, j] * v[j]
        across += slopes[2, j] * v[j]
    return -surface[FRICTION] * surface[HARDNESS] * height / max(sqrt(along * along + across * across), SLOW)


@njit(cache=True, error_model="numpy")
def pressed(contact, v, j, new, h):  # pragma: no cover - compiled
    """What the surface adds to inertia and push of joint j, where the point is below it at that joint's new speed.

    contact: ∂z/∂q, height at the end of the step if all joints stood still in its second half, and hardness.
    """
    slopes, left, hardness = contact
    if hardness == 0.0:
        return 0.0, 0.0
    for m in range(v.size):
        if m != j:
            left += 0.5 * h * slopes[m] * v[m]
    if left + 0.5 * h * slopes[j] * new >= 0.0:
        return 0.0, 0.0
    return 0.5 * h * h * hardness * slopes[j] * slopes[j], -h * hardness * slopes[j] * left
