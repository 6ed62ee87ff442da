"""Mass matrix and bias torque of a tree of rigid bodies, compiled: M(q) a + b(q, v) = τ.

The bias b holds gravity, centrifugal and Coriolis torques. Bodies are given by ten inertial parameters about their
joint's origin (m, m c, I), so that no centre of mass has to be divided out. Source: Featherstone 2008 (recursive
Newton–Euler and composite-rigid-body algorithms).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from lagnet.rollout.vectors import cross, dot, minus, plus, put, scaled, times, turned, turned_tensor, vector

Tree = tuple[np.ndarray, ...]  # KinematicTree.arrays()


@njit(cache=True, error_model="numpy")
def place(tree, q, rotation, origin):  # pragma: no cover - compiled
    """Axes (dof, 3, 3) and origins (dof, 3) of every joint's frame in the frame of the base, written in place."""
    parents, rotations, translations, axes, sliding = tree[0], tree[1], tree[2], tree[3], tree[4]
    for i in range(q.size):
        p, at = parents[i], vector(translations, i)
        if sliding[i]:
            at = plus(at, scaled(q[i], turned(rotations, i, vector(axes, i))))
        sine, cosine = (0.0, 1.0) if sliding[i] else (np.sin(q[i]), np.cos(q[i]))
        for k in range(3):
            column = turned(rotations, i, _turned_unit(vector(axes, i), sine, cosine, k))
            if p >= 0:
                column = turned(rotation, p, column)
            rotation[i, 0, k], rotation[i, 1, k], rotation[i, 2, k] = column
        put(origin, i, at if p < 0 else plus(vector(origin, p), turned(rotation, p, at)))


@njit(cache=True, error_model="numpy")
def _turned_unit(axis, s, c, k):  # pragma: no cover - compiled
    """Column k of the rotation about an axis by an angle of sine s and cosine c."""
    x, y, z = axis
    t = (1.0 - c) * axis[k]
    if k == 0:
        return c + x * t, y * t + z * s, z * t - y * s
    if k == 1:
        return x * t - z * s, c + y * t, z * t + x * s
    return x * t + y * s, y * t - x * s, c + z * t


def workspace(n_dof: int) -> tuple[np.ndarray, ...]:
    """Arrays that `dynamics` writes in, made once for a rollout."""
    return np.zeros((n_dof, 3, 3)), np.zeros((9, n_dof, 3)), np.zeros((n_dof, 6)), np.zeros(n_dof)


@njit(cache=True, error_model="numpy")
def dynamics(tree, q, v, mass, bias, work):  # pragma: no cover - compiled
    """Mass matrix (dof, dof) and bias torque (dof,) at (q, v), written in place; all vectors in the base's axes."""
    rotation, vectors, second, weight = work
    place(tree, q, rotation, vectors[0])
    _outwards(tree, v, rotation, vectors, second, weight)
    parents, sliding, armature = tree[0], tree[4], tree[6]
    axis, force, couple, first, arm = vectors[1], vectors[5], vectors[6], vectors[7], vectors[8]
    mass[:] = 0.0
    for i in range(q.size - 1, -1, -1):  # composite body i is whole before it is added to the one before
        f, n, p = vector(force, i), vector(couple, i), parents[i]
        bias[i] = dot(vector(axis, i), f if sliding[i] else n)
        _asked_by(parents, sliding, axis, arm, weight, first, second, mass, i)
        mass[i, i] += armature[i]
        if p >= 0:
            put(couple, p, plus(vector(couple, p), plus(n, cross(vector(arm, i), f))))
            put(force, p, plus(vector(force, p), f))
            _add_body(weight, first, second, p, i, vector(arm, i))


@njit(cache=True, error_model="numpy")
def _outwards(tree, v, rotation, vectors, second, weight):  # pragma: no cover - compiled
    """Spins, accelerations at a = 0 and the forces that they ask of each body alone, from the base to the tip."""
    parents, axes, sliding, bodies, gravity = tree[0], tree[3], tree[4], tree[5], tree[7]
    for i in range(v.size):
        p, body, z = parents[i], bodies[i], turned(rotation, i, vector(axes, i))
        spin, turn, push = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (-gravity[0], -gravity[1], -gravity[2])
        arm = vector(vectors[0], i)
        if p >= 0:
            arm = minus(arm, vector(vectors[0], p))
            spin, turn = vector(vectors[2], p), vector(vectors[3], p)
            push = plus(vector(vectors[4], p), plus(cross(turn, arm), cross(spin, cross(spin, arm))))
            across = scaled(v[i], cross(spin, z))
            if sliding[i]:
                push = plus(push, scaled(2.0, across))
            else:
                turn = plus(turn, across)
        if not sliding[i]:
            spin = plus(spin, scaled(v[i], z))
        first = turned(rotation, i, (body[1], body[2], body[3]))
        tensor = turned_tensor(rotation, i, (body[4], body[5], body[7], body[6], body[8], body[9]))
        force = plus(scaled(body[0], push), plus(cross(turn, first), cross(spin, cross(spin, first))))
        couple = plus(times(tensor, turn), plus(cross(spin, times(tensor, spin)), cross(first, push)))
        weight[i] = body[0]
        for k, x in enumerate((z, spin, turn, push, force, couple, first, arm)):
            put(vectors[1 + k], i, x)
        for k in range(6):
            second[i, k] = tensor[k]


@njit(cache=True, error_model="numpy")
def _add_body(weight, first, second, p, i, arm):  # pragma: no cover - compiled
    """Adds composite body i, whose origin lies at `arm` from that of body p, to body p (parallel axes)."""
    m, own = weight[i], vector(first, i)
    x, y, z = arm
    moved = plus(own, scaled(m, arm))
    round_all = dot(arm, plus(own, moved))  # m |arm|² + 2 armᵀ first
    second[p, 0] += second[i, 0] + round_all - x * (moved[0] + own[0])
    second[p, 1] += second[i, 1] - x * moved[1] - own[0] * y
    second[p, 2] += second[i, 2] - x * moved[2] - own[0] * z
    second[p, 3] += second[i, 3] + round_all - y * (moved[1] + own[1])
    second[p, 4] += second[i, 4] - y * moved[2] - own[1] * z
    second[p, 5] += second[i, 5] + round_all - z * (moved[2] + own[2])
    put(first, p, plus(vector(first, p), moved))
    weight[p] += m


@njit(cache=True, error_model="numpy")
def _asked_by(parents, sliding, axis, arm, weight, first, second, mass, i):  # pragma: no cover - compiled
    """Row and column i of M up to i: force and couple that a unit acceleration of joint i asks of what is behind it."""
    z, own = vector(axis, i), vector(first, i)
    if sliding[i]:
        force, couple = scaled(weight[i], z), cross(own, z)
    else:
        tensor = (second[i, 0], second[i, 1], second[i, 2], second[i, 3], second[i, 4], second[i, 5])
        force, couple = cross(z, own), times(tensor, z)
    j = i
    while j >= 0:
        value = dot(vector(axis, j), force if sliding[j] else couple)
        mass[i, j] = value
        mass[j, i] = value
        couple = plus(couple, cross(vector(arm, j), force))
        j = parents[j]
