"""ε of a Gaussian process on what the networks leave: length and noise by its evidence, its use by leaving samples out.

Source: Rasmussen and Williams 2006, equations 2.30 (evidence) and 5.12 (a sample that is left out).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.identified.remainder.samples import RemainderSamples
from lagnet.diagnosis.identified.remainder.settings import RemainderSettings
from lagnet.models.corrected.remainder.learned import squared_distances
from lagnet.models.corrected.remainder.process import ProcessRemainder, matern, process_inputs
from lagnet.recordings.sampling import spread_rows

LENGTHS = (0.05, 0.1, 0.2, 0.4, 0.8)  # of the median distance between samples
NOISES = (0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0)  # of the variance of the process
FEWEST = 20  # samples at which a joint moves


@dataclass(frozen=True, eq=False)
class _Fit:
    """The likeliest process of one joint: weights of its samples, and its gain on samples that were left out."""

    evidence: float
    length: float
    noise: float
    weights: np.ndarray
    gain: float


@dataclass(frozen=True, eq=False)
class _Spectrum:
    """K(ℓ) = U diag(λ) Uᵀ: any noise is then a division."""

    length: float
    values: np.ndarray
    vectors: np.ndarray

    def fit(self, y: np.ndarray, noise: float) -> _Fit:
        """The process with this noise over its variance."""
        n, values = len(y), self.values + noise
        rotated = self.vectors.T @ y
        evidence = -0.5 * n * np.log(np.sum(rotated**2 / values) / n) - 0.5 * np.sum(np.log(values))
        weights = self.vectors @ (rotated / values)
        unseen = weights / np.sum(self.vectors**2 / values, axis=1)
        return _Fit(float(evidence), self.length, noise, weights, float(1.0 - np.sum(unseen**2) / np.sum(y**2)))


def fit_process(samples: RemainderSamples, settings: RemainderSettings) -> ProcessRemainder | None:
    """ε of a process; None where no joint's samples are foretold by those around them."""
    inputs = process_inputs(samples.q, samples.v, samples.a)
    moving = np.flatnonzero(samples.counts.any(axis=1))
    rows = moving[spread_rows(len(moving), settings.places)]
    if len(rows) < FEWEST:
        return None
    centre, spread = inputs[rows].mean(axis=0), np.maximum(inputs[rows].std(axis=0), 1e-9)
    anchors, counted, left = (inputs[rows] - centre) / spread, samples.counts[rows], samples.left[rows]
    fits = _fits(np.sqrt(squared_distances(anchors, anchors)), counted, left)
    used = {j: fit for j, fit in fits.items() if fit.gain > settings.gain}
    if not used:
        return None
    n_dof = counted.shape[1]
    weights, length, noise, share = np.zeros((len(rows), n_dof)), np.ones(n_dof), np.ones(n_dof), np.zeros(n_dof)
    for j, fit in used.items():
        weights[counted[:, j], j] = fit.weights
        length[j], noise[j], share[j] = fit.length, fit.noise, 1.0
    return ProcessRemainder(centre, spread, anchors, counted, weights, length, noise, share)


def _fits(distance: np.ndarray, counted: np.ndarray, left: np.ndarray) -> dict[int, _Fit]:
    """The likeliest process of each joint that moves; joints that move together share their spectra."""
    spectra: dict[bytes, list[_Spectrum]] = {}
    out = {}
    for j, moves in enumerate(counted.T):
        y = left[moves, j]
        if len(y) < FEWEST or not y.any():
            continue
        key = moves.tobytes()
        if key not in spectra:
            spectra[key] = _spectra(distance[np.ix_(moves, moves)])
        out[j] = max((s.fit(y, r) for s in spectra[key] for r in NOISES), key=lambda fit: fit.evidence)
    return out


def _spectra(distance: np.ndarray) -> list[_Spectrum]:
    usual = max(float(np.median(distance)), 1e-9)
    found = []
    for length in usual * np.array(LENGTHS):
        values, vectors = np.linalg.eigh(matern(distance / length))
        found.append(_Spectrum(float(length), np.maximum(values, 0.0), vectors))
    return found
