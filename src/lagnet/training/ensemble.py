"""Several trainings that differ in their seed alone, and the band that held-out torque puts around their mean."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.errors import ModelError
from lagnet.models.ensemble import Band, Ensemble, calibrated
from lagnet.recordings.recording import Recording
from lagnet.recordings.splits import holdout_split
from lagnet.training.samples import TrainingSamples, samples_of
from lagnet.training.train import TrainResult, train


@dataclass(frozen=True)
class EnsembleResult:
    """A trained ensemble, and the training of each member.

    Args:
        model: the ensemble; trainings: one a seed.
    """

    model: Ensemble
    trainings: tuple[TrainResult, ...]


def train_ensemble(
    recordings: Sequence[Recording],
    model: str = "delan",
    seeds: Sequence[int] = (0, 1, 2, 3, 4),
    holdout: Sequence[Recording] | None = None,
    coverage: float = 0.95,
    **given: Any,
) -> EnsembleResult:
    """Learn the dynamics of an arm several times over.

    The held-out samples stop each training and set the width of the band, so the band is a little narrow for motion
    unlike theirs; where it must hold, check it on recordings that took no part.

    Args:
        recordings: motion and torque.
        model: kind of model, a name in `lagnet.models.kinds.KINDS`.
        seeds: one a member, two or more.
        holdout: recordings to judge by and to set the band by; None for the last fifth of each of `recordings`.
        coverage: share of held-out torque samples that the band holds on each joint.
        given: further arguments of `lagnet.train`.

    Raises:
        ModelError: fewer than two different seeds, or what `lagnet.train` refuses.
    """
    if len(set(seeds)) != len(seeds) or len(seeds) < 2:
        raise ModelError(f"seeds {list(seeds)} make no ensemble", next_step="give two or more different ones")
    seen, unseen = (recordings, holdout) if holdout else holdout_split(recordings)
    trainings = tuple(train(seen, model, seed=seed, holdout=unseen, **given) for seed in seeds)
    members = [training.model for training in trainings]
    return EnsembleResult(Ensemble(members, _band(members, samples_of(unseen), coverage)), trainings)


def _band(members: Sequence[Any], samples: TrainingSamples, coverage: float) -> Band:
    torque = np.stack([m.inverse_dynamics(samples.q, samples.v, samples.a) for m in members])
    return calibrated(samples.tau - torque.mean(axis=0), torque.std(axis=0, ddof=1), coverage)
