"""Whether a motion can show an effect at all: the reasons that an abstention gives."""

from __future__ import annotations

import numpy as np

from lagnet.effects.motion import Motion

STILL = 3.0  # a joint moves where it is faster than this many times its blurred speed


def moving_share(motion: Motion, joint: int) -> tuple[float, float]:
    """Shares of the time in which the joint moves in the positive and in the negative direction."""
    v, limit = motion.v[:, joint], STILL * motion.slow[joint]
    return float(np.mean(v > limit)), float(np.mean(v < -limit))


def needs_any_motion(motion: Motion) -> str | None:
    """None if any joint moves."""
    if any(sum(moving_share(motion, j)) > 0.02 for j in range(motion.n_dof)):
        return None
    return "no joint moves in the recordings"


def needs_motion(motion: Motion, joint: int) -> str | None:
    """None if the joint moves for a noticeable share of the time."""
    return None if sum(moving_share(motion, joint)) > 0.02 else "the joint does not move in the recordings"


def needs_both_directions(motion: Motion, joint: int) -> str | None:
    """None if the joint moves in both directions."""
    if needs_motion(motion, joint):
        return needs_motion(motion, joint)
    return None if min(moving_share(motion, joint)) > 0.02 else "the joint moves in one direction only"


def reversals(motion: Motion, joint: int) -> int:
    """How often the joint turns back: sign changes of the velocity outside the blurred zone."""
    v = motion.v[:, joint]
    signs = np.sign(v[np.abs(v) > STILL * motion.slow[joint]])
    return int(np.count_nonzero(np.diff(signs)))


def needs_reversals(motion: Motion, joint: int, at_least: int = 4) -> str | None:
    """None if the joint turns back often enough."""
    if needs_both_directions(motion, joint):
        return needs_both_directions(motion, joint)
    count = reversals(motion, joint)
    return None if count >= at_least else f"the joint reverses {count} times only, {at_least} are needed"


def needs_slow_passes(motion: Motion, joint: int, at_least: int = 10) -> str | None:
    """None if enough samples lie at low, yet resolved, speed."""
    if needs_both_directions(motion, joint):
        return needs_both_directions(motion, joint)
    speed = np.abs(motion.v[:, joint])
    usual = float(np.sqrt(np.mean(speed**2)))
    slow = np.count_nonzero((speed > motion.slow[joint]) & (speed < 0.3 * usual))
    return None if slow >= at_least else "the joint hardly ever moves slowly"


def needs_position_range(motion: Motion, joint: int, at_least: float = 0.02) -> str | None:
    """None if the joint covers a range of positions."""
    if needs_motion(motion, joint):
        return needs_motion(motion, joint)
    return None if np.ptp(motion.q[:, joint]) > at_least else "the joint covers hardly any range of positions"


def needs_varying_load(motion: Motion, joint: int, at_least: float = 0.1) -> str | None:
    """None if the size of the load varies by a noticeable part of itself."""
    load = np.abs(motion.load[:, joint])
    usual = float(np.mean(load))
    varies = usual > 0 and float(np.std(load)) > at_least * usual
    return None if varies else "the load of the joint hardly varies"
