"""Size and training of the learned remainder ε."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class RemainderSettings:
    """Size and training of ε.

    Args:
        members: networks of the ensemble.
        hidden: units of each of two hidden layers.
        steps: of the optimiser, over all samples at once.
        rate: of learning.
        decay: of weights.
        folds: contiguous blocks that are left out in turn.
        gain: least reduction of a joint's held-out squared error by ε, as a share, to be used there.
        most: training samples.
        anchors: samples that describe the extent of the motion that was learned from.
    """

    members: int = 3
    hidden: int = 16
    steps: int = 200
    rate: float = 5e-3
    decay: float = 3e-2
    folds: int = 4
    gain: float = 0.1
    most: int = 1000
    anchors: int = 400
