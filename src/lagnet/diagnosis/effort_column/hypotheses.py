"""What a column of effort may hold, and the fit of each joint's column under each hypothesis."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from lagnet.diagnosis.effort_column.regressions import Fit, fit
from lagnet.diagnosis.effort_column.samples import EffortSamples

DRIVE = ("rotor", "viscous", "coulomb")
HYPOTHESES = {
    "torque": ("gravity", "dynamic", *DRIVE),
    "torque without gravity": ("dynamic", *DRIVE),
    "link-side torque": ("gravity", "dynamic"),
    "link-side torque without gravity": ("dynamic",),
}
COPIES = {"position": "q", "velocity": "viscous"}
ERROR = "position error"
MOVING = 1e-9  # spread of a column over its size, below which it is constant


@dataclass(frozen=True)
class HypothesisFits:
    """Fits of the joints whose column changes, each made when it is first asked for.

    Args:
        samples: the column beside the model's torques.
        magnitude: the column is the size of a torque, without its sign.
    """

    samples: EffortSamples
    magnitude: bool = False
    _found: dict[tuple[int, str], Fit] = field(default_factory=dict)

    @property
    def alive(self) -> list[int]:
        """Joints whose column changes."""
        y = self.samples.y
        size = np.max(np.abs(y), axis=0)
        return [j for j in range(self.samples.n_dof) if np.std(y[:, j]) > MOVING * max(size[j], 1e-12)]

    def of(self, joint: int, name: str) -> Fit:
        """The fit of one joint under a hypothesis, as a copy, or as the position error."""
        key = (joint, name)
        if key not in self._found:
            terms = HYPOTHESES.get(name) or (COPIES.get(name, "error"),)
            self._found[key] = fit(self.samples, joint, terms, self.magnitude and name in HYPOTHESES)
        return self._found[key]

    def mean(self, name: str) -> float:
        """Share of the column that is predicted in stretches left out, mean over the joints."""
        return float(np.mean([max(self.of(j, name).explained, -1.0) for j in self.alive]))

    def gains(self, name: str) -> list[float]:
        """Factor of the only term of a copy or of the position error, at each joint that has one."""
        fits = [self.of(j, name) for j in self.alive]
        return [float(found.value[0]) for found in fits if found.value.size]
