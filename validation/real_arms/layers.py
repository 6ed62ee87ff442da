"""The identified layer and the learned remainder alone, without names, beside plain least squares and boosted trees.

python -m validation.real_arms.layers [--quick] [--data DIR]
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from sklearn.ensemble import HistGradientBoostingRegressor
from threadpoolctl import threadpool_limits
from validation.real_arms.arms import EMPS, TX40, UR10E
from validation.real_arms.joint_states import read_joint_states
from validation.real_arms.least_squares import LeastSquares
from validation.real_arms.options import parser_of

from lagnet.diagnosis.identified.fit import identify
from lagnet.diagnosis.identified.remainder.learn import learn_remainder
from lagnet.diagnosis.problem.dry_friction import fit_sign_model
from lagnet.diagnosis.problem.problem import Problem, Segment, pose_problem
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.files.loading import load_any
from lagnet.recordings.conditioning.condition import condition
from lagnet.recordings.conditioning.smoothing import low_pass
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.recording import Recording

HERE = Path(__file__).resolve().parent
BANDS = {"panda": 10.0, "ur10": 10.0}  # [Hz] at which errors are told; 5 Hz for the others
REST = 0.01  # of the largest usual speed of a joint: below it for all joints the arm rests
Case = tuple[Any, list[Recording], list[Recording]]


def cases(data: Path) -> dict[str, Callable[[], Case]]:
    """Nominal model, fitted and held-out recordings of each set."""

    def files(arm) -> Case:
        robot = load_any(data / arm.folder / arm.urdf)
        return robot, *([read(data / arm.folder / f, robot, arm) for f in part] for part in (arm.fit, arm.holdout))

    def panda() -> Case:
        robot = load_any("panda")
        parts = (load_recording(data / "panda" / f"{f}.csv.gz", robot=robot) for f in ("fit", "holdout"))
        return robot, *([part] for part in parts)

    def ur10() -> Case:
        robot = load_any("ur10")
        return robot, *cut(read_joint_states(data / "bags" / "ur10_exciting_trajectory.db3", robot.joints), 0.75)

    def loaded(index: int) -> Case:
        robot = load_any(data / UR10E.folder / UR10E.urdf)
        return robot, *cut(read(data / "ur10e_loaded" / f"loaded_{index}.csv.gz", robot, UR10E), 0.5)

    arms = {arm.name: (lambda arm=arm: files(arm)) for arm in (EMPS, TX40, UR10E)}
    return {**arms, "panda": panda, "ur10": ur10, "loaded_0": lambda: loaded(0), "loaded_1": lambda: loaded(1)}


def read(path: Path, robot: Any, arm: Any) -> Recording:
    return load_recording(path, robot=robot, torque_constant=arm.torque_constant)


def cut(recording: Recording, share: float) -> tuple[list[Recording], list[Recording]]:
    edge = int(share * len(recording))
    return [recording.rows(slice(0, edge))], [recording.rows(slice(edge, None))]


def study(name: str, case: Case) -> dict[str, Any]:
    """Held-out nMSE of each joint over all samples and in motion, by four ways, with their seconds."""
    robot, fit_on, held = case
    fit = condition(fit_on)
    problem = fit_sign_model(pose_problem(robot, fit, condition(held, fit.bandwidth)))
    seconds = {}
    with threadpool_limits(1):
        start = time.perf_counter()
        plain = LeastSquares(robot, problem)
        seconds["least_squares"] = time.perf_counter() - start
        trees = _trees(problem, plain.torque)
        seconds["least_squares_and_trees"] = time.perf_counter() - start
        start = time.perf_counter()
        found = identify(problem, ())
        layer = None if found is None else found.layer
        model = CorrectedModel(robot, (), problem.slow, straight=problem.straight, identified=layer)
        seconds["identified"] = time.perf_counter() - start
        full = replace(model, remainder=learn_remainder(problem, model, 0))
        seconds["full"] = time.perf_counter() - start
    ways = {
        "nominal": lambda p: p.load,
        "least_squares": plain.torque,
        "least_squares_and_trees": lambda p: plain.torque(p) + trees(p),
        "identified": lambda p: model.torque_along(p.time, p.q, p.v, p.a),
        "full": lambda p: full.torque_along(p.time, p.q, p.v, p.a),
    }
    errors = {way: errors_of(problem, torque, BANDS.get(name, 5.0)) for way, torque in ways.items()}
    return {
        "bandwidth_hz": fit.bandwidth,
        "told_at_hz": BANDS.get(name, 5.0),
        "nmse": {way: [round(float(x), 5) for x in e[0]] for way, e in errors.items()},
        "nmse_in_motion": {way: [round(float(x), 5) for x in e[1]] for way, e in errors.items()},
        "seconds": {way: round(s, 1) for way, s in seconds.items()},
    }


def _signals(problem: Problem, p: Segment) -> np.ndarray:
    before = max(1, int(problem.rate / problem.bandwidth))
    return np.hstack([p.q, p.v, p.a, p.v[np.maximum(np.arange(len(p.v)) - before, 0)]])


def _trees(problem: Problem, torque: Callable[[Segment], np.ndarray]) -> Callable[[Segment], np.ndarray]:
    """Boosted trees on what least squares leaves of each joint."""
    x = np.concatenate([_signals(problem, p)[p.keep] for p in problem.fit])
    y = np.concatenate([problem.reduce(p, p.tau - torque(p)) for p in problem.fit])
    valid = np.concatenate([p.counts for p in problem.fit])
    grown = [
        HistGradientBoostingRegressor(max_iter=100, max_leaf_nodes=15, random_state=0).fit(x[k], y[k, j])
        for j, k in enumerate(valid.T)
    ]
    return lambda p: np.column_stack([tree.predict(_signals(problem, p)) for tree in grown])


def errors_of(problem: Problem, torque: Callable[[Segment], np.ndarray], band: float) -> tuple[np.ndarray, np.ndarray]:
    """nMSE of each joint over all held-out samples, and over those at which some joint moves."""
    top = np.quantile(np.abs(np.concatenate([p.v for p in problem.fit])), 0.98, axis=0)
    error = np.concatenate([low_pass(p.tau - torque(p), problem.rate, band) for p in problem.holdout])
    tau = np.concatenate([low_pass(p.tau, problem.rate, band) for p in problem.holdout])
    moves = np.concatenate([np.any(np.abs(p.v) > REST * top, axis=1) for p in problem.holdout])
    every = np.mean(error**2, axis=0) / tau.var(axis=0)
    return every, np.mean(error[moves] ** 2, axis=0) / tau[moves].var(axis=0)


def main() -> int:
    """Run the study; 0 if the identified layer is nowhere worse than 1.1 times least squares, nor full than 1.05."""
    options = parser_of(__doc__, "EMPS and UR10 alone").parse_args()
    found = {}
    for name, case in cases(options.data).items():
        if options.quick and name not in ("emps", "ur10"):
            continue
        found[name] = study(name, case())
        for way, values in found[name]["nmse"].items():
            mean, moving = np.mean(values), np.mean(found[name]["nmse_in_motion"][way])
            print(f"{name:13s} {way:24s} {values} mean {mean:.5f}, in motion {moving:.5f}", flush=True)
        print(f"{name:13s} seconds {found[name]['seconds']}", flush=True)
    lines = _lines(found)
    for claim, held in lines.items():
        print(f"{'met    ' if held else 'NOT MET'} {claim}")
    if not options.quick:
        result = {"study": "real_arms_layers", "passed": all(lines.values()), "lines": lines, "arms": found}
        (HERE / "layers.json").write_text(json.dumps(result, indent=1) + "\n")
    return 0 if all(lines.values()) else 1


def _lines(found: dict[str, Any]) -> dict[str, bool]:
    lines = {}
    for name, entry in found.items():
        error = {way: np.array(values) for way, values in entry["nmse"].items()}
        best = np.minimum(error["least_squares"], error["least_squares_and_trees"])
        means = [error[w].mean() for w in ("least_squares", "least_squares_and_trees")]
        identified = bool(np.all(error["identified"] <= 1.1 * error["least_squares"]))
        lines[f"{name}: identified at most 1.1 x least squares on every joint"] = identified
        lines[f"{name}: full at most 1.05 x the better baseline on every joint"] = bool(
            np.all(error["full"] <= 1.05 * best)
        )
        lines[f"{name}: mean of full better than both"] = bool(error["full"].mean() < min(means))
    return lines


if __name__ == "__main__":
    raise SystemExit(main())
