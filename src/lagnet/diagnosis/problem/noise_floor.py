"""σ_j = √(σ_τ² + var τ₀(q + δq, v + δv, a + δa)): the residual that sensor noise alone would leave at each joint."""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.problem.problem import Problem
from lagnet.recordings.conditioning.condition import Conditioned

PROBES = 600  # samples at which the model's sensitivity to motion noise is tried


def noise_floor(problem: Problem, conditioned: Conditioned, seed: int) -> np.ndarray:
    """Standard deviation of the torque residual that noise alone leaves after filtering, shape (dof,) [N m].

    Torque noise is measured above the motion's band; motion noise is drawn at its measured size and sent through the
    nominal model.
    """
    summary = problem.summary()
    rng = np.random.default_rng(seed)
    rows = rng.permutation(summary.time.size)[:PROBES]
    q, v, a = summary.q[rows], summary.v[rows], summary.a[rows]
    shaken = [
        x + rng.standard_normal(x.shape) * noise
        for x, noise in ((q, conditioned.noise_q), (v, conditioned.noise_v), (a, conditioned.noise_a))
    ]
    difference = problem.nominal.inverse_dynamics(*shaken) - problem.nominal.inverse_dynamics(q, v, a)
    from_motion = np.sqrt(np.mean(difference**2, axis=0))
    rounding = 1e-7 * problem.scale
    return np.sqrt(conditioned.noise_tau**2 + from_motion**2 + rounding**2)
