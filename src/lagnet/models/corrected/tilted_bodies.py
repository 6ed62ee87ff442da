"""The weight of changed bodies in the changed field of gravity: what payload and tilt have only together."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import Protocol, runtime_checkable

import numpy as np

from lagnet.effects.catalogue import effect_named
from lagnet.effects.inertia.gravity_tilt import GravityTilt, is_large
from lagnet.effects.motion import Motion
from lagnet.models.corrected.presence import Present, presence
from lagnet.rigid_body.changed_bodies_torque import torque_of_change
from lagnet.rigid_body.robot import Robot

TILT, BODIES = "gravity_tilt", ("payload", "link_inertia")
TILT_LAW = GravityTilt()


@runtime_checkable
class Named(Present, Protocol):
    """An effect with its place, its parameters and when it acts."""

    @property
    def effect(self) -> str: ...
    @property
    def joint(self) -> int | None: ...
    @property
    def values(self) -> Mapping[str, float]: ...


def tilted_weight(motion: Motion, effects: Sequence[Named]) -> np.ndarray | float:
    """Holding torque of payloads and link changes in the difference of gravity, shape (n, dof) [N m]; 0 without both.

    Either effect alone is computed with the bodies and the gravity of the nominal model, which leaves this product out.
    """
    bodies = [e for e in effects if e.effect in BODIES]
    tilts = [e for e in effects if e.effect == TILT]
    if not bodies or not tilts:
        return 0.0
    change = change_of_gravity(motion, tilts)
    return sum((weight(motion, e, change) for e in bodies), np.zeros_like(motion.load))


def body_in_turned_field(motion: Motion, link: int, effects: Sequence[Named]) -> np.ndarray | float:
    """Holding torque per unit of a body's parameters in the difference that large tilts make, shape (n, dof, 10).

    Zero without a large tilt: where a tilt is small, its product with a body is counted with the tilt.
    """
    large = [e for e in effects if e.effect == TILT and is_large(e.values)]
    if not large:
        return 0.0
    return np.einsum("gnji,g->nji", fields_of(motion, link), change_of_gravity(motion, large))


def tilt_columns(
    motion: Motion, law: GravityTilt, shape: Mapping[str, float], known: Sequence[Named], columns: np.ndarray
) -> np.ndarray:
    """Torque per unit of each coefficient of a tilt beside what was found, shape (n, dof, k) [N m].

    Args:
        motion: whose.
        law: of the tilt.
        shape: the large tilt that it is expanded about, or none.
        known: bodies, whose weight a tilt changes, too, and a tilt, at which the columns are exact.
        columns: without them.
    """
    gravity = np.asarray(motion.bodies.gravity, dtype=float)
    changes = law.changes(gravity, shape)
    if shape:
        changes[:, 0] = 0.0  # bodies are seen in the field of a large tilt already
        return columns + weight_in_each(motion, known, changes)
    for tilt in (e for e in known if e.effect == TILT and not is_large(e.values)):
        near = law.changes_near(gravity, tilt.values)
        columns = columns + law.gravity_regressor(motion) @ (near - changes)
        changes = near
    return columns + weight_in_each(motion, known, changes)


def weight_in_each(motion: Motion, effects: Sequence[Named], changes: np.ndarray) -> np.ndarray | float:
    """Holding torque of payloads and link changes in each of some changes of gravity, given as columns of shape (3, k).

    Returns:
        Shape (n, dof, k) [N m]; 0 without payload and link change.
    """
    bodies = [e for e in effects if e.effect in BODIES]
    if not bodies:
        return 0.0
    return np.stack(
        [sum((weight(motion, e, g) for e in bodies), np.zeros_like(motion.load)) for g in changes.T], axis=2
    )


def change_of_gravity(motion: Motion, tilts: Sequence[Named]) -> np.ndarray:
    """Gravity in the frame of a tilted base less that of the model, shape (3,) [m/s²]."""
    gravity = np.asarray(motion.bodies.gravity, dtype=float)
    return sum((TILT_LAW.gravity_of(gravity, e.values) - gravity for e in tilts), np.zeros(3))


def weight(motion: Motion, body: Named, gravity: np.ndarray) -> np.ndarray:
    """Holding torque of a payload or link change in a field of gravity while it is there, shape (n, dof) [N m]."""
    share = np.asarray(presence(motion, body))[..., None]
    return _weight(motion, body, gravity) * share if np.any(share) else np.zeros_like(motion.load)


def carried_torque(motion: Motion, bodies: Sequence[Named], change: np.ndarray) -> np.ndarray:
    """Torque of payloads and link changes in motion while they are there, shape (n, dof) [N m].

    Args:
        motion: whose.
        bodies: carried.
        change: shape (3,), of gravity against that of the model [m/s²].
    """
    out = np.zeros_like(motion.load)
    for group, share in together(motion, bodies):
        out += _carried(motion, group, change) * share
    return out


def together(motion: Motion, bodies: Sequence[Named]) -> Iterator[tuple[list[Named], np.ndarray]]:
    """Bodies that come and go together, and how far they are there, shape (n, 1); none that is never there."""
    groups = defaultdict(list)
    for body in bodies:
        groups[body.interval, body.recording].append(body)
    for group in groups.values():
        share = np.broadcast_to(np.asarray(presence(motion, group[0]))[..., None], (len(motion.time), 1))
        if np.any(share):
            yield group, share


def _carried(motion: Motion, bodies: Sequence[Named], change: np.ndarray) -> np.ndarray:
    """Torque of bodies that are there throughout: linear in them, so that one Newton-Euler pass serves for all."""
    parameters = parameters_of(motion, bodies)
    if isinstance(motion.model, Robot):
        turned = motion.model.with_gravity(motion.model.gravity + change)
        return torque_of_change(turned, parameters, motion.q, motion.v, motion.a)
    moving = sum((motion.body_torque(k, p) for k, p in enumerate(parameters) if p.any()), np.zeros_like(motion.load))
    return moving + (sum(_weight(motion, b, change) for b in bodies) if change.any() else 0.0)


def parameters_of(motion: Motion, bodies: Sequence[Named]) -> np.ndarray:
    """Inertial parameters that payloads and link changes add to each link, shape (dof, 10)."""
    parameters = np.zeros((motion.n_dof, 10))
    for body in bodies:
        parameters[link_of(motion, body)] += effect_named(body.effect).body_parameters(body.values)
    return parameters


def link_of(motion: Motion, body: Named) -> int:
    """Number of the link that a payload or a change of a link belongs to."""
    return motion.n_dof - 1 if body.joint is None else body.joint


def _weight(motion: Motion, body: Named, gravity: np.ndarray) -> np.ndarray:
    link = link_of(motion, body)
    weights = effect_named(body.effect).body_parameters(body.values)
    alone = None if f"weights_{link}" in motion.cache else motion.body_alone(link, weights)
    if alone is not None:  # Newton–Euler at rest
        still = np.zeros_like(motion.q)
        return alone.with_gravity(gravity).inverse_dynamics(motion.q, still, still)
    field = np.tensordot(gravity, fields_of(motion, link), 1)
    return (field.reshape(-1, weights.size) @ weights).reshape(field.shape[:-1])


def fields_of(motion: Motion, link: int) -> np.ndarray:
    """Holding torque per unit of each parameter of a body and of gravity along each axis, shape (3, n, dof, 10)."""
    return motion.remembered(f"weights_{link}", lambda: motion.bodies.weight_regressor(link, motion.q))
