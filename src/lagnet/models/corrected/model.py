"""A nominal model with the physics that a diagnosis named: itself an inverse dynamics, and the next nominal model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, final

import numpy as np

from lagnet.effects.catalogue import effect_named
from lagnet.effects.effect import STAGES, Stage
from lagnet.effects.motion import Motion
from lagnet.errors import EffectError, ModelError
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.remainder import LearnedRemainder
from lagnet.models.corrected.tilted_bodies import tilted_weight
from lagnet.rigid_body.inertia import is_physically_consistent
from lagnet.types import InverseDynamics, JointVector, MassMatrix, Samples, Trajectory

OF_BODIES = {
    "gravity",
    "gravity_regressor",
    "inertial_parameters",
    "joint_torque_regressor",
    "link_regressor",
    "with_gravity",
}
EDGES = ("t0", "t1")  # start and end of what lasts for a while
WRITTEN = {"payload", "link_inertia", "gravity_tilt"}  # what can be written into the bodies of a robot
LAYERS = ("named", "identified", "full")
SOLVES, SOLVED = 12, 1e-12  # steps of forward dynamics, and the torque in parts of its size at which they end
UNORDERED = 1.0  # [s] between samples of which no order is known: nothing carries over from one to the next


@dataclass(frozen=True)
class NamedEffect:
    """One effect of the catalogue with its parameters, at a joint (index) or on the whole arm (None).

    Args:
        effect: name in the catalogue.
        joint: index of the joint, None for the whole arm.
        values: parameters by name, SI units.
        interval: (start, end) [s] outside which the effect is absent; None: always there.
        recording: index of the fitted recording in which it was found; nowhere else does it act. None: in any.
    """

    effect: str
    joint: int | None
    values: Mapping[str, float]
    interval: tuple[float, float] | None = None
    recording: int | None = None

    @property
    def key(self) -> tuple:
        """What makes the effect what it is, to be looked up by."""
        return self.effect, self.joint, tuple(self.values.items()), self.interval, self.recording

    def coordinates(self) -> np.ndarray:
        """The numbers in which a refit steps: those of the law, then start and end where there are any."""
        return np.append(effect_named(self.effect).coordinates(self.values), self.interval or ())

    def at_coordinates(self, x: np.ndarray) -> NamedEffect:
        """The effect with other coordinates."""
        interval = None if self.interval is None else (float(x[-2]), float(x[-1]))
        own = x if interval is None else x[:-2]
        return replace(self, values=effect_named(self.effect).from_coordinates(own), interval=interval)

    def coordinate_bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper bounds of the coordinates."""
        lower, upper = effect_named(self.effect).coordinate_bounds()
        n_edges = len(self.interval or ())
        return np.append(lower, np.full(n_edges, -np.inf)), np.append(upper, np.full(n_edges, np.inf))

    def parameters(self) -> dict[str, float]:
        """Values by name, with t0 and t1 [s] where the effect lasts for a while."""
        edges = {} if self.interval is None else dict(zip(EDGES, map(float, self.interval), strict=True))
        return {**self.values, **edges}

    def added(self, motion: Motion) -> np.ndarray:
        """Torque that the effect adds along a motion, shape (n, dof)."""
        if self.recording is not None and self.recording != motion.recording:
            return np.zeros_like(motion.load)
        law = effect_named(self.effect)
        torque = law.torque(motion, self.joint, self.values)
        if torque.ndim == 1:
            full = np.zeros_like(motion.load)
            full[:, self.joint] = torque
            torque = full
        if self.interval is not None:
            torque = torque * _inside(motion.time, self.interval)[:, None]
        return torque


def _inside(time: np.ndarray, interval: tuple[float, float]) -> np.ndarray:
    """One from start to end, shape (n,), and zero one sample further out: an edge with a slope can be fitted."""
    step = float(np.median(np.diff(time))) if time.size > 1 else 1.0
    begun, ended = ((time - edge) / step for edge in interval)
    return np.clip(begun + 1.0, 0.0, 1.0) * np.clip(1.0 - ended, 0.0, 1.0)


def torque_with(motion: Motion, effects: Sequence[NamedEffect]) -> Trajectory:
    """Torque of the nominal model (`motion.load`) with effects added, stage by stage, shape (n, dof) [N m].

    Effects of one stage all see the load of the stages before; signals act one after the other.
    """
    load = motion.load
    for stage in STAGES:
        seen = motion.with_load(load)
        for effect in (e for e in effects if effect_named(e.effect).stage == stage):
            load = load + effect.added(motion.with_load(load) if stage == "signal" else seen)
        if stage == "body":
            load = load + tilted_weight(motion, effects)
    return load


def load_before(motion: Motion, effects: Sequence[NamedEffect], stage: Stage) -> Trajectory:
    """Torque that effects of a stage see: the nominal one with effects of the stages before, shape (n, dof) [N m]."""
    earlier = STAGES[: STAGES.index(stage)]
    return torque_with(motion, [e for e in effects if effect_named(e.effect).stage in earlier])


@final
@dataclass(frozen=True, eq=False)
class CorrectedModel:
    """A nominal model and named effects.

    Args:
        nominal: the model that was diagnosed.
        effects: what it lacks.
        slow: shape (dof,), blurred speed ε of s(v) [rad/s].
        held: shape (dof,), share of the dry friction that stays while a joint rests; None: none.
        straight: shape (dof,), whether s(v) rises in a straight line to ±1 instead of along tanh; None: nowhere.
        source: folder it was read from, "" if none.
        sha256: checksum of what it was read from.
        recording: index of the fitted recording whose motion it is asked for; None: any other motion, where nothing
            acts that lasts for a while only.
        left: shape (dof,), torque beyond noise that it missed on held-out motion, root mean square; None: not known.
        identified: what the recordings determine beside the effects, whatever its cause; None: nothing.
        remainder: the learned rest; None: nothing.
    """

    nominal: InverseDynamics | Any
    effects: tuple[NamedEffect, ...]
    slow: JointVector
    held: JointVector | None = None
    straight: np.ndarray | None = None
    source: str = ""
    sha256: str = ""
    recording: int | None = None
    left: JointVector | None = None
    identified: IdentifiedLayer | None = None
    remainder: LearnedRemainder | None = None
    kind: str = field(default="corrected", init=False)

    def __post_init__(self) -> None:
        for effect in self.effects:
            law = effect_named(effect.effect)
            missing = {p.name for p in law.parameters} - set(effect.values)
            if missing:
                raise EffectError(f"{law.name} lacks the parameters {sorted(missing)}", where=self.source or None)

    @property
    def joints(self) -> tuple[str, ...]:
        """Joint names in model order."""
        return tuple(self.nominal.joints)

    @property
    def n_dof(self) -> int:
        """Number of joints."""
        return self.nominal.n_dof

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name in {"nominal", "effects"}:
            raise AttributeError(name)
        if name in OF_BODIES and hasattr(self.nominal, name) and self._changes_bodies:
            return getattr(self._changed, name)
        return getattr(self.nominal, name)  # limits, joint types, regressors of bodies, skeleton

    def inverse_dynamics(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """Torque of samples that stand for themselves, shape (n, dof); delays and memory need `torque_along`."""
        time = UNORDERED * np.arange(len(q))
        ordered = [e for e in self.effects if effect_named(e.effect).instantaneous and e.interval is None]
        model = self._written or self.nominal
        if self._written is not None:
            ordered = [e for e in ordered if e.effect not in WRITTEN]
        motion = self._motion(time, q, v, a, model.inverse_dynamics(q, v, a))
        return torque_with(motion, ordered) + self._beside(motion, ordered, in_order=False)

    def torque_along(self, time: Samples, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """Torque along a motion on an even clock, with delays and memory, shape (n, dof) [N m]."""
        motion = self._motion(time, q, v, a, torque_along(self.nominal, time, q, v, a))
        named = torque_with(replace(motion, held=self.held), self.effects)
        return named + self._beside(motion, self.effects, in_order=True)

    def mass_matrix(self, q: Trajectory) -> MassMatrix:
        """Joint-space inertia with rotors and changed bodies, shape (n, dof, dof)."""
        rest = np.zeros_like(q)
        still = self._of_bodies(q, rest, rest)
        columns = [self._of_bodies(q, rest, np.broadcast_to(e, q.shape)) - still for e in np.eye(self.n_dof)]
        return np.stack(columns, axis=2)

    def gravity_torque(self, q: Trajectory) -> Trajectory:
        """Torque that holds the corrected bodies still against gravity, shape (n, dof)."""
        return self._of_bodies(q, np.zeros_like(q), np.zeros_like(q))

    def coriolis_torque(self, q: Trajectory, v: Trajectory) -> Trajectory:
        """Centrifugal and Coriolis torques of the corrected bodies, shape (n, dof)."""
        rest = np.zeros_like(q)
        return self._of_bodies(q, np.asarray(v, dtype=float), rest) - self._of_bodies(q, rest, rest)

    def residual_torque(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """What is no part of the bodies: friction, springs, gains, offsets, shape (n, dof)."""
        return self.inverse_dynamics(q, v, a) - self._of_bodies(q, v, a)

    def forward_dynamics(self, q: Trajectory, v: Trajectory, tau: Trajectory) -> Trajectory:
        """Acceleration that torque tau gives at (q, v), shape (n, dof) [rad/s²]."""
        a = np.zeros_like(q)
        for _ in range(SOLVES):  # one suffices but for friction under a load that depends on the acceleration itself
            missing = tau - self.inverse_dynamics(q, v, a)
            if np.all(np.abs(missing) <= SOLVED * (1.0 + np.abs(tau))):
                break
            columns = [self.inverse_dynamics(q, v, a + e) - tau + missing for e in np.eye(self.n_dof)]
            a = a + np.linalg.solve(np.stack(columns, axis=2), missing[..., None])[..., 0]
        return a

    def with_effects(self, effects: Sequence[NamedEffect]) -> CorrectedModel:
        """The same nominal model with other effects."""
        return replace(self, effects=tuple(effects))

    def with_layers(self, layers: str) -> CorrectedModel:
        """The same correction with some of its layers: "named", "identified" (that and the named one) or "full".

        Raises:
            ModelError: another word.
        """
        if layers not in LAYERS:
            raise ModelError(f"layers={layers!r} is unknown", choices=LAYERS)
        if layers == "full":
            return self
        return replace(self, identified=None if layers == "named" else self.identified, remainder=None)

    def bodies(self) -> Any:
        """The nominal robot with all changes of bodies and tilt written into it; nothing else has a place in one."""
        named = apply_to_bodies(self.nominal, self.effects)
        if self._body_change is None:
            return named
        return named.with_inertial_parameters(named.inertial_parameters() + self._body_change)

    @property
    def regressor_source(self) -> Any:
        """The model whose regressor holds for changes of these bodies, under gravity as named; None without bodies."""
        tilts = [e for e in self.effects if e.effect == "gravity_tilt" and e.interval is None]
        if not hasattr(self.nominal, "joint_torque_regressor"):
            return None
        return apply_to_bodies(self.nominal, tilts) if tilts else self.nominal

    @property
    def _body_change(self) -> np.ndarray | None:
        return None if self.identified is None else self.identified.bodies

    @cached_property
    def _changes_bodies(self) -> bool:
        return self._body_change is not None or any(e.effect in WRITTEN for e in self.effects)

    @cached_property
    def _written(self) -> Any:
        """The robot with its changed bodies, many times quicker than their regressors; None where it cannot be had."""
        if isinstance(self.nominal, CorrectedModel) or not any(e.effect in WRITTEN for e in self.effects):
            return None
        try:
            possible = hasattr(self.nominal, "with_inertial_parameters")
            return apply_to_bodies(self.nominal, self.effects) if possible else None
        except ValueError:  # a first moment without mass
            return None

    @cached_property
    def _changed(self) -> Any:
        return self.bodies()

    def _of_bodies(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """Torque of the rigid part alone, before friction and sensors, shape (n, dof)."""
        nominal = self.nominal
        part = getattr(nominal, "_of_bodies", nominal.inverse_dynamics)
        if part == nominal.inverse_dynamics and hasattr(nominal, "residual_torque"):
            load = nominal.inverse_dynamics(q, v, a) - nominal.residual_torque(q, v, a)
        else:
            load = part(q, v, a)
        bodies = [e for e in self.effects if effect_named(e.effect).stage == "body" and e.interval is None]
        named = torque_with(self._motion(UNORDERED * np.arange(len(q)), q, v, a, load), bodies)
        if self.identified is None:
            return named
        changed = self.identified.body_torque(self._source, q, v, a)
        return named + changed + a @ self.identified.joint_inertia(self.n_dof)

    def _beside(self, motion: Motion, effects: Sequence[NamedEffect], in_order: bool) -> Trajectory:
        """Torque of the layers beyond the named one, shape (n, dof); `effects` are those that `motion.load` lacks."""
        learned = 0.0 if self.remainder is None else self.remainder.torque(motion.q, motion.v, motion.a)
        if self.identified is None:
            return np.zeros_like(motion.load) + learned
        changed = self.identified.body_torque(self._source, motion.q, motion.v, motion.a)
        load = load_before(motion, effects, "torque") + changed
        return changed + self.identified.term_torque(motion, load, in_order) + learned

    @cached_property
    def _source(self) -> Any:
        return self.regressor_source

    def _motion(self, time: Samples, q: Trajectory, v: Trajectory, a: Trajectory, load: Trajectory) -> Motion:
        seen = (time, q, v, a, load, self.slow, self.nominal)
        return Motion(*seen, recording=self.recording, straight=self.straight)


def torque_along(model: Any, time: Samples, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
    """Torque of any model along a motion: with memory where the model has one, sample by sample where not."""
    if hasattr(model, "torque_along"):
        return model.torque_along(time, q, v, a)
    return model.inverse_dynamics(q, v, a)


def has_real_bodies(model: CorrectedModel) -> bool:
    """Whether some distribution of mass has every corrected body, so that a robot file may hold it."""
    own = model.nominal.inertial_parameters()
    bodies = changed_bodies(model.nominal, model.effects)
    if model.identified is not None and model.identified.bodies is not None:
        bodies = bodies + model.identified.bodies
    return bool(np.all(is_physically_consistent(bodies[(bodies != own).any(axis=1)])))


def changed_bodies(nominal: Any, effects: Sequence[NamedEffect]) -> np.ndarray:
    """Ten inertial parameters of every link with payload and link changes added, shape (dof, 10)."""
    own = nominal.inertial_parameters()
    return own + named_body_change(len(own), effects)


def named_body_change(n_dof: int, effects: Sequence[NamedEffect]) -> np.ndarray:
    """What payload and link changes add to the ten inertial parameters of every link, shape (dof, 10)."""
    change = np.zeros((n_dof, 10))
    for effect in effects:
        law: Any = effect_named(effect.effect)
        if law.name in ("payload", "link_inertia") and effect.interval is None:
            change[-1 if effect.joint is None else effect.joint] += law.coordinates(effect.values)
    return change


def apply_to_bodies(nominal: Any, effects: Sequence[NamedEffect]) -> Any:
    """A robot with payload, link changes and tilt of the base in its description.

    Raises:
        EffectError: the nominal model has no bodies.
    """
    if isinstance(nominal, CorrectedModel):
        return apply_to_bodies(nominal.bodies(), effects)
    if not hasattr(nominal, "with_inertial_parameters"):
        raise EffectError("the nominal model has no bodies to write into")
    robot = nominal
    for effect in effects:
        law: Any = effect_named(effect.effect)
        if law.name == "gravity_tilt" and effect.interval is None:
            robot = robot.with_gravity(law.gravity_of(robot.gravity, effect.values))
    return robot.with_inertial_parameters(changed_bodies(nominal, effects))
