"""How a model is trained, with the values that measurement found best as defaults."""

from __future__ import annotations

from dataclasses import dataclass

from lagnet.errors import ModelError

OPTIMISERS = ("soap", "adam", "muon")
SEPARATIONS = ("joint", "stages")
PENALTIES = (1e-4, 1e-2, 1.0)  # λ that are tried when none is given


@dataclass(frozen=True)
class TrainingSettings:
    """Length, steps and stopping of one training.

    Args:
        steps: gradient steps; the learning rate falls along a cosine over all of them.
        minutes: wall-clock limit; the cosine is shortened to end there. None: no limit.
        batch: samples a step.
        learning_rate: largest step; None for what suits the optimiser.
        optimiser: "soap", "adam" or "muon".
        warm_up: steps over which the learning rate rises.
        patience: share of all steps without a better held-out error after which training stops.
        weight_decay: rate at which weights of perceptrons shrink per unit of learning rate; 0 for plenty of data.
        penalty: λ of eq. 12; None to choose among PENALTIES by held-out torque, or for none in stages.
        separation: "stages" trains mechanics alone, then ε alone on what it left, so that ε can take nothing that
            mechanics can give; "joint" trains both together under λ.
    """

    steps: int = 6000
    minutes: float | None = None
    batch: int = 512
    learning_rate: float | None = None
    optimiser: str = "soap"
    warm_up: int = 100
    patience: float = 0.5
    weight_decay: float = 0.0
    penalty: float | None = None
    separation: str = "stages"

    def __post_init__(self) -> None:
        if self.optimiser not in OPTIMISERS:
            raise ModelError(f"optimiser {self.optimiser!r} is unknown", choices=OPTIMISERS)
        if self.separation not in SEPARATIONS:
            raise ModelError(f"separation {self.separation!r} is unknown", choices=SEPARATIONS)
        if self.steps < 1 or self.batch < 1:
            raise ModelError(f"steps ({self.steps}) and batch ({self.batch}) must be at least 1")
        if self.minutes is not None and not self.minutes > 0:
            raise ModelError(f"minutes is {self.minutes}, expected more than 0")
        if not self.weight_decay >= 0:
            raise ModelError(f"weight_decay is {self.weight_decay}, expected at least 0")
        if self.penalty is not None and self.penalty < 0:
            raise ModelError(f"penalty is {self.penalty}, expected at least 0")

    @property
    def peak(self) -> float:
        """The largest learning rate."""
        return self.learning_rate or {"soap": 1e-2, "adam": 3e-3, "muon": 1e-2}[self.optimiser]
