"""δ_j ∂τ/∂q_j: what encoder offsets have only together with a tilted base or changed bodies, τ the torque of these."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from lagnet.effects.catalogue import effect_named
from lagnet.effects.motion import Motion
from lagnet.effects.signal.encoder_offset import EncoderOffset
from lagnet.models.corrected.presence import presence
from lagnet.models.corrected.tilted_bodies import BODIES, TILT, Named, change_of_gravity, link_of

OFFSET = EncoderOffset.name
OFFSET_LAW = EncoderOffset()
STEP = 1e-3  # [rad] of the difference quotient


def shifted_weight(motion: Motion, effects: Sequence[Named]) -> np.ndarray | float:
    """Torque of tilt, payloads and link changes that encoder offsets add, shape (n, dof) [N m]; 0 without both.

    Either effect alone is computed with the bodies, the gravity and the angles of the nominal model, which leaves this
    product out. It is linear in the offset: what is left is of third order.
    """
    offsets = [e for e in effects if e.effect == OFFSET and e.joint is not None]
    return sum((e.values["delta"] * weight_slope(motion, int(e.joint or 0), effects) for e in offsets), 0.0)


def weight_slope(motion: Motion, joint: int, effects: Sequence[Named]) -> np.ndarray | float:
    """∂τ/∂q_j of tilts, payloads and link changes along a motion, shape (n, dof) [N m/rad]; 0 without any."""
    tilts, bodies = [e for e in effects if e.effect == TILT], moved_bodies(joint, effects)
    if not tilts and not bodies:
        return 0.0
    change = change_of_gravity(motion, tilts)
    out = np.zeros_like(motion.load)
    for body in bodies:
        link = link_of(motion, body)
        columns = _slope(motion, joint, body_columns, link)
        if tilts:
            columns = columns + np.tensordot(change, _slope(motion, joint, _of_weight, link), 1)
        share = np.asarray(presence(motion, body))[..., None]
        out += columns @ effect_named(body.effect).body_parameters(body.values) * share
    return out + _slope(motion, joint, _of_gravity, 0) @ change if tilts else out


def _slope(motion: Motion, joint: int, of: Callable[[Motion, int], np.ndarray], link: int) -> np.ndarray:
    """∂/∂q_j of a linear map of bodies or gravity, which serves for all values of these: it is computed once."""

    def slope() -> np.ndarray:
        ahead, behind = (of(_shifted(motion, joint, s), link) for s in (1, -1))
        return (ahead - behind) / (2.0 * STEP)

    return motion.remembered(("slope", of.__name__, joint, link), slope)


def body_columns(motion: Motion, link: int) -> np.ndarray:
    """Torque per unit of each inertial parameter of one link, shape (n, dof, 10)."""
    return motion.bodies.link_regressor(link, motion.q, motion.v, motion.a)


def _of_weight(motion: Motion, link: int) -> np.ndarray:
    return motion.bodies.weight_regressor(link, motion.q)


def _of_gravity(motion: Motion, _: int) -> np.ndarray:
    return motion.bodies.gravity_regressor(motion.q)


def moved_bodies(joint: int, effects: Sequence[Named]) -> list[Named]:
    """Payloads and link changes behind a joint, which turns none of the links before it."""
    return [e for e in effects if e.effect in BODIES and (e.joint is None or e.joint >= joint)]


def secant_columns(motion: Motion, joint: int, known: Sequence[Named], columns: np.ndarray) -> np.ndarray:
    """Torque per unit of an encoder offset beside what was found, shape (n, dof, 1) [N m/rad].

    Args:
        motion: whose.
        joint: of the offset.
        known: tilts and bodies, whose weight it shifts, too, and an offset of the joint, at which the column is exact.
        columns: without them.
    """
    deltas = [e.values["delta"] for e in known if e.effect == OFFSET and e.joint == joint]
    for delta in (d for d in deltas if d != 0.0):
        columns = OFFSET_LAW.torque(motion, joint, {"delta": delta})[..., None] / delta
    return columns + np.asarray(weight_slope(motion, joint, known))[..., None]


def _shifted(motion: Motion, joint: int, steps: int) -> Motion:
    return moved(motion, joint, {"q": np.full(motion.time.size, steps * STEP)})


def moved(motion: Motion, joint: int, changes: Mapping[str, np.ndarray]) -> Motion:
    """The motion with other q, v or a of one joint, and a store of its own."""
    signals = {name: getattr(motion, name).copy() for name in changes}
    for name, change in changes.items():
        signals[name][:, joint] += change
    return replace(motion, **signals, cache={})
