"""Derivatives of a model with respect to joint positions, by sixth-order central differences with an error estimate."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from lagnet.plausibility.subject import Subject

# Weights of f(x + kh), k = 1 … 3, for the sixth- and fourth-order central first derivative.
SIXTH = np.array([3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0])
FOURTH = np.array([2.0 / 3.0, -1.0 / 12.0, 0.0])
OF_DISAGREEMENT = 0.1  # share of what the two orders disagree by that is allowed as truncation of the better one


def step(subject: Subject) -> float:
    """Step [rad] or [m]: truncation ~ h⁶ and rounding ~ 1/h in balance; 0.01 for double precision."""
    return float(np.clip(1.5 * subject.rounding ** (1.0 / 7.0), 0.01, 0.2))


def limit(subject: Subject, double: float = 1e-7) -> float:
    """A limit on identities that hold first derivatives, widened for single precision."""
    return max(double, 1e2 * subject.rounding / step(subject))


def position_gradient(
    subject: Subject, call: Callable[[np.ndarray], np.ndarray], q: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Derivative of a call with respect to each joint position.

    Args:
        subject: gives the step.
        call: q of shape (m, dof) to (m, …).
        q: shape (n, dof).

    Returns:
        The derivative, shape (n, dof, …), axis 1 counting the joint moved, and its estimated error, same shape.
    """
    n, dof = q.shape
    h = step(subject)
    shifts = np.concatenate([k * h * np.eye(dof) for k in (1, 2, 3, -1, -2, -3)])
    points = (q[:, None, :] + shifts[None]).reshape(-1, dof)
    values = call(points)
    values = values.reshape(n, 6, dof, *values.shape[1:])
    odd = values[:, :3] - values[:, 3:]
    return _combined(odd, h)


def along(
    subject: Subject, call: Callable[[np.ndarray], np.ndarray], q: np.ndarray, v: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Derivative of a call along the motion v, shape (n, …), and its estimated error."""
    n, dof = q.shape
    h = step(subject) / np.maximum(1.0, np.abs(v).max(axis=1))
    offsets = np.array([1, 2, 3, -1, -2, -3])[None, :, None] * (h[:, None] * v)[:, None, :]
    values = call((q[:, None, :] + offsets).reshape(-1, dof))
    values = values.reshape(n, 6, *values.shape[1:])
    odd = values[:, :3] - values[:, 3:]
    return _combined(odd, h.reshape(n, *[1] * (odd.ndim - 2)))


def _combined(odd: np.ndarray, h: float | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    sixth, fourth = (np.tensordot(weights, odd, axes=(0, 1)) / h for weights in (SIXTH, FOURTH))
    return sixth, OF_DISAGREEMENT * np.abs(sixth - fourth)


def beyond(missed: np.ndarray, error: np.ndarray) -> np.ndarray:
    """What is missed beyond the error of differentiation, zero where that explains it."""
    return np.maximum(np.abs(missed) - error, 0.0)


def christoffel_torque(gradient: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Centrifugal and Coriolis torque of H alone: c_i = Σ_jk (∂H_ij/∂q_k − ½ ∂H_jk/∂q_i) v_j v_k, shape (n, dof).

    Args:
        gradient: shape (n, dof, dof, dof), [n, k, i, j] = ∂H_ij/∂q_k.
        v: shape (n, dof).
    """
    first = np.einsum("nkij,nj,nk->ni", gradient, v, v)
    return first - 0.5 * np.einsum("nijk,nj,nk->ni", gradient, v, v)
