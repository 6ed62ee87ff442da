"""Vectors of three numbers and symmetric 3 × 3 tensors as tuples, which compiled code keeps in registers.

A tensor is (xx, xy, xz, yy, yz, zz).
"""

from __future__ import annotations

from numba import njit


@njit(cache=True, error_model="numpy")
def vector(array, i):  # pragma: no cover - compiled
    """Row i of an array of shape (n, 3)."""
    return array[i, 0], array[i, 1], array[i, 2]


@njit(cache=True, error_model="numpy")
def put(array, i, a):  # pragma: no cover - compiled
    """Write a vector into row i of an array of shape (n, 3)."""
    array[i, 0], array[i, 1], array[i, 2] = a[0], a[1], a[2]


@njit(cache=True, error_model="numpy")
def plus(a, b):  # pragma: no cover - compiled
    """a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@njit(cache=True, error_model="numpy")
def minus(a, b):  # pragma: no cover - compiled
    """a − b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@njit(cache=True, error_model="numpy")
def scaled(s, a):  # pragma: no cover - compiled
    """s a."""
    return s * a[0], s * a[1], s * a[2]


@njit(cache=True, error_model="numpy")
def dot(a, b):  # pragma: no cover - compiled
    """aᵀ b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(cache=True, error_model="numpy")
def cross(a, b):  # pragma: no cover - compiled
    """a × b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@njit(cache=True, error_model="numpy")
def turned(rotations, i, a):  # pragma: no cover - compiled
    """R_i a, of rotations of shape (n, 3, 3)."""
    return (
        rotations[i, 0, 0] * a[0] + rotations[i, 0, 1] * a[1] + rotations[i, 0, 2] * a[2],
        rotations[i, 1, 0] * a[0] + rotations[i, 1, 1] * a[1] + rotations[i, 1, 2] * a[2],
        rotations[i, 2, 0] * a[0] + rotations[i, 2, 1] * a[1] + rotations[i, 2, 2] * a[2],
    )


@njit(cache=True, error_model="numpy")
def times(s, a):  # pragma: no cover - compiled
    """S a of a symmetric tensor."""
    return (
        s[0] * a[0] + s[1] * a[1] + s[2] * a[2],
        s[1] * a[0] + s[3] * a[1] + s[4] * a[2],
        s[2] * a[0] + s[4] * a[1] + s[5] * a[2],
    )


@njit(cache=True, error_model="numpy")
def turned_tensor(rotations, i, s):  # pragma: no cover - compiled
    """R_i S R_iᵀ of a symmetric tensor."""
    x, y, z = vector(rotations[i], 0), vector(rotations[i], 1), vector(rotations[i], 2)
    sx, sy, sz = times(s, x), times(s, y), times(s, z)
    return dot(x, sx), dot(x, sy), dot(x, sz), dot(y, sy), dot(y, sz), dot(z, sz)
