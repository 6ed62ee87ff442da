"""AᵀA x = Aᵀy of each joint: sums over rows of the identified layer's equations; a difference leaves rows out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.identified.design import Design

LEAST_ERROR = 1e-12  # of the power of the target


@dataclass(frozen=True, eq=False)
class JointEquations:
    """AᵀA x = Aᵀy of one joint: gram (p, p), moment (p,), power |y|² and number of samples."""

    gram: np.ndarray
    moment: np.ndarray
    power: float
    n_samples: float

    def __sub__(self, other: JointEquations) -> JointEquations:
        return JointEquations(
            self.gram - other.gram,
            self.moment - other.moment,
            self.power - other.power,
            self.n_samples - other.n_samples,
        )

    def error(self, x: np.ndarray) -> float:
        """|y − A x|², at least rounding."""
        return max(self.power - 2.0 * float(x @ self.moment) + float(x @ self.gram @ x), LEAST_ERROR * self.power)


def joint_equations(design: Design, rows: np.ndarray | slice = slice(None)) -> tuple[JointEquations, ...]:
    """Normal equations of each joint over some rows, without samples at rest."""
    out = []
    for joint in design.joints:
        keep = joint.valid[rows]
        a, y = joint.columns[rows][keep], joint.target[rows][keep]
        out.append(JointEquations(a.T @ a, a.T @ y, float(y @ y), float(keep.sum())))
    return tuple(out)
