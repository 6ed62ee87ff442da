"""What the nominal bodies ask of each joint along a measured motion: gravity, Coriolis, the others' accelerations."""

from __future__ import annotations

import numpy as np
from numba import njit

from lagnet.rigid_body.kinematic_tree import KinematicTree
from lagnet.rollout.rigid_bodies import dynamics, workspace

PROBE = 1e-4  # [rad or m] step of the difference that gives the load's slope


def measured_load(
    tree: KinematicTree, q: np.ndarray, v: np.ndarray, a: np.ndarray, stride: int = 1
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """M_ii without rotors, load and its slope along a motion, each of shape (n, dof).

    The load of joint i is b_i(q, v) + Σ_{k ≠ i} M_ik a_k; its slope is the derivative by q_i of its gravity torque,
    computed at every `stride`-th sample and interpolated between.
    """
    n, dof = q.shape
    arrays = tree.arrays()
    bare = (*arrays[:6], np.zeros(dof), arrays[7])
    mass, load, slope = np.empty((n, dof)), np.empty((n, dof)), np.empty((n, dof))
    poses, speeds, accelerations = (np.ascontiguousarray(x, dtype=float) for x in (q, v, a))
    _along(bare, poses, speeds, accelerations, mass, load, workspace(dof))
    few = np.unique(np.append(np.arange(0, n, stride), n - 1))
    thin = np.empty((len(few), dof))
    _slopes(bare, poses[few], thin, workspace(dof))
    for j in range(dof):
        slope[:, j] = np.interp(np.arange(n), few, thin[:, j])
    return mass, load, slope


@njit(cache=True, error_model="numpy", nogil=True)
def _slopes(tree, q, slope, work):  # pragma: no cover - compiled
    dof = q.shape[1]
    full, above, below, still = np.empty((dof, dof)), np.empty(dof), np.empty(dof), np.zeros(dof)
    for n in range(q.shape[0]):
        for j in range(dof):
            pose = q[n].copy()
            pose[j] += PROBE
            dynamics(tree, pose, still, full, above, work)
            pose[j] -= 2.0 * PROBE
            dynamics(tree, pose, still, full, below, work)
            slope[n, j] = (above[j] - below[j]) / (2.0 * PROBE)


@njit(cache=True, error_model="numpy", nogil=True)
def _along(tree, q, v, a, mass, load, work):  # pragma: no cover - compiled
    dof = q.shape[1]
    full, bias = np.empty((dof, dof)), np.empty(dof)
    for n in range(q.shape[0]):
        dynamics(tree, q[n], v[n], full, bias, work)
        for j in range(dof):
            mass[n, j] = full[j, j]
            load[n, j] = bias[j]
            for k in range(dof):
                if k != j:
                    load[n, j] += full[j, k] * a[n, k]
