"""The abstract kinds of left-out physics, and what every effect must say about itself.

An effect adds a torque r to the torque of the nominal model. Two views of the same physics are asked of each final
class:

- `torque(motion, joint, values)`: the exact law, used by corrected models, plots and the last refit;
- `columns(motion, joint, shape)` for each of `shapes(motion, joint)`: the law made linear, used by the search over
  hypotheses. `values(coefficients, shape)` turns fitted coefficients back into physical parameters.

A variant is a new final class in a new file, never a flag.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from statistics import NormalDist
from typing import ClassVar, Literal

import numpy as np

from lagnet.effects.motion import Motion

Values = dict[str, float]
Stage = Literal["body", "transmission", "torque", "signal"]
STAGES: tuple[Stage, ...] = ("body", "transmission", "torque", "signal")
"""When an effect acts: on the bodies, whose torque is the load that transmissions feel and give way to; then at the
joint; then on the recorded signal, which holds all that came before."""


@dataclass(frozen=True)
class Parameter:
    """One physical parameter: its name, symbol, unit for revolute joints, bounds and what it means.

    `formerly` is the name under which older files hold it.
    """

    name: str
    symbol: str
    unit: str
    meaning: str
    lower: float = -np.inf
    upper: float = np.inf
    formerly: str = ""

    def unit_for(self, prismatic: bool) -> str:
        """The unit, with torques and angles turned into forces and lengths for a prismatic joint."""
        if not prismatic:
            return self.unit
        return self.unit.replace("N m", "N").replace("rad", "m")


class Effect(ABC):
    """One physical cause that a simulation may have left out."""

    name: ClassVar[str]
    title: ClassVar[str]
    formula: ClassVar[str]
    parameters: ClassVar[tuple[Parameter, ...]]
    whole_arm: ClassVar[bool] = False  # True: one instance for the arm, joint is None in a verdict
    shown_by: ClassVar[str]  # what motion shows it, as advice: "moves in both directions ..."
    confused_with: ClassVar[tuple[str, ...]] = ()  # names in the catalogue
    source: ClassVar[str]  # key in docs/references
    contains: ClassVar[tuple[str, ...]] = ()  # effects that are special cases of it: never named beside it
    sum_of: ClassVar[tuple[str, ...]] = ()  # effects of which it is the sum while the joint moves
    reaches_all: ClassVar[bool] = False  # True: it changes the torque of other joints too
    needs_bodies: ClassVar[bool] = False  # True: only a model with kinematics (URDF, MJCF) can carry it
    stage: ClassVar[Stage] = "torque"
    absent: ClassVar[tuple[tuple[str, float], ...] | None] = None  # values without effect; None: first one at zero
    is_transient: ClassVar[bool] = False  # True: acts on an interval, and is fitted to the residual of all others
    uses_measured_torque: ClassVar[bool] = False  # True: its torque follows from the recorded one, noise and all
    uses_load: ClassVar[bool] = False  # True: after the body stage, its torque follows from the load of its joint
    plain_terms: ClassVar[int] = 0  # of no effect, that must not do better in its place; 0: none is plainer than it
    nonnegative: ClassVar[bool] = False  # True: each coefficient is a mechanism by itself, at zero where it is absent
    by_convention: ClassVar[Mapping[str, float]] = {}  # half-widths that a parameter's meaning leaves open, SI units
    instantaneous: ClassVar[bool] = True  # False: the torque of a sample depends on samples before it
    is_friction: ClassVar[bool] = False  # True: it dissipates energy at a joint
    is_dry_friction: ClassVar[bool] = False  # True: friction that changes its sign with the velocity
    function_of_speed: ClassVar[bool] = False  # True: its torque is a curve over the joint's velocity alone
    is_body: ClassVar[bool] = False  # True: it has inertial parameters
    changes_link: ClassVar[bool] = False  # True: that body is a modelled link, not one that is added
    is_delay: ClassVar[bool] = False  # True: the torque signal comes late
    settled: ClassVar[tuple[str, ...]] = ()  # parameters that choose between forms of the law: no refit changes them
    is_limit: ClassVar[bool] = False  # True: it acts where the whole torque, friction and all, exceeds a value

    @abstractmethod
    def torque(self, motion: Motion, joint: int | None, values: Mapping[str, float]) -> np.ndarray:
        """The added torque by the exact law, shape (n,) for the joint, or (n, dof) where it reaches other joints."""

    @abstractmethod
    def columns(self, motion: Motion, joint: int | None, shape: Mapping[str, float]) -> np.ndarray:
        """Linearised law: shape (n, k) for the joint's own torque, or (n, dof, k) where it reaches other joints."""

    @abstractmethod
    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        """Physical parameters of fitted coefficients (k,) and the shape that made the columns."""

    def shapes(self, motion: Motion, joint: int | None) -> Sequence[Values]:
        """The values of parameters in which the law is not linear, to be tried one by one; one empty by default."""
        return ({},)

    def proposals(self, motion: Motion, joint: int | None, residual: np.ndarray) -> Sequence[Values]:
        """Shapes that a residual suggests, for laws whose shapes are too many to try; none by default.

        Args:
            residual: shape (n, dof), on the samples of the motion.
        """
        return ()

    def sharper_shape(
        self, coefficients: np.ndarray, shape: Mapping[str, float], beside: Collection[str]
    ) -> Values | None:
        """The shape about which the law is best made linear, as fitted coefficients tell; None: the one it has.

        Args:
            beside: effects that are fitted at its joint as well.
        """
        return None

    def free_numbers(self, shape: Mapping[str, float]) -> int:
        """How many numbers of a shape are set by the residual, beside the coefficients."""
        return len(shape)

    def special_case(self, shape: Mapping[str, float]) -> Values | None:
        """Values of a plainer form, that stand unless those of the shape explain noticeably more; None: none is."""
        return None

    def further_term(self, values: Mapping[str, float], speed: np.ndarray) -> tuple[str, float] | None:
        """A law of `contains` that this one is without a term, and that term over the rest; None by default.

        Args:
            values: of the law.
            speed: shape (n,), those at which it was seen [rad/s]: the term is taken where it is largest.
        """
        return None

    def bounds(self, shape: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper bounds of the coefficients of `columns`."""
        lower = np.array([p.lower for p in self.parameters])
        return lower, np.array([p.upper for p in self.parameters])

    def with_names_of_today(self, held: Mapping[str, float]) -> Values:
        """The values of a file, with parameters that it holds under a former name under that of today."""
        names = {p.formerly: p.name for p in self.parameters if p.formerly and p.name not in held}
        return {names.get(name, name): value for name, value in dict(held).items()}

    def coordinates(self, values: Mapping[str, float]) -> np.ndarray:
        """The numbers in which a refit steps, shape (k,): the parameters, or what the law is plainer in."""
        return np.array([values[p.name] for p in self.free_parameters])

    def from_coordinates(self, coordinates: np.ndarray) -> Values:
        """Inverse of `coordinates`: all parameters but those that are settled."""
        return {p.name: float(c) for p, c in zip(self.free_parameters, coordinates, strict=True)}

    def moved(self, values: Mapping[str, float], coordinates: np.ndarray) -> Values:
        """The values at other coordinates: parameters that are settled stay."""
        return {**values, **self.from_coordinates(coordinates)}

    def coordinate_bounds(self, values: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper bounds of the coordinates of values."""
        return np.array([p.lower for p in self.free_parameters]), np.array([p.upper for p in self.free_parameters])

    @property
    def free_parameters(self) -> tuple[Parameter, ...]:
        """The parameters that are fitted: all but those that choose a form."""
        return tuple(p for p in self.parameters if p.name not in self.settled)

    def body_parameters(self, values: Mapping[str, float]) -> np.ndarray:
        """What is added to the ten inertial parameters of its link, shape (10,); zeros where it is no body."""
        return np.zeros(10)

    def told(self, values: Mapping[str, float]) -> tuple[str, ...]:
        """Names of the parameters that say all: those that are fitted; others follow from these and the model."""
        return tuple(p.name for p in self.free_parameters)

    def chosen(self, values: Mapping[str, float]) -> np.ndarray:
        """Which coordinates stand at the value of a special case, shape (k,); none by default."""
        return np.zeros(self.coordinates(values).size, dtype=bool)

    def is_determined(self, intervals: Mapping[str, tuple[float, float]]) -> bool:
        """Whether some interval leaves out the value at which the effect would not be there, at 95 % for all together.

        One of ten intervals of 95 % leaves it out by chance in 40 % of all cases: k intervals are made wider, so that
        each fails by 5 % / k (Bonferroni).
        """
        if not self.absence:
            return True
        wider = _half_width(len(self.absence)) / _half_width(1)
        middles = {name: 0.5 * (intervals[name][0] + intervals[name][1]) for name, _ in self.absence}
        return any(abs(x - middles[n]) > wider * abs(intervals[n][1] - middles[n]) for n, x in self.absence)

    @property
    def absence(self) -> tuple[tuple[str, float], ...]:
        """Values at which the effect adds no torque; empty where it always adds some."""
        return ((self.parameters[0].name, 0.0),) if self.absent is None else self.absent

    def feasible(self, values: Mapping[str, float]) -> bool:
        """Whether the parameters obey physics (bounds; pseudo-inertias positive definite where there are any)."""
        return all(p.lower <= values[p.name] <= p.upper for p in self.parameters)

    def is_less(self, values: Mapping[str, float]) -> bool:
        """Whether some parameter is below the least that the law has: a model holds more of it than the arm."""
        return any(values[p.name] < p.lower for p in self.parameters if p.name in values)

    def plausible(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> bool:
        """Whether fitted coefficients, noise and all, could be those of real physics; looser than `feasible`."""
        lower, upper = self.bounds(shape)
        return bool(np.all(coefficients >= lower) and np.all(coefficients <= upper))

    def formula_with(self, values: Mapping[str, float]) -> str:
        """The formula of the form that the parameters choose."""
        return self.formula

    def remark(self, values: Mapping[str, float]) -> str:
        """What the parameters come to in plain words, where numbers alone hide it; empty by default."""
        return ""

    def exists_at(self, joint: int | None) -> bool:
        """Whether an arm can have the effect at a joint at all, whatever moves."""
        return True

    @property
    def of_motion_alone(self) -> bool:
        """Whether its torque follows from the motion of its joint, whatever the nominal model."""
        return not (self.reaches_all or self.uses_load)

    @property
    def is_like_no_load(self) -> bool:
        """Whether neither a body nor a share of the load has torque of its form: own motion or earlier times set it."""
        return self.of_motion_alone or not self.instantaneous

    def excitation(self, motion: Motion, joint: int | None) -> str | None:
        """None if the motion can show the effect, else the reason why it cannot, for an abstention."""
        return None


def _half_width(intervals: int) -> float:
    """Standard deviations on each side of one of so many intervals that hold with 95 % together."""
    return NormalDist().inv_cdf(1.0 - 0.025 / intervals)


class LinearEffect(Effect):
    """An effect that is linear in its physical parameters: the columns are the law itself."""

    @abstractmethod
    def regressor(self, motion: Motion, joint: int | None) -> np.ndarray:
        """Torque for each parameter at 1, shape (n, n_parameters) or (n, dof, n_parameters)."""

    def columns(self, motion: Motion, joint: int | None, shape: Mapping[str, float]) -> np.ndarray:
        return self.regressor(motion, joint)

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        return {p.name: float(c) for p, c in zip(self.parameters, coefficients, strict=True)}

    def torque(self, motion: Motion, joint: int | None, values: Mapping[str, float]) -> np.ndarray:
        columns = self.regressor(motion, joint)
        weights = np.array([values[p.name] for p in self.parameters])
        return (columns.reshape(-1, weights.size) @ weights).reshape(columns.shape[:-1])


class StateEffect(Effect):
    """An effect with memory: a hidden state driven by the motion."""

    @abstractmethod
    def init_state(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        """State at the first sample."""

    @abstractmethod
    def derivative(self, state: np.ndarray, q: float, v: float, load: float, values: Mapping[str, float]) -> np.ndarray:
        """Rate of the state at one instant."""

    def left_of_start(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        """Share of the state at the first sample, which no recording tells, that a sample still depends on, (n,)."""
        return np.zeros(motion.time.size)
