"""Size and training of the learned remainder ε."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class RemainderSettings:
    """Size and training of ε.

    Args:
        members: networks of a joint's committee; each leaves one contiguous block of the motion out.
        hidden: units of each of two hidden layers.
        steps: of the optimiser, over all samples at once.
        rate: of learning.
        decay: of weights.
        gain: least reduction of a joint's held-out squared error by a part of ε, as a share, for it to be used there.
        most: training samples of the networks.
        anchors: samples that describe the extent of the motion that the networks learned from.
        places: training samples of the Gaussian process.
    """

    members: int = 8
    hidden: int = 16
    steps: int = 200
    rate: float = 2e-2
    decay: float = 1e-2
    gain: float = 0.1
    most: int = 500
    anchors: int = 200
    places: int = 300
