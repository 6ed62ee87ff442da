"""Models far from the arm: is the correction ever worse than plain least squares, and is a name ever wrong?

python -m validation.far_models.study [--plants 60] [--first 0] [--quick] [--out FILE]
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from lagnet.diagnosis.diagnose import Diagnosis, diagnose
from lagnet.rigid_body.robot import Robot
from validation.far_models.plant_by_plant import run
from validation.far_models.plants import FarPlant, draw
from validation.real_arms.least_squares import LeastSquares

HERE = Path(__file__).resolve().parent
FULL = 60
LAYERS = ("nominal", "named", "identified", "full")
TOLD = ("kind", "friction", "worse", "wrong_names", "seconds")  # of each plant, as it is done
WORSE = 1.1  # times the error of least squares
FLOOR = 1e-4  # of a joint's variance, the power of the noise that was put in: below it, nothing is worse
TRUE = {
    "coulomb_friction", "asymmetric_friction", "viscous_friction", "rotor_inertia", "torque_offset", "link_inertia",
    "payload",
}  # fmt: skip


def study(plant: FarPlant) -> dict[str, Any]:
    """Held-out nMSE by joint of every layer and of least squares on the same samples, names and times."""
    begun = time.process_time()
    result = diagnose([plant.record(1), plant.record(2)], plant.nominal, [plant.record(3)])
    seconds = time.process_time() - begun
    with threadpool_limits(1):
        begun = time.process_time()
        squares = least_squares_error(plant.nominal, result)
        of_squares = time.process_time() - begun
    layers = {k: [getattr(f, f"nmse_{k}") for f in result.verdict.fit] for k in LAYERS}
    worse = np.array(layers["identified"]) > np.maximum(WORSE * squares, FLOOR)
    return {
        "kind": plant.kind,
        "friction": plant.friction,
        "joints": plant.nominal.n_dof,
        "beside_free_links": result.state.judged is not None,
        **layers,
        "least_squares": squares.tolist(),
        "worse": int(worse.sum()),
        "names": [(e.effect, e.joint, e.status) for e in result.effects],
        "wrong_names": sum(e.effect not in TRUE and not TRUE & {*e.tied_with} for e in result.effects),
        "seconds": round(seconds, 1),
        "seconds_of_least_squares": round(of_squares, 2),
    }


def least_squares_error(nominal: Robot, result: Diagnosis) -> np.ndarray:
    """nMSE (dof,) of plain least squares on the held-out samples."""
    problem = result.state.problem
    fit = LeastSquares(nominal, problem)
    residual = np.concatenate([problem.reduce(p, p.tau - fit.torque(p)) for p in problem.holdout])
    return np.mean(residual**2, axis=0) / problem.unseen_variance


def summary(plants: list[dict[str, Any]]) -> dict[str, Any]:
    """The figures of the pass lines."""
    joints = sum(p["joints"] for p in plants)
    names = sum(len(p["names"]) for p in plants)
    return {
        "plants": len(plants),
        "joints": joints,
        "joints_worse_than_least_squares": sum(p["worse"] for p in plants),
        "names": names,
        "wrong_names": sum(p["wrong_names"] for p in plants),
        "judged_beside_free_links": sum(p["beside_free_links"] for p in plants),
        "median_ratio_to_least_squares": float(
            np.median([i / s for p in plants for i, s in zip(p["identified"], p["least_squares"], strict=True)])
        ),
        "median_seconds": float(np.median([p["seconds"] for p in plants])),
    }


def main() -> int:
    """Run the plants and write the result."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="one plant; writes nothing")
    figures = run(parser, lambda number: study(draw(number)), summary, TOLD, FULL, HERE)
    return int(figures["joints_worse_than_least_squares"] > 0)


if __name__ == "__main__":
    raise SystemExit(main())
