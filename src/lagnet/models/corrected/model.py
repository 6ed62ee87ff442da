"""τ_nominal + Σ_k r_k: a nominal model with named effects; itself an inverse dynamics, and the next nominal model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, final

import numpy as np

from lagnet.effects.catalogue import effect_named
from lagnet.effects.motion import Motion
from lagnet.errors import EffectError, ModelError
from lagnet.models.corrected.changed_bodies import CHANGES_OF_BODIES, apply_to_bodies
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.named_effects import NamedEffect, load_before, torque_with
from lagnet.models.corrected.remainder.learned import LearnedRemainder
from lagnet.models.corrected.shifted_weights import shifted_weight
from lagnet.types import (
    InverseDynamics,
    JointVector,
    MassMatrix,
    RigidBodyModel,
    RobotModel,
    Samples,
    Trajectory,
    has_regressor,
    is_robot_model,
)

OF_LINKS = ("body", "transmission")  # stages of effects on the links themselves
OF_BODIES = {
    "gravity",
    "gravity_regressor",
    "inertial_parameters",
    "joint_torque_regressor",
    "link_regressor",
    "weight_regressor",
    "with_gravity",
}
LAYERS = ("named", "identified", "full")
MOST_STEPS, TOLERANCE = 12, 1e-12  # Newton steps of forward dynamics; error over 1 + |τ| at which they end
UNORDERED = 1.0  # [s] between samples without order: nothing carries over from one to the next


@final
@dataclass(frozen=True, eq=False)
class CorrectedModel:
    """τ = τ_nominal + Σ_k r_k + Y Δπ + Σ_i w_i f_i(q, v, a) + ε: a nominal model, named effects and further layers.

    Args:
        nominal: the model that was diagnosed.
        effects: the named effects r_k.
        slow: shape (dof,), width of the smooth sign s(v) [rad/s].
        held: shape (dof,), share of the dry friction that stays while a joint is at standstill; None: none.
        straight: shape (dof,), whether s(v) rises in a straight line to ±1 instead of along tanh; None: nowhere.
        source: folder it was read from, "" if none.
        sha256: checksum of what it was read from.
        recording: index of the fitted recording whose motion it is asked for; None: any other motion, where nothing
            acts that lasts for a while only.
        errors: by layer, shape (dof,): √max(mean r² − σ², 0) of the residual r that it and those before it leave on
            held-out motion, σ the noise [N m]; None: not known.
        identified: Y Δπ and Σ_i w_i f_i, which the recordings determine whatever their cause; None: nothing.
        instead: such a layer in the place of the effects that always act and of `identified`, where it predicts unseen
            motion better than both: torques are then of it, and the effects are claims alone. None: there is none.
        kept: (effect, joint) of those that act beside `instead` nevertheless, since it has no function of their law.
        remainder: ε, learned from the residual; None: nothing.
    """

    nominal: InverseDynamics | Any
    effects: tuple[NamedEffect, ...]
    slow: JointVector
    held: JointVector | None = None
    straight: np.ndarray | None = None
    source: str = ""
    sha256: str = ""
    recording: int | None = None
    errors: Mapping[str, JointVector] | None = None
    identified: IdentifiedLayer | None = None
    instead: IdentifiedLayer | None = None
    kept: frozenset[tuple[str, int | None]] = frozenset()
    remainder: LearnedRemainder | None = None
    kind: str = field(default="corrected", init=False)

    def __post_init__(self) -> None:
        for effect in self.effects:
            law = effect_named(effect.effect)
            missing = {p.name for p in law.free_parameters} - set(effect.values)
            if missing:
                raise EffectError(f"{law.name} lacks the parameters {sorted(missing)}", where=self.source or None)

    @property
    def layer(self) -> IdentifiedLayer | None:
        """The identified layer that torques are of."""
        return self.identified if self.instead is None else self.instead

    @property
    def left(self) -> JointVector | None:
        """What its layers leave beyond the noise on held-out motion, shape (dof,) [N m]; None: not known."""
        if self.errors is None:
            return None
        if self.remainder is not None:
            return self.errors["full"]
        return self.errors["named" if self.layer is None else "identified"]

    @property
    def acting(self) -> tuple[NamedEffect, ...]:
        """The named effects that torques are of: all but those in whose place a layer stands."""
        if self.instead is None:
            return self.effects
        return tuple(e for e in self.effects if not e.always_acts or (e.effect, e.joint) in self.kept)

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
        """τ of samples without order, shape (n, dof) [N m]; delays and hysteresis need `torque_along`."""
        time = UNORDERED * np.arange(len(q))
        lasting = [e for e in self.acting if e.interval is None]
        ordered = [e for e in lasting if effect_named(e.effect).instantaneous]
        model = self._written or self.nominal
        if self._written is not None:
            ordered = [e for e in ordered if e.effect not in CHANGES_OF_BODIES]
        motion = self._motion(time, q, v, a, model.inverse_dynamics(q, v, a))
        if self._written is not None:
            motion = motion.with_load(motion.load + shifted_weight(motion, lasting))
        return torque_with(motion, ordered) + self._beside(motion, ordered, in_order=False)

    def torque_along(self, time: Samples, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """τ along a motion on an even clock, with delays and hysteresis, shape (n, dof) [N m]."""
        motion = self._motion(time, q, v, a, torque_along(self.nominal, time, q, v, a))
        named = torque_with(replace(motion, held=self.held), self.acting)
        return named + self._beside(motion, self.acting, in_order=True)

    def mass_matrix(self, q: Trajectory) -> MassMatrix:
        """Joint-space inertia with rotors and changed bodies, shape (n, dof, dof)."""
        zero = np.zeros_like(q)
        gravity = self._of_bodies(q, zero, zero)
        columns = [self._of_bodies(q, zero, np.broadcast_to(e, q.shape)) - gravity for e in np.eye(self.n_dof)]
        return np.stack(columns, axis=2)

    def gravity_torque(self, q: Trajectory) -> Trajectory:
        """Torque that holds the corrected bodies still against gravity, shape (n, dof)."""
        return self._of_bodies(q, np.zeros_like(q), np.zeros_like(q))

    def coriolis_torque(self, q: Trajectory, v: Trajectory) -> Trajectory:
        """Centrifugal and Coriolis torques of the corrected bodies, shape (n, dof)."""
        zero = np.zeros_like(q)
        return self._of_bodies(q, np.asarray(v, dtype=float), zero) - self._of_bodies(q, zero, zero)

    def residual_torque(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """τ less the torque of the rigid bodies: friction, springs, gains, offsets, shape (n, dof) [N m]."""
        return self.inverse_dynamics(q, v, a) - self._of_bodies(q, v, a)

    def forward_dynamics(self, q: Trajectory, v: Trajectory, tau: Trajectory) -> Trajectory:
        """Acceleration that torque tau gives at (q, v), shape (n, dof) [rad/s²], by Newton's method.

        One step suffices except for friction under a load that depends on the acceleration itself.
        """
        a = np.zeros_like(q)
        for _ in range(MOST_STEPS):
            missing = tau - self.inverse_dynamics(q, v, a)
            if np.all(np.abs(missing) <= TOLERANCE * (1.0 + np.abs(tau))):
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
        if layers == "named":
            return replace(self, identified=None, instead=None, remainder=None)
        return replace(self, remainder=None)

    def bodies(self) -> RobotModel:
        """The nominal robot with all changes of bodies and tilt written into it, without friction and signals."""
        named = apply_to_bodies(self.nominal, self.acting)
        if self._body_change is None:
            return named
        return named.with_inertial_parameters(named.inertial_parameters() + self._body_change)

    @property
    def regressor_source(self) -> RigidBodyModel | None:
        """The model whose regressor holds for changes of these bodies, under gravity as named; None without bodies."""
        tilts = [e for e in self.acting if e.effect == "gravity_tilt" and e.interval is None]
        if not has_regressor(self.nominal):
            return None
        return apply_to_bodies(self.nominal, tilts) if tilts else self.nominal

    @property
    def _body_change(self) -> np.ndarray | None:
        return None if self.layer is None else self.layer.bodies

    @cached_property
    def _changes_bodies(self) -> bool:
        return self._body_change is not None or any(e.effect in CHANGES_OF_BODIES for e in self.acting)

    @cached_property
    def _written(self) -> RobotModel | None:
        """The robot with its changed bodies, many times faster than their regressors; None where there is none."""
        if isinstance(self.nominal, CorrectedModel) or not any(e.effect in CHANGES_OF_BODIES for e in self.acting):
            return None
        try:
            return apply_to_bodies(self.nominal, self.acting) if is_robot_model(self.nominal) else None
        except ValueError:  # a first moment without mass
            return None

    @cached_property
    def _changed(self) -> RobotModel:
        return self.bodies()

    def _of_bodies(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """Torque of the rigid bodies alone, without friction and sensors, shape (n, dof) [N m]."""
        nominal: Any = self.nominal
        part = getattr(nominal, "_of_bodies", nominal.inverse_dynamics)
        if part == nominal.inverse_dynamics and hasattr(nominal, "residual_torque"):
            tau_nominal = nominal.inverse_dynamics(q, v, a) - nominal.residual_torque(q, v, a)
        else:
            tau_nominal = part(q, v, a)
        bodies = [e for e in self.acting if effect_named(e.effect).stage in OF_LINKS and e.interval is None]
        named = torque_with(self._motion(UNORDERED * np.arange(len(q)), q, v, a, tau_nominal), bodies)
        if self.layer is None:
            return named
        changed = self.layer.body_torque(self._source, q, v, a)
        return named + changed + a @ self.layer.joint_inertia(self.n_dof)

    def _beside(self, motion: Motion, effects: Sequence[NamedEffect], in_order: bool) -> Trajectory:
        """Y Δπ + Σ_i w_i f_i + ε, the layers beyond the named one, shape (n, dof) [N m].

        Args:
            effects: those that `motion.load` is without.
            in_order: whether samples follow each other in time.
        """
        learned = 0.0 if self.remainder is None else self.remainder.torque(motion.q, motion.v, motion.a)
        if self.layer is None:
            return np.zeros_like(motion.load) + learned
        changed = self.layer.body_torque(self._source, motion.q, motion.v, motion.a)
        load = load_before(motion, effects, "torque") + changed
        return changed + self.layer.term_torque(motion, load, in_order) + learned

    @cached_property
    def _source(self) -> RigidBodyModel | None:
        return self.regressor_source

    def _motion(self, time: Samples, q: Trajectory, v: Trajectory, a: Trajectory, load: Trajectory) -> Motion:
        return Motion(time, q, v, a, load, self.slow, self.nominal, recording=self.recording, straight=self.straight)


def torque_along(model: Any, time: Samples, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
    """τ of any model along a motion, shape (n, dof) [N m]: with hysteresis where the model has it, else by samples."""
    if hasattr(model, "torque_along"):
        return model.torque_along(time, q, v, a)
    return model.inverse_dynamics(q, v, a)
