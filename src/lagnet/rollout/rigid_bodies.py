"""Mass matrix and bias torque of a tree of rigid bodies, compiled: M(q) a + b(q, v) = τ.

The bias b holds gravity, centrifugal and Coriolis torques. Bodies are given by ten inertial parameters about their
joint's origin (m, m c, I), so that no centre of mass has to be divided out. Source: Featherstone 2008 (recursive
Newton–Euler and composite-rigid-body algorithms).
"""

from __future__ import annotations

import numpy as np
from numba import njit

Tree = tuple[np.ndarray, ...]  # KinematicTree.arrays()


@njit(cache=True, error_model="numpy")
def place(tree, q, rotation, origin):  # pragma: no cover - compiled
    """Axes (dof, 3, 3) and origins (dof, 3) of every joint's frame in the frame of the base, written in place."""
    parents, rotations, translations, axes, sliding = tree[0], tree[1], tree[2], tree[3], tree[4]
    turned = np.empty((3, 3))
    for i in range(q.size):
        x, y, z = axes[i, 0], axes[i, 1], axes[i, 2]
        s, c = (0.0, 1.0) if sliding[i] else (np.sin(q[i]), np.cos(q[i]))
        t = 1.0 - c
        turned[0, 0], turned[0, 1], turned[0, 2] = c + x * x * t, x * y * t - z * s, x * z * t + y * s
        turned[1, 0], turned[1, 1], turned[1, 2] = y * x * t + z * s, c + y * y * t, y * z * t - x * s
        turned[2, 0], turned[2, 1], turned[2, 2] = z * x * t - y * s, z * y * t + x * s, c + z * z * t
        p = parents[i]
        for a in range(3):
            for b in range(3):
                local = 0.0
                for k in range(3):
                    local += rotations[i, a, k] * turned[k, b]
                rotation[i, a, b] = local
            origin[i, a] = translations[i, a]
            if sliding[i]:
                for k in range(3):
                    origin[i, a] += rotations[i, a, k] * axes[i, k] * q[i]
        if p >= 0:
            for b in range(3):
                u0, u1, u2 = rotation[i, 0, b], rotation[i, 1, b], rotation[i, 2, b]
                for a in range(3):
                    rotation[i, a, b] = rotation[p, a, 0] * u0 + rotation[p, a, 1] * u1 + rotation[p, a, 2] * u2
            u0, u1, u2 = origin[i, 0], origin[i, 1], origin[i, 2]
            for a in range(3):
                moved = rotation[p, a, 0] * u0 + rotation[p, a, 1] * u1 + rotation[p, a, 2] * u2
                origin[i, a] = origin[p, a] + moved


@njit(cache=True, error_model="numpy")
def _cross(a, b, out):  # pragma: no cover - compiled
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]


@njit(cache=True, error_model="numpy")
def _in_base(tree, i, rotation, moment, tensor):  # pragma: no cover - compiled
    """First moment (3,) and inertia tensor (3, 3) of body i about its joint's origin, in the axes of the base."""
    body = tree[5][i]
    r = rotation[i]
    local = np.empty((3, 3))
    local[0, 0], local[1, 1], local[2, 2] = body[4], body[6], body[9]
    local[0, 1] = local[1, 0] = body[5]
    local[0, 2] = local[2, 0] = body[7]
    local[1, 2] = local[2, 1] = body[8]
    for a in range(3):
        moment[a] = r[a, 0] * body[1] + r[a, 1] * body[2] + r[a, 2] * body[3]
        for b in range(3):
            value = 0.0
            for k in range(3):
                for m in range(3):
                    value += r[a, k] * local[k, m] * r[b, m]
            tensor[a, b] = value


@njit(cache=True, error_model="numpy")
def _times(tensor, x, out):  # pragma: no cover - compiled
    for a in range(3):
        out[a] = tensor[a, 0] * x[0] + tensor[a, 1] * x[1] + tensor[a, 2] * x[2]


@njit(cache=True, error_model="numpy")
def _dot(a, b):  # pragma: no cover - compiled
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def workspace(n_dof: int) -> tuple[np.ndarray, ...]:
    """Arrays that `dynamics` writes in, made once for a rollout."""
    return np.zeros((n_dof, 3, 3)), np.zeros((9, n_dof, 3)), np.zeros((n_dof, 3, 3)), np.zeros(n_dof), np.zeros((6, 3))


@njit(cache=True, error_model="numpy")
def dynamics(tree, q, v, mass, bias, work):  # pragma: no cover - compiled
    """Mass matrix (dof, dof) and bias torque (dof,) at (q, v), written in place; all vectors in the base's axes."""
    rotation, vectors, second, weight, small = work
    place(tree, q, rotation, vectors[0])
    _outwards(tree, v, rotation, vectors, second, weight, small)
    parents, sliding, armature = tree[0], tree[4], tree[6]
    axis, force, couple, arm = vectors[1], vectors[5], vectors[6], vectors[8]
    for i in range(q.size - 1, -1, -1):
        bias[i] = _dot(axis[i], force[i]) if sliding[i] else _dot(axis[i], couple[i])
        p = parents[i]
        if p >= 0:
            _cross(arm[i], force[i], small[0])
            for k in range(3):
                couple[p, k] += couple[i, k] + small[0, k]
                force[p, k] += force[i, k]
            _add_body(weight, vectors[7], second, p, i, arm[i])
    _composite(parents, sliding, axis, arm, weight, vectors[7], second, mass, small)
    for i in range(q.size):
        mass[i, i] += armature[i]


@njit(cache=True, error_model="numpy")
def _outwards(tree, v, rotation, vectors, second, weight, small):  # pragma: no cover - compiled
    """Spins, accelerations at a = 0 and the forces that they ask of each body alone, from the base to the tip."""
    parents, axes, sliding, bodies, gravity = tree[0], tree[3], tree[4], tree[5], tree[7]
    origin, axis, spin, turn, push = vectors[0], vectors[1], vectors[2], vectors[3], vectors[4]
    force, couple, first, arm = vectors[5], vectors[6], vectors[7], vectors[8]
    a, b, c = small[0], small[1], small[2]
    for i in range(v.size):
        p = parents[i]
        _times(rotation[i], axes[i], axis[i])
        for k in range(3):
            spin[i, k], turn[i, k], push[i, k] = 0.0, 0.0, -gravity[k]
            arm[i, k] = origin[i, k]
        if p >= 0:
            for k in range(3):
                arm[i, k] -= origin[p, k]
            _cross(turn[p], arm[i], a)
            _cross(spin[p], arm[i], b)
            _cross(spin[p], b, c)
            for k in range(3):
                spin[i, k], turn[i, k] = spin[p, k], turn[p, k]
                push[i, k] = push[p, k] + a[k] + c[k]
            _cross(spin[p], axis[i], a)
            for k in range(3):
                if sliding[i]:
                    push[i, k] += 2.0 * a[k] * v[i]
                else:
                    turn[i, k] += a[k] * v[i]
        if not sliding[i]:
            for k in range(3):
                spin[i, k] += axis[i, k] * v[i]
        _in_base(tree, i, rotation, first[i], second[i])
        weight[i] = bodies[i, 0]
        _cross(turn[i], first[i], a)
        _cross(spin[i], first[i], b)
        _cross(spin[i], b, c)
        for k in range(3):
            force[i, k] = weight[i] * push[i, k] + a[k] + c[k]
        _times(second[i], spin[i], a)
        _cross(spin[i], a, b)
        _times(second[i], turn[i], c)
        _cross(first[i], push[i], a)
        for k in range(3):
            couple[i, k] = a[k] + b[k] + c[k]


@njit(cache=True, error_model="numpy")
def _add_body(weight, first, second, p, i, arm):  # pragma: no cover - compiled
    """Adds composite body i, whose origin lies at `arm` from that of body p, to body p (parallel axes)."""
    m = weight[i]
    along = arm[0] * arm[0] + arm[1] * arm[1] + arm[2] * arm[2]
    across = arm[0] * first[i, 0] + arm[1] * first[i, 1] + arm[2] * first[i, 2]
    for k in range(3):
        for j in range(3):
            second[p, k, j] += second[i, k, j] - m * arm[k] * arm[j] - arm[k] * first[i, j] - first[i, k] * arm[j]
        second[p, k, k] += m * along + 2.0 * across
    for k in range(3):
        first[p, k] += first[i, k] + m * arm[k]
    weight[p] += m


@njit(cache=True, error_model="numpy")
def _composite(parents, sliding, axis, arm, weight, first, second, mass, small):  # pragma: no cover - compiled
    """M from the force and couple that a unit acceleration of each joint asks of the composite body behind it."""
    force, couple, moved = small[3], small[4], small[5]
    mass[:] = 0.0
    for i in range(axis.shape[0]):
        if sliding[i]:
            for k in range(3):
                force[k] = weight[i] * axis[i, k]
            _cross(first[i], axis[i], couple)
        else:
            _cross(axis[i], first[i], force)
            _times(second[i], axis[i], couple)
        j = i
        while j >= 0:
            value = _dot(axis[j], force) if sliding[j] else _dot(axis[j], couple)
            mass[i, j] = value
            mass[j, i] = value
            _cross(arm[j], force, moved)
            for k in range(3):
                couple[k] += moved[k]
            j = parents[j]
