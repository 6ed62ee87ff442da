"""The serial chain as one more kind to train: no gradient steps, but a search over geometry."""

from __future__ import annotations

from typing import Any

from lagnet.models.learned_model import LearnedModel
from lagnet.training.samples import TrainingSamples

KIND = "serial-chain"


def fit_chain(samples: TrainingSamples, joint_types: tuple[str, ...], seed: int, settings: Any) -> LearnedModel:
    """Find the arm that gives the recorded torque.

    Args:
        samples: motion and torque.
        joint_types: 'continuous', 'revolute' or 'prismatic' for each joint.
        seed: of the random starts.
        settings: SerialChainSettings.

    Raises:
        ModelError: the samples do not allow the search.
    """
    from lagnet.models.serial_chain.model import learn_serial_chain

    chain, _ = learn_serial_chain(
        samples.q, samples.v, samples.a, samples.tau, samples.joints, joint_types, seed, settings
    )
    return chain.learned
