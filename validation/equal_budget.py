"""Models trained side by side on the same data, the same batch and the same processor time.

A budget in seconds would make results depend on what else the machine does. So the processor time of a step was
measured once for every model, and the budget is spent as a number of steps; what each training really took stands in
the results.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from lagnet.models.kinds import AugmentedSettings
from lagnet.models.lagrangians.black_box_lagrangian import BlackBoxSettings
from lagnet.recordings.recording import Recording
from lagnet.training.settings import TrainingSettings
from lagnet.training.train import TrainResult, train

BATCH = 256
CHUNK = 100  # steps compiled together
MILLISECONDS = {  # processor time of a step: one core, this batch, single precision, six or seven joints
    "delan": 3.0,
    "delan-ffnn": 4.4,  # both together
    "delan-perceptron": 6.0,
    "delan-blackbox": 2.9,
    "ffnn": 1.4,
}
SETTINGS: dict[str, Any] = {  # sizes where they are not the default; perceptrons have two layers of 128 elsewhere
    "delan-blackbox": BlackBoxSettings(hidden=(64, 64)),
    "delan-ffnn": AugmentedSettings(),
}


@dataclass(frozen=True)
class Trained:
    """A training and the processor seconds it took, compilation included."""

    result: TrainResult
    cpu_seconds: float


def steps_for(kind: str, seconds: float, separation: str = "joint") -> int:
    """Steps that a model takes in some processor seconds, compilation aside.

    In stages the budget is that of mechanics, which take as many steps as DeLaN; ε, a regression on torque computed
    once, comes on top with at most as many steps of FFNN's, half the time of theirs.
    """
    kind = "delan" if kind == "delan-ffnn" and separation == "stages" else kind
    return max(1, round(1e3 * seconds / MILLISECONDS[kind] / CHUNK)) * CHUNK


def trained(
    recordings: Sequence[Recording], kind: str, seconds: float, training: TrainingSettings, **given: Any
) -> Trained:
    """Train one model for its share of the budget.

    Args:
        recordings: to train on.
        kind: of model; seconds: processor time of its steps.
        training: all else but steps and batch.
        given: further arguments of `lagnet.training.train.train`.
    """
    began = time.process_time()
    planned = replace(training, steps=steps_for(kind, seconds, training.separation), batch=BATCH)
    given = {"settings": SETTINGS.get(kind), **given}
    return Trained(train(recordings, kind, training=planned, **given), round(time.process_time() - began, 1))
