"""argmin_π (π − π̂)ᵀG(π − π̂) + w d(π, π₀) over physically consistent π: the real bodies nearest to fitted ones."""

from __future__ import annotations

import numpy as np
from scipy.stats import chi2

from lagnet.diagnosis.problem.problem import Problem
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.rigid_body.consistent_fit import consistent_path
from lagnet.rigid_body.inertia import (
    from_pseudo_inertia,
    is_physically_consistent,
    parameters_of_body,
    pseudo_inertia,
)
from lagnet.types import inertial_parameters_of

CONSISTENCY = 1e-7  # of the explained error, the least weight of the distance to a prior body
WEIGHTS = 10.0 ** np.arange(4.0, -0.5, -0.5)  # times the least: from near the prior to near the data
REACH = 0.3  # [m] from the last joint, within which a load usually has its centre of mass
WITHIN = float(chi2.ppf(0.95, 10))  # squared error [noise variances] by which data do not distinguish two bodies


def nearest_body(gram: np.ndarray, wanted: np.ndarray, base: np.ndarray) -> np.ndarray:
    """The likeliest real body whose torque is as near to that of the wanted parameters as any's, or several together.

    Of the bodies that data distinguish from the nearest one no better than chance, the closest to the model is taken:
    small moments that noise leaves open would else ask for masses beyond reason. Of wanted parameters that a body can
    have only those move that the data leave open altogether. Where the data leave so much open that the fit has no
    minimum in reach, negative principal values are cut off.

    Args:
        gram: shape (10 k, 10 k), squared error per change of parameters, in variances of the noise.
        wanted: shape (10,) or (k, 10), parameters of the fit.
        base: the same shape, of the modelled bodies that were changed; zeros for a payload.

    Returns:
        Parameters in the shape of the wanted ones.
    """
    prior = np.reshape(
        [_prior(*pair) for pair in zip(base.reshape(-1, 10), wanted.reshape(-1, 10), strict=True)], wanted.shape
    )
    moment = gram @ wanted.ravel()
    least = CONSISTENCY * max(float(wanted.ravel() @ moment), 1e-12)
    try:
        bodies = list(consistent_path(gram, moment, prior, least * WEIGHTS))
        nearest = bodies[-1]
        if np.all(is_physically_consistent(wanted)):
            return nearest
        bound = _lost(gram, nearest - wanted) + WITHIN
        return next((body for body in bodies if _lost(gram, body - wanted) <= bound), nearest)
    except np.linalg.LinAlgError:
        return np.reshape([_cut_off(body) for body in wanted.reshape(-1, 10)], wanted.shape)


def _cut_off(wanted: np.ndarray) -> np.ndarray:
    """The body without negative principal values, shape (10,)."""
    values, vectors = np.linalg.eigh(pseudo_inertia(wanted))
    least = CONSISTENCY * max(float(np.max(np.abs(values))), 1e-9)
    return from_pseudo_inertia((vectors * np.maximum(values, least)) @ vectors.T)


def _lost(gram: np.ndarray, change: np.ndarray) -> float:
    return float(change.ravel() @ gram @ change.ravel())


def body_before(problem: Problem, effect: NamedEffect) -> np.ndarray:
    """Parameters (10,) of the body that an effect changes: none for a payload, else the modelled link."""
    if effect.joint is None or not effect_named(effect.effect).changes_link:
        return np.zeros(10)
    return inertial_parameters_of(problem.nominal)[effect.joint]


def _prior(base: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """A real body near the wanted one: the modelled link made rounder, or a ball of the wanted mass where that is.

    A mass that came out near zero says nothing of a load whose first moment is known: the ball is so heavy that its
    centre lies within reach. Models know the mass of a link better than its shape. Beside a slender link a body of its
    mass and of other moments would be further off than one many times as heavy.
    """
    if is_physically_consistent(base):
        body = pseudo_inertia(base)
        body[:3, :3] += np.trace(body[:3, :3]) / 3.0 * np.eye(3)
        return from_pseudo_inertia(body)
    mass = max(float(wanted[0]), float(np.linalg.norm(wanted[1:4])) / REACH, 1e-3)
    return parameters_of_body(mass, wanted[1:4] / mass, 0.01 * mass * np.eye(3))
