"""From torque samples to an arm, with no kinematics given.

1. The directions of the joint axes, by the relaxed problem from random starts (`search`).
2. Lengths and gravity, by the full problem from there.
3. All constants on all training samples, joints weighed by the noise that their residual shows.
4. Links that can exist; kept unless held-out torque says that no such links explain it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import jax
import numpy as np

from lagnet.errors import ModelError
from lagnet.models.serial_chain.identification.determinacy import Determinacy, determinacy
from lagnet.models.serial_chain.identification.held_out import (
    Data,
    as_good,
    held_out_share,
    residual,
    sizes,
    split_samples,
)
from lagnet.models.serial_chain.identification.refit import Refit, Refitted
from lagnet.models.serial_chain.identification.search import search_axes, search_lengths
from lagnet.models.serial_chain.identification.separable import Samples, make_samples
from lagnet.models.serial_chain.identification.unknowns import Unknowns, normalise_gravity
from lagnet.models.serial_chain.mechanics.kinematics import revolute_mask
from lagnet.models.serial_chain.settings import SLOW, SerialChainSettings

PRECISION = 1e-7  # of a joint's torque: noise below this is not told from rounding, and weighs no more
NO_TERM = 1e-9  # share of the torque that no joint term is asked for: a few steps more would bring links there


@dataclass(frozen=True, eq=False)
class SerialChainFit:
    """An arm found from torque, and how sure one may be of it.

    Args:
        unknowns: joints, their terms and the speeds of Coulomb friction.
        x: shape constants; moments: shape (dof, 10); coefficients: shape (terms, dof).
        physical: whether the links can exist; if not, `physical_nmse` says what such links would leave.
        nmse: shape (dof,), residual over variance of held-out torque.
        physical_nmse: the same for the physical refit.
        noise: shape (dof,), standard deviation of the training residual [N m].
        axes_costs, lengths_costs: share of torque left by each start of the two searches, best first.
        determinacy: which constants the motion determines.
    """

    unknowns: Unknowns
    x: np.ndarray
    moments: np.ndarray
    coefficients: np.ndarray
    physical: bool
    nmse: np.ndarray
    physical_nmse: np.ndarray
    noise: np.ndarray
    axes_costs: np.ndarray
    lengths_costs: np.ndarray
    determinacy: Determinacy


@dataclass(frozen=True)
class _Candidate:
    free: Refitted
    noise: np.ndarray
    axes: np.ndarray
    lengths: np.ndarray


def fit_serial_chain(
    q: np.ndarray,
    v: np.ndarray,
    a: np.ndarray,
    tau: np.ndarray,
    joint_types: Sequence[str],
    seed: int = 0,
    settings: SerialChainSettings | None = None,
) -> SerialChainFit:
    """Find a serial arm that gives these torques.

    Args:
        q, v, a: shape (n, dof), motion [rad, rad/s, rad/s²] ([m …] for prismatic joints).
        tau: shape (n, dof), torque [N m] ([N]).
        joint_types: 'revolute', 'continuous' or 'prismatic' for each joint.
        seed: of the random starts and of the split.
        settings: what to fit and how.

    Raises:
        ModelError: arrays that do not fit each other, too few samples, unknown joint types or terms.
    """
    settings = settings or SerialChainSettings()
    unknowns = _unknowns(v, joint_types, settings)
    motion = tuple(np.asarray(part, dtype=float) for part in (q, v, a, tau))
    _check(motion, unknowns)
    rng = np.random.default_rng(seed)
    data = split_samples(motion, settings.holdout, rng)
    with jax.enable_x64(True):
        refit = Refit(unknowns)
        candidates = _candidates(unknowns, data, rng, settings, refit)
        scores = [held_out_share(unknowns, data, candidate.free) for candidate in candidates]
        best = candidates[int(np.argmin([np.mean(score) for score in scores]))]
        return _simplest(unknowns, data, best, refit)


def _unknowns(v: np.ndarray, joint_types: Sequence[str], settings: SerialChainSettings) -> Unknowns:
    speed = np.sqrt(np.mean(np.square(v), axis=0))
    slow = tuple(float(s) for s in SLOW * np.where(speed > 0, speed, 1.0))
    return Unknowns(revolute_mask(joint_types), settings.joint_terms, slow)


def _check(motion: tuple[np.ndarray, ...], unknowns: Unknowns) -> None:
    shape = motion[0].shape
    if any(part.shape != shape for part in motion) or len(shape) != 2 or shape[1] != unknowns.n_dof:
        found = ", ".join(str(part.shape) for part in motion)
        raise ModelError(f"q, v, a, tau have shapes {found}, expected (n, {unknowns.n_dof}) for each")
    if not all(np.all(np.isfinite(part)) for part in motion):
        raise ModelError("motion or torque holds values that are not finite")
    least = _least_samples(unknowns)
    if shape[0] < least:
        raise ModelError(
            f"{shape[0]} samples are too few for a serial chain of {unknowns.n_dof} joints",
            next_step=f"give at least {least}",
        )


def _least_samples(unknowns: Unknowns) -> int:
    """Twice as many torques as unknowns of the relaxed problem, after the held-out share."""
    linear = unknowns.relaxed_size + len(unknowns.joint_terms) * unknowns.n_dof
    return int(np.ceil(2.5 * (linear + unknowns.n_angles) / unknowns.n_dof)) + 10


def _candidates(
    unknowns: Unknowns, data: Data, rng: np.random.Generator, settings: SerialChainSettings, refit: Refit
) -> list[_Candidate]:
    """Arms that the search ends at, each refitted on all training samples."""
    size = sizes(data.train[3])
    rows = slice(0, max(200, int(np.ceil(12 * unknowns.relaxed_size / unknowns.n_dof))))
    few = make_samples(*(part[rows] for part in data.train), noise=size)
    axes = search_axes(unknowns, few, rng, settings.search)
    exact = axes.cost[0] < settings.search.exact
    out = []
    for index in axes.distinct(1 if exact else settings.candidates):
        lengths = search_lengths(unknowns, few, axes.x[index], axes.linear[index], rng, settings.search)
        free, noise = _refit_with_noise(data, lengths.x[0], lengths.linear[0], size, settings.reweighings, refit)
        out.append(_Candidate(free, noise, axes.cost, lengths.cost))
    return out


def _refit_with_noise(
    data: Data, x: np.ndarray, w: np.ndarray, size: np.ndarray, rounds: int, refit: Refit
) -> tuple[Refitted, np.ndarray]:
    """Free refit, joints weighed by 1 / noise as their residual shows it."""
    noise, links = size, 10 * refit.unknowns.n_dof
    x, moments = normalise_gravity(refit.unknowns, x, w[:links].reshape(-1, 10))  # lengths and masses of ordinary size
    w = np.concatenate([moments.ravel(), w[links:]])
    found = refit.free(make_samples(*data.train, noise=noise), x, w)
    for _ in range(rounds):
        noise = np.maximum(residual(refit.unknowns, data.train, found).std(axis=0), PRECISION * size)
        if np.all(noise == PRECISION * size):
            noise = size
            break
        found = refit.free(make_samples(*data.train, noise=noise), found.x, found.w)
    return found, noise


def _simplest(unknowns: Unknowns, data: Data, best: _Candidate, refit: Refit) -> SerialChainFit:
    """The arm without its joint terms where held-out torque does not ask for them, else with them."""
    if unknowns.joint_terms:
        rigid = replace(unknowns, joint_terms=())
        alone = Refit(rigid)
        samples = make_samples(*data.train, noise=best.noise)
        free = alone.free(samples, best.free.x, best.free.w[: 10 * unknowns.n_dof])
        if as_good(held_out_share(rigid, data, free), held_out_share(unknowns, data, best.free), NO_TERM):
            return _finish(rigid, data, replace(best, free=free), alone)
    return _finish(unknowns, data, best, refit)


def _finish(unknowns: Unknowns, data: Data, best: _Candidate, refit: Refit) -> SerialChainFit:
    """Ask for links that can exist, and keep them unless held-out torque denies them."""
    samples: Samples = make_samples(*data.train, noise=best.noise)
    physical = refit.physical(samples, best.free)
    free_score, physical_score = held_out_share(unknowns, data, best.free), held_out_share(unknowns, data, physical)
    fine = as_good(physical_score, free_score)
    chosen = physical if fine else best.free
    links = 10 * unknowns.n_dof
    known = determinacy(chosen.sums.gram, unknowns.n_dof, len(unknowns.joint_terms))
    x, moments = normalise_gravity(unknowns, chosen.x, chosen.w[:links].reshape(-1, 10))
    return SerialChainFit(
        unknowns=unknowns,
        x=x,
        moments=moments,
        coefficients=chosen.w[links:].reshape(-1, unknowns.n_dof),
        physical=fine,
        nmse=physical_score if fine else free_score,
        physical_nmse=physical_score,
        noise=residual(unknowns, data.train, chosen).std(axis=0),
        axes_costs=best.axes,
        lengths_costs=best.lengths,
        determinacy=known,
    )
