"""Falling freely, the arm keeps its energy, second after second."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from lagnet.plausibility.check import Check, Finding, NotApplicable
from lagnet.plausibility.quantities.energy import energy_scale, kinetic_energy
from lagnet.plausibility.search import closer_and_closer
from lagnet.plausibility.subject import Subject

FALLS, DURATION, FRAMES = 6, 0.5, 6  # falls at once, [s], moments at which energy is looked at
SPEED = 0.3  # of the box, at the start
MOST_CALLS = 4000  # beyond it the motion is too stiff to follow


class EnergyAlongRollout(Check):
    """Integrates the model's forward dynamics (or H⁻¹(−c − g)) without torque; what ε takes out is counted."""

    name = "energy_along_rollout"
    title = "a free fall keeps its energy"
    meaning = "A simulation with this model heats up or dies away by itself."
    unit = "1/s"
    justification = (
        "Exact in mechanics; 1e-6 a second of the largest energy is a thousand times the integrator's error."
    )

    def limit(self, subject: Subject) -> float:
        return max(1e-6, 1e3 * subject.rounding)

    def find(self, subject: Subject) -> Finding:
        starts = self._starts(subject)
        drift = self._drift(subject, starts)
        worst = int(np.argmax(drift))
        rng = np.random.default_rng([subject.seed, 9])
        found = closer_and_closer(lambda x: self._drift(subject, x), starts[worst], float(drift[worst]), rng)
        q, v = _decoded(subject, found.point[None])
        where = {"q": q[0].tolist(), "v": v[0].tolist()}
        return Finding(found.value, where, f"energy of a free fall of {DURATION} s drifts by this share a second")

    @staticmethod
    def _starts(subject: Subject) -> np.ndarray:
        return np.random.default_rng([subject.seed, 8]).uniform(-1, 1, (FALLS, 2 * subject.n_dof))

    @staticmethod
    def _drift(subject: Subject, points: np.ndarray) -> np.ndarray:
        """Energy gained over the largest energy in play and time, shape (m,)."""
        q, v = _decoded(subject, points)
        fall = _Fall(subject, len(points))
        begin = np.concatenate([q.ravel(), v.ravel(), np.zeros(2 * len(points))])
        moments = np.linspace(0, DURATION, FRAMES)
        try:
            path = solve_ivp(fall.rate, (0, DURATION), begin, method="DOP853", t_eval=moments, rtol=1e-9, atol=1e-10)
        except _TooManyCalls:
            raise NotApplicable("the free fall is too stiff to follow") from None
        if not path.success or not np.isfinite(path.y).all():
            raise NotApplicable(f"the free fall could not be followed: {path.message}")
        return fall.drift(path.y.T)


class _TooManyCalls(Exception):
    pass


@dataclass
class _Fall:
    """State: q and v of all falls, then per fall the energy that ε took and the potential energy gained."""

    subject: Subject
    count: int
    calls: int = 0

    def split(self, state: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        size = self.count * self.subject.n_dof
        q, v, taken, lifted = np.split(state, [size, 2 * size, 2 * size + self.count])
        return q.reshape(self.count, -1), v.reshape(self.count, -1), taken, lifted

    def rate(self, _time: float, state: np.ndarray) -> np.ndarray:
        self.calls += 1
        if self.calls > MOST_CALLS:
            raise _TooManyCalls
        q, v, _, _ = self.split(state)
        lifted, taken = np.zeros(self.count), np.zeros(self.count)
        if not self.subject.offers("potential_energy"):
            lifted = np.sum(self.subject.gravity_torque(q) * v, axis=1)
        if self.subject.offers("forward_dynamics"):
            a = self.subject.call("forward_dynamics", q, v, np.zeros_like(q))
            taken = np.sum(self.subject.residual(q, v, a) * v, axis=1)
        else:
            bias = self.subject.coriolis_torque(q, v) + self.subject.gravity_torque(q)
            a = np.linalg.solve(self.subject.mass_matrix(q), -bias[..., None])[..., 0]
        return np.concatenate([v.ravel(), a.ravel(), taken, lifted])

    def drift(self, states: np.ndarray) -> np.ndarray:
        kinetic, kept, lifts = [], [], []
        for state in states:
            q, v, taken, lifted = self.split(state)
            if self.subject.offers("potential_energy"):
                lifted = self.subject.call("potential_energy", q)
            kinetic.append(kinetic_energy(self.subject, q, v))
            kept.append(kinetic[-1] + lifted + taken)
            lifts.append(lifted)
        total = np.array(kept) - kept[0]
        in_play = np.maximum(np.ptp(lifts, axis=0), np.max(np.abs(kinetic), axis=0))
        in_play = np.maximum(in_play, 1e-3 * energy_scale(self.subject))
        return np.abs(total).max(axis=0) / (in_play * DURATION)


def _decoded(subject: Subject, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    x, y = np.split(points, 2, axis=1)
    box = subject.ranges
    return box.lower + (box.upper - box.lower) * (x + 1) / 2, SPEED * box.velocity * y
