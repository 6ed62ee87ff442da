"""τ(q + dq, v + dv, a + da) − τ(q, v, a) of a tilted base and of changed bodies alone: what flexible joints and gaps
have only together with these."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from lagnet.effects.catalogue import effect_named
from lagnet.effects.motion import Motion
from lagnet.effects.transmission import Transmission
from lagnet.models.corrected.presence import presence
from lagnet.models.corrected.shifted_weights import moved, moved_bodies, weight_slope
from lagnet.models.corrected.tilted_bodies import (
    BODIES,
    TILT,
    TILT_LAW,
    Named,
    carried_torque,
    change_of_gravity,
    parameters_of,
    together,
)
from lagnet.rigid_body.changed_bodies_torque import derivatives_of_change
from lagnet.rigid_body.robot import Robot


def shifted_bodies(motion: Motion, effects: Sequence[Named]) -> np.ndarray | float:
    """Torque of tilt, payloads and link changes that transmissions add, shape (n, dof) [N m]; 0 without both.

    Args:
        motion: under the load that transmissions feel.
        effects: all that act.
    """
    out: np.ndarray | float = 0.0
    for effect in effects:
        law, joint = effect_named(effect.effect), effect.joint
        if isinstance(law, Transmission) and joint is not None:
            shift = dict(zip("qva", law.shift(motion, joint, effect.values), strict=True))
            added = _between(moved(motion, joint, shift), motion, joint, effects)
            out = out + np.asarray(presence(motion, effect))[..., None] * added
    return out


def _between(there: Motion, here: Motion, joint: int, effects: Sequence[Named]) -> np.ndarray | float:
    """Torque of tilts, payloads and link changes in one motion of a joint less that in another; 0 without any."""
    tilts, bodies = [e for e in effects if e.effect == TILT], moved_bodies(joint, effects)
    change, out = change_of_gravity(here, tilts), differing_torque(there, joint, effects)
    if bodies:
        out = out - carried_torque(here, bodies, change)
    return out - TILT_LAW.gravity_regressor(here) @ change if tilts else out


def differing_torque(motion: Motion, joint: int, effects: Sequence[Named]) -> np.ndarray | float:
    """Torque of tilts, and of payloads and link changes that a joint moves, shape (n, dof) [N m]; 0 without any."""
    tilts, bodies = [e for e in effects if e.effect == TILT], moved_bodies(joint, effects)
    change = change_of_gravity(motion, tilts)
    out = carried_torque(motion, bodies, change) if bodies else 0.0
    return out + _held(motion, change) if tilts else out


def _held(motion: Motion, gravity: np.ndarray) -> np.ndarray:
    """Holding torque of the nominal bodies in a field of gravity, shape (n, dof) [N m]."""
    if isinstance(motion.model, Robot):  # a third of the time
        return motion.model.with_gravity(gravity).gravity_torque(motion.q)
    return TILT_LAW.gravity_regressor(motion) @ gravity


def transmission_columns(
    motion: Motion, law: Transmission, joint: int, known: Sequence[Named], shape: Mapping[str, float]
) -> np.ndarray:
    """Torque per unit of a transmission's one coefficient beside tilts and bodies, shape (n, dof, 1)."""
    shift = law.shift(motion, joint, law.values(np.ones(1), shape))
    slopes = _slopes(motion, joint, known)
    added = sum((d[:, None] * slope for d, slope in zip(shift, slopes, strict=True)), np.zeros_like(motion.load))
    return law.columns(motion, joint, shape) + added[..., None]


def _slopes(motion: Motion, joint: int, known: Sequence[Named]) -> np.ndarray:
    """∂τ/∂q_j, ∂τ/∂v_j and ∂τ/∂a_j of tilts, payloads and link changes, shape (3, n, dof)."""
    key = tuple((e.effect, e.joint, e.interval, e.recording, *e.values.items()) for e in known)
    if isinstance(motion.model, Robot):
        return motion.remembered(("slopes of bodies", key), lambda: _derivatives(motion, known))[joint]
    return motion.remembered(("slopes of bodies", joint, key), lambda: _differences(motion, joint, known))


def _derivatives(motion: Motion, known: Sequence[Named]) -> np.ndarray:
    """The slopes for the motion of every joint, shape (dof, 3, n, dof)."""
    robot, out = motion.model, np.zeros((3, *motion.q.shape, motion.n_dof))
    change = change_of_gravity(motion, [e for e in known if e.effect == TILT])
    for group, share in together(motion, [e for e in known if e.effect in BODIES]):
        turned, parameters = robot.with_gravity(robot.gravity + change), parameters_of(motion, group)
        out += derivatives_of_change(turned, parameters, motion.q, motion.v, motion.a) * share[..., None]
    if change.any():
        still = np.zeros_like(motion.q)
        out[0] += robot.with_gravity(change).torque_derivatives(motion.q, still, still)[0]
    return np.ascontiguousarray(np.moveaxis(out, 3, 0))


def _differences(motion: Motion, joint: int, known: Sequence[Named]) -> np.ndarray:
    """The slopes for the motion of one joint, shape (3, n, dof): exact in speed and acceleration."""
    bodies, unit = moved_bodies(joint, known), np.ones_like(motion.time)
    change = change_of_gravity(motion, [e for e in known if e.effect == TILT])
    changes = ({"v": unit}, {"v": -unit}, {"a": unit}, {"a": -unit})
    faster, slower, more, less = (carried_torque(moved(motion, joint, c), bodies, change) for c in changes)
    weight = np.broadcast_to(np.asarray(weight_slope(motion, joint, known)), motion.load.shape)
    return np.stack([weight, (faster - slower) / 2.0, (more - less) / 2.0])
