"""A nominal model where there is only a log of the simulator: the arm is learned from the simulated recordings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.models.serial_chain.settings import SearchSettings, SerialChainSettings
from lagnet.recordings.recording import Recording
from lagnet.recordings.sampling import spread_rows
from lagnet.recordings.splits import holdout_split

EXACT = 1e-3  # held-out share of the torque variance up to which a serial chain is taken to be the simulator's arm
RIGID = 1e-4  # the same share, up to which nothing but links is asked for
MOST_SAMPLES = 2_000  # that a serial chain is searched with
MOVING = 0.2  # of a joint's root mean square speed: slower samples lie in the reversal of its friction
TERMS = ("rotor_inertia", "viscous_friction", "coulomb_friction")  # what simulators let a joint have
FEW_STARTS = SearchSettings(least_starts=8, most_starts=16)
MINUTES = 2.0  # for a network, where the simulator holds more than rigid bodies


@dataclass(frozen=True, eq=False)
class LearnedNominal:
    """A model of the simulator, and how far it can be trusted.

    Args:
        model: answers the calls of InverseDynamics.
        kind: "serial-chain" or "delan".
        error: shape (dof,), root mean square of the torque that it misses on held-out simulated motion [N m]; it counts
            as noise in the diagnosis, so that the model's ignorance is never called physics.
        share: shape (dof,), the same as a share of the torque's variance.
    """

    model: Any
    kind: str
    error: np.ndarray
    share: np.ndarray


def learn_nominal(
    simulated: Sequence[Recording], joint_types: tuple[str, ...] | None = None, seed: int = 0
) -> LearnedNominal:
    """Learns the simulator's arm: a serial chain where one fits, else a Lagrangian network.

    Links alone are tried first, then joints that also have friction and rotors, as most simulators can give them.

    Args:
        simulated: recordings of the simulator, of the joints of the real arm.
        joint_types: of each joint; None to find them from the motion.
        seed: of the search and the training.
    """
    from lagnet.training.train import train

    seen, unseen = holdout_split(simulated)
    chain, error, share = _best_chain(seen, unseen, joint_types, seed)
    if np.max(share) < EXACT:
        return LearnedNominal(chain, "serial-chain", error, share)
    network = train(seen, "delan", seed=seed, holdout=unseen, joint_types=joint_types, minutes=MINUTES).model
    other, other_share = _held_out(network, unseen)
    if np.mean(other_share) < np.mean(share):
        return LearnedNominal(network, "delan", other, other_share)
    return LearnedNominal(chain, "serial-chain", error, share)


def _best_chain(
    seen: Sequence[Recording], unseen: Sequence[Recording], joint_types: tuple[str, ...] | None, seed: int
) -> tuple[Any, np.ndarray, np.ndarray]:
    """The chain that misses least, with the error and its share: links alone where they do."""
    kinds = (SerialChainSettings(search=FEW_STARTS, candidates=1), SerialChainSettings(joint_terms=TERMS))
    tried = []
    for settings in kinds:
        chain = _chain(seen, joint_types, seed, settings)
        tried.append((chain, *_held_out(chain, unseen)))
        if np.max(tried[-1][2]) < RIGID:
            break
    return min(tried, key=lambda found: float(np.mean(found[2])))


def _chain(
    seen: Sequence[Recording], joint_types: tuple[str, ...] | None, seed: int, settings: SerialChainSettings
) -> Any:
    """A serial chain from samples spread over the recordings: its search pays for every sample, and needs few.

    Slow samples determine the links best, since derivatives are small there, but lie where dry friction changes sign.
    """
    from lagnet.models.features import guess_joint_types
    from lagnet.models.serial_chain.model import learn_serial_chain
    from lagnet.models.serial_chain.reversals import sharpen_reversals
    from lagnet.training.samples import samples_of

    samples = samples_of(seen)
    rows = _spread(_moving(samples.v) if settings.joint_terms else np.arange(len(samples)))
    q, v, a, tau = (x[rows] for x in (samples.q, samples.v, samples.a, samples.tau))
    types = joint_types or guess_joint_types(samples.q)
    chain = learn_serial_chain(q, v, a, tau, samples.joints, types, seed, settings)[0]
    return sharpen_reversals(chain, samples.q, samples.v, samples.a, samples.tau)


def _moving(v: np.ndarray) -> np.ndarray:
    """Rows at which every joint moves; all where such are too few."""
    rows = np.flatnonzero(np.all(np.abs(v) > MOVING * np.sqrt(np.mean(v**2, axis=0)), axis=1))
    return rows if rows.size >= MOST_SAMPLES // 2 else np.arange(len(v))


def _spread(rows: np.ndarray) -> np.ndarray:
    """At most so many of the rows, from all over them."""
    return rows[spread_rows(rows.size, MOST_SAMPLES)]


def _held_out(model: Any, unseen: Sequence[Recording]) -> tuple[np.ndarray, np.ndarray]:
    """Root mean square error and its share of the torque's variance on held-out simulated motion."""
    from lagnet.diagnosis.problem.problem import pose_problem
    from lagnet.recordings.conditioning.condition import condition

    conditioned = condition(unseen)
    problem = pose_problem(model, conditioned, conditioned)
    residual = np.concatenate([problem.residual(p) for p in problem.fit])
    torque = np.concatenate([problem.reduce(p, p.tau) for p in problem.fit])
    error = np.sqrt(np.mean(residual**2, axis=0))
    return error, error**2 / np.maximum(np.var(torque, axis=0), 1e-18)
