"""The diagnosis' view of recordings: pieces of motion, their nominal torque, and the samples that are evidence."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from lagnet.diagnosis.problem.thinning import thinned
from lagnet.diagnosis.settings import DecisionLimits
from lagnet.effects.effect import Effect
from lagnet.effects.motion import BODIES, Motion
from lagnet.errors import DiagnosisError
from lagnet.models.corrected.model import torque_along
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.recordings.conditioning.condition import Conditioned, Stretch
from lagnet.recordings.conditioning.smoothing import SETTLING, low_pass
from lagnet.recordings.sampling import spread_rows
from lagnet.types import InverseDynamics

OVERSAMPLING = 2.5  # reduced samples per second over the bandwidth: Nyquist with room for the filter's slope
LONGEST = 20_000  # samples of a piece: bounds the memory of a regressor
REST = 0.6  # a joint rests where it stays slow for this many periods of the bandwidth
SUMMARY = 6_000  # samples of the summary motion
MOST_KEPT = 128e6  # bytes of all regressors of a problem up to which they are kept


@dataclass(frozen=True, eq=False)
class Segment:
    """A stretch, or part of a long one, at full rate.

    Args:
        time: shape (n,); q, v, a, tau, load: shape (n, dof); load is the nominal torque.
        recording: index of its recording.
        keep: valid rows after low-pass and decimation, without edges.
        counts: shape (len(keep), dof), False where the joint rests and dry friction may take any value.
        origin: index of the fitted recording that it is a part of; None for another recording.
        columns: low-passed columns of hypotheses that were asked for already, by what they follow from.
        known: what follows from the samples and a nominal model, by that model: regressors, low-passed torque.
    """

    time: np.ndarray
    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    tau: np.ndarray
    load: np.ndarray
    recording: int
    keep: np.ndarray
    counts: np.ndarray
    origin: int | None = None
    columns: dict[Hashable, np.ndarray] = field(default_factory=dict, init=False, repr=False)
    known: list[tuple[InverseDynamics, dict]] = field(default_factory=list, init=False, repr=False)

    def with_counts(self, counts: np.ndarray) -> Segment:
        """The same piece with other samples that count, shape (len(keep), dof)."""
        out = replace(self, counts=counts)
        out.columns.update(self.columns)
        out.known.extend(self.known)
        return out

    def motion(self, problem: Problem) -> Motion:
        """The piece as the effects see it."""
        cache = self._known_of(problem)
        key = ("recorded", problem.rate, problem.bandwidth)
        if key not in cache:
            cache[key] = low_pass(self.tau, problem.rate, problem.bandwidth)
        seen = (self.time, self.q, self.v, self.a, self.load, problem.slow, problem.nominal)
        return Motion(*seen, cache[key], problem.held, self.origin, problem.straight, cache)

    def _known_of(self, problem: Problem) -> dict:
        """What is known of the samples under the problem's nominal model; of much motion little is kept."""
        if not self.known or self.known[0][0] is not problem.nominal:
            self.known[:] = [(problem.nominal, {})]
        known = self.known[0][1]
        return known if problem.is_small else {BODIES: known.setdefault(BODIES, {})}


@dataclass(frozen=True, eq=False)
class Problem:
    """Fit and held-out pieces of one diagnosis.

    Args:
        nominal: the model that is held against the recordings.
        fit, holdout: pieces; the second are never used to fit.
        rate, bandwidth: [Hz].
        slow: shape (dof,), blurred speed of each joint; straight: whether dry friction rises in a line up to it.
        joints: names.
        scale: shape (dof,), standard deviation of the recorded torque [N m].
        held: shape (dof,), share of the dry friction that stays at rest; None while it is not known.
        missed: shape (dof,), torque that the nominal model is known to miss, root mean square; None: not known [N m].
        limits: where the diagnosis decides.
        known: effects by which the load differs from the nominal one, for the columns of effects that act on it.
        below_limits: torque of single joints whose recorded torque stops at a limit, for the columns of that.
        given: the model as it was given, where `nominal` has links as the recordings determine them; None: `nominal`.
    """

    nominal: InverseDynamics
    fit: tuple[Segment, ...]
    holdout: tuple[Segment, ...]
    rate: float
    bandwidth: float
    slow: np.ndarray
    joints: tuple[str, ...]
    scale: np.ndarray = field(default_factory=lambda: np.ones(0))
    held: np.ndarray | None = None
    missed: np.ndarray | None = None
    known: tuple[NamedEffect, ...] = ()
    below_limits: tuple[NamedEffect, ...] = ()
    straight: np.ndarray | None = None
    limits: DecisionLimits = field(default_factory=DecisionLimits)
    given: InverseDynamics | None = None

    @property
    def n_dof(self) -> int:
        """Number of joints."""
        return len(self.joints)

    def known_to(self, law: Effect) -> tuple[NamedEffect, ...]:
        """Effects by which the load that a law acts on differs from the nominal one."""
        return (*self.known, *self.below_limits) if law.is_limit else self.known

    @cached_property
    def is_small(self) -> bool:
        """Whether the joint torque regressors of all samples fit into memory."""
        samples = sum(p.time.size for p in (*self.fit, *self.holdout))
        return 8.0 * samples * self.n_dof * 10 * self.n_dof <= MOST_KEPT

    @cached_property
    def unseen_variance(self) -> np.ndarray:
        """Variance of the held-out torque, shape (dof,) [N² m²]: the unit of held-out nMSE."""
        torque = np.concatenate([self.reduce(p, p.tau) for p in self.holdout])
        return np.maximum(torque.var(axis=0), 1e-300)

    def reduce(self, piece: Segment, x: np.ndarray) -> np.ndarray:
        """The low-pass of a signal at the samples that count, shape (len(keep), ...); the same for torque and model."""
        flat = x.reshape(x.shape[0], -1)
        return low_pass(flat, self.rate, self.bandwidth)[piece.keep].reshape(piece.keep.size, *x.shape[1:])

    def residual(self, piece: Segment) -> np.ndarray:
        """What the nominal torque lacks, low-passed and decimated, shape (len(keep), dof)."""
        return self.reduce(piece, piece.tau - piece.load)

    def summary(self) -> Motion:
        """Samples from all over the fit pieces, for statistics of the motion (not a time series)."""
        total = sum(p.keep.size for p in self.fit)
        every = max(1, total // SUMMARY)
        rows = [p.keep[::every] for p in self.fit]
        pairs = list(zip(self.fit, rows, strict=True))
        time, q, v, a, load = (
            np.concatenate([getattr(p, n)[r] for p, r in pairs]) for n in ("time", "q", "v", "a", "load")
        )
        recorded = np.concatenate([low_pass(p.tau, self.rate, self.bandwidth)[r] for p, r in pairs])
        return Motion(time, q, v, a, load, self.slow, self.nominal, recorded, straight=self.straight)


def pose_problem(
    nominal: InverseDynamics,
    fit: Conditioned,
    holdout: Conditioned,
    ends_of: Sequence[int | None] = (),
    limits: DecisionLimits | None = None,
) -> Problem:
    """Computes the nominal torque on every stretch and picks the samples that count.

    Args:
        ends_of: for each held-out recording the index of the fitted one that it is the end of, None for another.

    Raises:
        DiagnosisError: no stretch is long enough.
    """
    fit, holdout = thinned(fit), thinned(holdout, fit)
    slow = blurred_speed(fit)
    empty = Problem(
        nominal, (), (), fit.rate, fit.bandwidth, slow, tuple(nominal.joints), limits=limits or DecisionLimits()
    )
    fitted = tuple(replace(p, origin=p.recording) for p in _pieces(empty, fit))
    origins = dict(enumerate(ends_of))
    held = tuple(replace(p, origin=origins.get(p.recording)) for p in _pieces(empty, holdout))
    posed = replace(empty, fit=fitted, holdout=held)
    if not posed.fit or not posed.holdout:
        raise DiagnosisError(
            "no stretch of motion is long enough to be filtered",
            next_step=f"record at least {4.0 / fit.bandwidth:.1f} s without a gap, for fitting and for holding out",
        )
    power = sum(np.sum(problem_torque**2, axis=0) for problem_torque in _centred_torque(posed))
    count = sum(p.keep.size for p in posed.fit)
    return replace(posed, scale=np.sqrt(power / count))


def _centred_torque(problem: Problem) -> list[np.ndarray]:
    torque = [problem.reduce(p, p.tau) for p in problem.fit]
    mean = np.concatenate(torque).mean(axis=0)
    return [t - mean for t in torque]


def blurred_speed(conditioned: Conditioned) -> np.ndarray:
    """Speed below which the sign of each joint's velocity is not known, shape (dof,) [rad/s].

    Noise blurs it, and so does the clock: between two samples the joint may already have turned.
    """
    v = np.concatenate([s.v for s in conditioned.stretches])
    a = np.concatenate([s.a for s in conditioned.stretches])
    usual, change = np.sqrt(np.mean(v**2, axis=0)), np.sqrt(np.mean(a**2, axis=0)) / conditioned.rate
    floor = 0.001 * float(np.max(usual)) if usual.size else 0.0
    return np.maximum.reduce(
        [2.5 * conditioned.noise_v, 0.5 * change, 0.003 * usual, np.full_like(usual, floor + 1e-9)]
    )


def _pieces(problem: Problem, conditioned: Conditioned) -> Iterator[Segment]:
    settle = int(np.ceil(SETTLING * problem.rate / problem.bandwidth))
    step = max(1, int(problem.rate / (OVERSAMPLING * problem.bandwidth)))
    for stretch in conditioned.stretches:
        for start, stop, first, last in _cuts(stretch.time.size, settle, step):
            yield _piece(problem, stretch, slice(start, stop), np.arange(first - start, last - start, step))


def _cuts(n: int, settle: int, step: int) -> Iterator[tuple[int, int, int, int]]:
    """Start and stop of each piece and, inside it, of the samples that count; pieces overlap where filters settle."""
    first = settle
    while first < n - settle:
        last = min(first + step * (LONGEST // step), n - settle)
        yield max(0, first - 4 * settle), min(n, last + 4 * settle), first, last
        first = last


def _piece(problem: Problem, stretch: Stretch, rows: slice, keep: np.ndarray) -> Segment:
    q, v, a = stretch.q[rows], stretch.v[rows], stretch.a[rows]
    load = torque_along(problem.nominal, stretch.time[rows], q, v, a)
    counts = ~_resting(v, problem)[keep]
    return Segment(stretch.time[rows], q, v, a, stretch.tau[rows], load, stretch.recording, keep, counts)


def _resting(v: np.ndarray, problem: Problem) -> np.ndarray:
    """Where a joint rests, widened by what the filter smears, shape (n, dof)."""
    window = max(3, int(REST * problem.rate / problem.bandwidth))
    still = np.abs(v) < problem.slow
    return np.column_stack([_long_runs(still[:, j], window) for j in range(v.shape[1])])


def _long_runs(flags: np.ndarray, window: int) -> np.ndarray:
    """Runs of at least `window` true flags, widened by half a window on both sides."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(np.int8), [0]])))
    out = np.zeros_like(flags)
    for start, stop in edges.reshape(-1, 2):
        if stop - start >= window:
            out[max(0, start - window // 2) : stop + window // 2] = True
    return out


def spread_evenly(pieces: Sequence[Segment], most: int) -> tuple[Segment, ...]:
    """Pieces spread evenly over all, of together at most so many samples at full rate (at least one)."""
    total = sum(p.time.size for p in pieces)
    if total <= most:
        return tuple(pieces)
    wanted = max(1, int(len(pieces) * most / total))
    return tuple(pieces[i] for i in spread_rows(len(pieces), wanted))
