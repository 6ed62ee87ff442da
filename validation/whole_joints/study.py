"""Arms of which the model knows hardly anything: is the correction worse than least squares, and is a name wrong?

python -m validation.whole_joints.study [--plants 24] [--first 0] [--quick] [--out FILE]
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.verdict.verdict import EffectFound
from lagnet.errors import DiagnosisError
from validation.far_models.plant_by_plant import run
from validation.far_models.study import least_squares_error
from validation.whole_joints.plants import WholeJoints, draw

HERE = Path(__file__).resolve().parent
FULL = 24
LAYERS = ("nominal", "named", "identified", "full")
TOLD = ("joints", "worse", "wrong_names", "seconds")  # of each plant, as it is done
REFUSED = {"worse": 0, "names": [], "wrong_names": [], "seconds": None}
WORSE = 1.1  # times the error of least squares
FRICTION = {
    "coulomb_friction", "asymmetric_friction", "stribeck_friction", "viscous_friction", "load_dependent_friction",
}  # fmt: skip
TRUE = FRICTION | {"torque_offset", "rotor_inertia", "torque_ripple", "link_inertia", "payload"}  # at every joint


def study(plant: WholeJoints) -> dict[str, Any]:
    """Held-out nMSE by joint of every layer and of least squares on the same samples, names and times."""
    begun = time.process_time()
    try:
        result = diagnose([plant.record(1), plant.record(2)], plant.nominal, [plant.record(3)])
    except DiagnosisError as refusal:  # masses so far off look like another unit
        return {**REFUSED, "joints": plant.nominal.n_dof, "refused": str(refusal)}
    seconds = time.process_time() - begun
    with threadpool_limits(1):
        squares = least_squares_error(plant.nominal, result)
    layers = {k: [getattr(f, f"nmse_{k}") for f in result.verdict.fit] for k in LAYERS}
    return {
        "refused": None,
        "joints": plant.nominal.n_dof,
        "beside_free_links": result.state.judged is not None,
        **layers,
        "least_squares": squares.tolist(),
        "worse": int(np.sum(np.array(layers["identified"]) > WORSE * squares)),
        "names": [(e.effect, e.joint, e.tied_with) for e in result.effects],
        "wrong_names": [(e.effect, e.joint) for e in result.effects if is_wrong(e, plant)],
        "seconds": round(seconds, 1),
    }


def is_wrong(found: EffectFound, plant: WholeJoints) -> bool:
    """Whether neither a name nor what it is tied with is there; a spring stands for the strut at the second joint."""
    there = TRUE | ({"joint_spring"} if found.joint == plant.true.joints[1] else set())
    return not there & {found.effect, *found.tied_with}


def summary(plants: list[dict[str, Any]]) -> dict[str, Any]:
    """The figures of the pass lines."""
    refused, plants = sum(p["refused"] is not None for p in plants), [p for p in plants if p["refused"] is None]
    ratios = [i / s for p in plants for i, s in zip(p["identified"], p["least_squares"], strict=True)]
    return {
        "plants": len(plants),
        "refused": refused,
        "joints": sum(p["joints"] for p in plants),
        "joints_worse_than_least_squares": sum(p["worse"] for p in plants),
        "names": sum(len(p["names"]) for p in plants),
        "wrong_names": sum(len(p["wrong_names"]) for p in plants),
        "judged_beside_free_links": sum(p["beside_free_links"] for p in plants),
        "median_ratio_to_least_squares": float(np.median(ratios)),
        "largest_ratio_to_least_squares": float(np.max(ratios)),
        "median_seconds": float(np.median([p["seconds"] for p in plants])),
    }


def main() -> int:
    """Run the plants and write the result."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="one plant; writes nothing")
    figures = run(parser, lambda number: study(draw(number)), summary, TOLD, FULL, HERE)
    return int(figures["joints_worse_than_least_squares"] > 0 or figures["wrong_names"] > 0)


if __name__ == "__main__":
    raise SystemExit(main())
