"""The answer for one configuration is the same alone, in a batch, and when asked again."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.search import worst_configuration
from lagnet.plausibility.subject import Subject

SAMPLES, ALONE = 32, 8  # rows compared in a batch, and of these alone (a compiled model sees copies of the row)
COMPANY = 16  # rows put before those of the local search, which move them to other neighbours


class IndependentSamples(Check):
    """Compares each of the four calls on single rows, on a shuffled batch, and among other rows."""

    name = "independent_samples"
    title = "a sample's torque depends on that sample alone"
    meaning = "A model whose answer depends on its neighbours in a batch, or on chance, is no function of the motion."
    justification = "Batched and single calls may round differently, a thousand roundings at most."
    stays_because = "other checks compare calls on batches too and fail for the wrong reason; this one names the cause"

    def limit(self, subject: Subject) -> float:
        return subject.at_least_rounding(1e-9)

    def find(self, subject: Subject) -> Finding:
        q, v, a = subject.random(SAMPLES, salt=4)
        order = np.random.default_rng(subject.seed).permutation(SAMPLES)
        missed = np.zeros(SAMPLES)
        for name, arrays, scale in self._calls(subject, q, v, a):
            batch = np.empty_like(first := subject.call(name, *arrays))
            batch[order] = subject.call(name, *(array[order] for array in arrays))
            alone = np.stack([subject.call(name, *(x[k : k + 1] for x in arrays))[0] for k in range(ALONE)])
            missed = np.maximum(missed, self._size(batch - first, scale))
            missed[:ALONE] = np.maximum(missed[:ALONE], self._size(alone - first[:ALONE], scale))
        k = int(np.argmax(missed))
        value, where = float(missed[k]), {"q": q[k].tolist(), "v": v[k].tolist(), "a": a[k].tolist()}
        company = subject.random(COMPANY, salt=15)
        worst, place = worst_configuration(subject, "qva", lambda *x: self._in_company(subject, x, company))
        if worst.value > value:
            value, where = worst.value, place
        return Finding(value, where, "the same sample alone or among others differs by a share of its torque")

    def _in_company(
        self, subject: Subject, motion: tuple[np.ndarray, ...], company: tuple[np.ndarray, ...]
    ) -> np.ndarray:
        """What other rows in the batch change, shape (n,)."""
        together = [np.concatenate([others, own]) for others, own in zip(company, motion, strict=True)]
        calls = zip(self._calls(subject, *motion), self._calls(subject, *together), strict=True)
        return np.max(
            [
                self._size(subject.call(name, *crowd)[COMPANY:] - subject.call(name, *own), scale)
                for (name, own, scale), (_, crowd, _) in calls
            ],
            axis=0,
        )

    @staticmethod
    def _calls(subject: Subject, q: np.ndarray, v: np.ndarray, a: np.ndarray):
        tau, inertia = subject.torque_scale, subject.inertia_scale
        yield "inverse_dynamics", (q, v, a), tau
        yield "mass_matrix", (q,), np.sqrt(np.outer(inertia, inertia))
        yield "coriolis_torque", (q, v), tau
        yield "gravity_torque", (q,), tau

    @staticmethod
    def _size(difference: np.ndarray, scale: np.ndarray) -> np.ndarray:
        return np.abs(difference / scale).reshape(len(difference), -1).max(axis=1)
