"""What a model's torque changes by when a joint is not where it was recorded."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d

from lagnet.effects.motion import Motion
from lagnet.recordings.sampling import median_step

SETTLING = 0.04  # [s] over which a modelled torque is smoothed before it may bend a joint


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


def carried_torque(motion: Motion, joint: int) -> np.ndarray:
    """Torque through a joint's transmission, shape (n,) [N m].

    The recorded torque where there is one. The modelled one holds the acceleration of the motor as if it were that of
    the link, and so the very jumps that the transmission hides from the link: it is smoothed.
    """
    if motion.recorded is not None:
        return motion.recorded[:, joint]
    step = median_step(motion.time)
    return gaussian_filter1d(motion.load[:, joint], SETTLING / max(step, 1e-6), mode="nearest")
