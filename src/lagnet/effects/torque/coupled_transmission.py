"""Coupled transmission: a motor that turns with two joints, and whose friction and rotor both of them feel."""

from collections.abc import Mapping, Sequence
from typing import final

import numpy as np
from scipy.optimize import minimize_scalar

from lagnet.effects.effect import Effect, Parameter, Values
from lagnet.effects.excitation import needs_both_directions
from lagnet.effects.motion import Motion

TURNS = "what the motor turns with the joint before, over its own"
PLAIN = (1.0, -1.0)  # ratios of most wrists, that are tried without a residual
STEEPEST = 10.0  # either motor or joint turns so many times as fast
STEPS = 24  # ratios of one sign that a residual is asked for
BETTER = 0.1  # of what plain ratios leave at both joints, that another one must explain to be proposed


@final
class CoupledTransmission(Effect):
    """The motor of a wrist joint also turns with the joint before it: with w = v_j + c v_(j−1), both feel its drag.

    Power balance gives the share of each joint: r_j = Fv w + Fc s(w) + Ia dw/dt, and r_(j−1) = c r_j.
    """

    name = "coupled_transmission"
    title = "Coupled transmission"
    formula = "Fv w + Fc s(w) + Ia dw/dt, and c times that on the joint before, w = v_j + c v_(j−1)"
    parameters = (
        Parameter("Fv", "F_v", "N m s/rad", "viscous friction of the coupled motor", lower=0.0),
        Parameter("Fc", "F_c", "N m", "dry friction of the coupled motor", lower=0.0),
        Parameter("Ia", "I_a", "kg m²", "rotor inertia of the coupled motor", lower=0.0),
        Parameter("ratio", "c", "–", TURNS, -STEEPEST, STEEPEST, formerly="sense"),
    )
    reaches_all = True
    nonnegative = True  # viscous drag, dry friction and rotor may be absent one by one; none gives energy
    absent = (("Fv", 0.0), ("Fc", 0.0), ("Ia", 0.0))
    shown_by = "both joints of the pair moving in both directions, together and against each other"
    confused_with = ("viscous_friction", "coulomb_friction", "rotor_inertia")
    source = "gautier1990"

    def shapes(self, motion: Motion, joint: int) -> Sequence[Values]:
        return tuple({"ratio": ratio} for ratio in PLAIN)

    def proposals(self, motion: Motion, joint: int, residual: np.ndarray) -> Sequence[Values]:
        if not self.exists_at(joint) or self.excitation(motion, joint):
            return ()
        left = _Left(self, motion, joint, residual)
        sizes = np.geomspace(1.0 / STEEPEST, STEEPEST, STEPS)
        ratios = np.concatenate([-sizes[::-1], sizes])
        found = [left(ratio) for ratio in ratios]
        best = int(np.argmin(found))
        ends = sorted((ratios[best] * sizes[0] / sizes[1], ratios[best] * sizes[1] / sizes[0]))
        finest = minimize_scalar(left, bounds=ends, method="bounded")
        enough = finest.fun < (1.0 - BETTER) * min(left(ratio) for ratio in PLAIN)
        return ({"ratio": float(finest.x)},) if enough else ()

    def special_case(self, shape: Mapping[str, float]) -> Values | None:
        ratio = float(shape["ratio"])
        return None if ratio in PLAIN else {"ratio": float(np.copysign(1.0, ratio))}

    def columns(self, motion: Motion, joint: int, shape: Mapping[str, float]) -> np.ndarray:
        ratio = shape["ratio"]
        speed = motion.v[:, joint] + ratio * motion.v[:, joint - 1]
        blur = float(np.hypot(motion.slow[joint], ratio * motion.slow[joint - 1]))
        own = np.column_stack([speed, np.tanh(speed / blur), motion.a[:, joint] + ratio * motion.a[:, joint - 1]])
        out = np.zeros((motion.time.size, motion.n_dof, 3))
        out[:, joint], out[:, joint - 1] = own, ratio * own
        return out

    def bounds(self, shape: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        return np.zeros(3), np.full(3, np.inf)

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        viscous, dry, rotor = map(float, coefficients)
        return {"Fv": viscous, "Fc": dry, "Ia": rotor, "ratio": float(shape["ratio"])}

    def torque(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        return self.columns(motion, joint, values) @ np.array([values["Fv"], values["Fc"], values["Ia"]])

    def chosen(self, values: Mapping[str, float]) -> np.ndarray:
        return np.array([False, False, False, self.special_case(values) is None])

    def plausible(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> bool:
        return bool(coefficients[1] > 0.0 and np.all(coefficients >= 0.0))  # every motor has dry friction

    def exists_at(self, joint: int | None) -> bool:
        return joint != 0  # no joint is before the first

    def excitation(self, motion: Motion, joint: int) -> str | None:
        return needs_both_directions(motion, joint) or needs_both_directions(motion, joint - 1)


def _own_terms(motion: Motion, joint: int) -> np.ndarray:
    v = motion.v[:, joint]
    return np.column_stack([v, np.tanh(v / motion.slow[joint]), motion.a[:, joint], np.ones(v.size)])


class _Left:
    """Share of the residual of two joints that a ratio leaves beside each joint's own friction, rotor and offset."""

    def __init__(self, effect: CoupledTransmission, motion: Motion, joint: int, residual: np.ndarray):
        self.effect, self.motion, self.pair = effect, motion, (joint, joint - 1)
        self.own = [np.linalg.qr(_own_terms(motion, j))[0] for j in self.pair]
        self.sizes = [max(float(np.sqrt(np.mean(residual[:, j] ** 2))), 1e-300) for j in self.pair]
        self.rest = np.concatenate([self._beside(k, residual[:, j]) for k, j in enumerate(self.pair)])

    def _beside(self, k: int, x: np.ndarray) -> np.ndarray:
        return (x - self.own[k] @ (self.own[k].T @ x)) / self.sizes[k]

    def __call__(self, ratio: float) -> float:
        both = self.effect.columns(self.motion, self.pair[0], {"ratio": float(ratio)})
        columns = np.concatenate([self._beside(k, both[:, j]) for k, j in enumerate(self.pair)])
        fitted, *_ = np.linalg.lstsq(columns, self.rest, rcond=1e-10)
        return float(np.mean((self.rest - columns @ fitted) ** 2))
