"""Work of the torques equals the change of kinetic and potential energy along smooth random motions."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.motions import DURATION, SmoothMotion, dimension, motions
from lagnet.plausibility.quantities.energy import energy_scale, kinetic_energy
from lagnet.plausibility.search import closer_and_closer
from lagnet.plausibility.subject import Subject

MOTIONS = 8


class EnergyAlongMotion(Check):
    """Potential energy is the model's own; without one it is the work against g along the motion."""

    name = "energy_along_motion"
    title = "work equals the change of kinetic and potential energy"
    meaning = "The model makes or loses energy in motion although nothing rubs."
    unit = "1/s"
    justification = "Exact in mechanics; 1e-7 of the work of typical torques a second is the error of integration."
    stays_because = (
        "energies that disagree with the torques show in free falls too, but those need forward dynamics that can be "
        "followed; this one needs inverse dynamics alone"
    )

    def limit(self, subject: Subject) -> float:
        return max(1e-7, 1e2 * subject.rounding)

    def find(self, subject: Subject) -> Finding:
        rng = np.random.default_rng([subject.seed, 7])
        points = rng.uniform(-1, 1, (MOTIONS, dimension(subject)))
        drifts = self._drift(subject, points).max(axis=1)
        start = points[int(np.argmax(drifts))]
        worst = closer_and_closer(lambda x: self._drift(subject, x).max(axis=1), start, float(drifts.max()), rng)
        point = worst.point
        drift = self._drift(subject, point[None])[0]
        panel = int(np.argmax(drift))
        motion = motions(subject, point[None])
        where = {name: ends[0, panel].tolist() for name, ends in zip("qv", motion.ends, strict=True)}
        where["time"] = panel * DURATION / (drift.size - 1)
        return Finding(float(drift[panel]), where, "energy drifts by a share of the work of typical torques a second")

    @staticmethod
    def _drift(subject: Subject, points: np.ndarray) -> np.ndarray:
        """Energy gained beyond the work done until the end of each panel, over work and time, (m, panels + 1)."""
        motion = motions(subject, points)
        m, n, dof = motion.q.shape
        q, v, a = (x.reshape(-1, dof) for x in (motion.q, motion.v, motion.a))
        worked = motion.integrals(np.sum(v * subject.mechanical_torque(q, v, a), axis=1).reshape(m, n))
        at = [x.reshape(-1, dof) for x in motion.ends]
        energy = kinetic_energy(subject, *at).reshape(m, -1)
        energy = energy - energy[:, :1] + _lifted(subject, motion)
        return np.abs(energy - worked) / (energy_scale(subject) * DURATION)


def _lifted(subject: Subject, motion: SmoothMotion) -> np.ndarray:
    """Potential energy gained until the end of each panel, shape (m, panels + 1)."""
    m, n, dof = motion.q.shape
    if subject.offers("potential_energy"):
        potential = subject.call("potential_energy", motion.ends[0].reshape(-1, dof)).reshape(m, -1)
        return potential - potential[:, :1]
    g = subject.gravity_torque(motion.q.reshape(-1, dof)).reshape(m, n, dof)
    return motion.integrals(np.sum(g * motion.v, axis=2))
