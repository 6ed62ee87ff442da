"""What a model's torque changes by when a joint is not where it was recorded."""

from __future__ import annotations

import numpy as np

from lagnet.effects.motion import Motion


def shifted_torque(
    motion: Motion, joint: int, dq: np.ndarray, dv: np.ndarray | None = None, da: np.ndarray | None = None
) -> np.ndarray:
    """τ(q + dq, v + dv, a + da) − τ(q, v, a) of the nominal model, shape (n, dof) [N m].

    Args:
        dq, dv, da: shape (n,), changes of one joint's motion; None: none.
    """
    moved = []
    for signal, change in ((motion.q, dq), (motion.v, dv), (motion.a, da)):
        signal = signal.copy()
        if change is not None:
            signal[:, joint] += change
        moved.append(signal)
    base = motion.remembered("nominal torque", lambda: motion.model.inverse_dynamics(motion.q, motion.v, motion.a))
    return motion.model.inverse_dynamics(*moved) - base
