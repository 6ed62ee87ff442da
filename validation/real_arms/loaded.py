"""The UR10e calibrated without its load, then both recordings of it with a load that was mounted differently in each.

The first half of each is diagnosed; its second half is what the correction must predict. Once more with the second
halves held out as recordings of their own, and against the maker's model, which was never calibrated; and of
recordings in groups: one without a load, and both halves of each with it.

python -m validation.real_arms.loaded [--data DIR]
"""

from __future__ import annotations

import json
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from validation.real_arms.arms import UR10E
from validation.real_arms.options import parser_of

from lagnet.diagnosis.diagnose import Diagnosis, diagnose
from lagnet.diagnosis.problem.problem import pose_problem
from lagnet.diagnosis.writing import write_diagnosis
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.files.loading import load_any
from lagnet.recordings.conditioning.condition import condition
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.recording import Recording

HERE = Path(__file__).resolve().parent
FILES = ("loaded_0.csv.gz", "loaded_1.csv.gz")
ALIKE = 0.1  # relative difference of the two masses: it is one load
PREDICTED = 0.02  # nMSE of the second halves, of joints 1 to 5
MOST_NAMES = 2  # beside the loads


def calibrated(data: Path, out: Path) -> Any:
    """The UR10e's model as corrected by its recordings without a load."""
    robot = load_any(data / UR10E.folder / UR10E.urdf)
    fit, held = (
        [load_recording(data / UR10E.folder / f, robot=robot, torque_constant=UR10E.torque_constant) for f in files]
        for files in (UR10E.fit, UR10E.holdout)
    )
    write_diagnosis(diagnose(fit, robot, held, seed=0), out)
    return load_any(out / "corrected")


def halves(recording: Recording) -> tuple[Recording, Recording]:
    """What is diagnosed, and what is to be predicted."""
    middle = len(recording) // 2
    return recording.rows(slice(0, middle)), recording.rows(slice(middle, None))


def unseen_errors(result: Diagnosis, model: CorrectedModel, later: list[Recording]) -> tuple[np.ndarray, np.ndarray]:
    """nMSE of each joint over the second halves and over their motion, each with the load of its own recording.

    Shape (dof,) each. At rest dry friction may take any value: what a joint leaves there says nothing of its laws.
    """
    seen = result.state.fit
    model = model.with_effects(
        [replace(e, interval=None) for e in model.effects]
    )  # a load stays on after the first half
    problem = pose_problem(model.nominal, seen, condition(later, seen.bandwidth), tuple(range(len(later))))
    errors = []
    for p in problem.holdout:
        torque = replace(model, recording=p.origin).torque_along(p.time, p.q, p.v, p.a)
        errors.append(problem.reduce(p, p.tau - torque))
    squares = np.concatenate(errors) ** 2
    moves = np.concatenate([p.counts for p in problem.holdout])
    moving = np.sum(squares * moves, axis=0) / moves.sum(axis=0)
    return np.mean(squares, axis=0) / problem.unseen_variance, moving / problem.unseen_variance


def lines(result: Diagnosis, unseen: np.ndarray) -> dict[str, bool]:
    """Pass lines of the issue, fixed before."""
    loads = [e for e in result.effects if e.effect == "payload"]
    masses = [e.value("m") for e in loads]
    return {
        "a load in each recording": len(loads) == len(FILES) == len({e.recording for e in loads}),
        "masses within 10 %": len(masses) == 2 and abs(masses[0] - masses[1]) < ALIKE * max(masses),
        "the difference is told": any("differ from each other" in line for line in result.verdict.warnings),
        "error of joints 1 to 5 in the second halves at most .02": bool(np.all(unseen[:5] <= PREDICTED)),
        "at most two effects beside the loads": len(result.effects) - len(loads) <= MOST_NAMES,
    }


def lines_apart(result: Diagnosis) -> dict[str, bool]:
    """The same of second halves that are held out as recordings of their own."""
    masses = [e.value("m") for e in result.effects if e.effect == "payload"]
    return {
        "a load in each, alike within 10 %": len(masses) == 2 and abs(masses[0] - masses[1]) < ALIKE * max(masses),
        "each held-out recording carries the load of its own": result.ends_of == (0, 1),
        "error of joints 1 to 5 at most .02": all(f.nmse_named <= PREDICTED for f in result.verdict.fit[:5]),
    }


def effects_of(result: Diagnosis) -> list[dict[str, Any]]:
    """Names with their places and values."""
    return [
        {
            "effect": e.effect,
            "joint": e.joint,
            "recording": Path(e.recording).name if e.recording else None,
            "parameters": {p.name: round(p.value, 5) for p in e.parameters},
        }
        for e in result.effects
    ]


def in_groups(robot: Any, data: Path) -> dict[str, Any]:
    """A recording without a load beside both halves of each with it, against the calibrated model."""
    folders = (data / UR10E.folder / UR10E.fit[0], *(data / "ur10e_loaded" / f for f in FILES))
    free, *loaded = (load_recording(f, robot=robot, torque_constant=UR10E.torque_constant) for f in folders)
    result = diagnose([free, *(half for one in loaded for half in halves(one))], robot, seed=0)
    loads = [(t.effect.recording, t.effect.values["m"]) for t in result.state.transients]
    masses = [m for _, m in loads]
    return {
        "lines": {
            "a load in each of four recordings, none in the first": sorted(n or 0 for n, _ in loads) == [1, 2, 3, 4],
            "alike within 10 %": bool(masses) and max(masses) - min(masses) < ALIKE * max(masses),
        },
        "effects": effects_of(result),
        "nmse_named": [round(f.nmse_named, 5) for f in result.verdict.fit],
    }


def read_halves(robot: Any, folder: Path) -> tuple[list[Recording], list[Recording]]:
    """The first halves of both recordings, and their second halves."""
    recordings = [load_recording(folder / f, robot=robot, torque_constant=UR10E.torque_constant) for f in FILES]
    first, later = zip(*map(halves, recordings), strict=True)
    return list(first), list(later)


def held_apart(robot: Any, folder: Path) -> dict[str, Any]:
    """Second halves held out as recordings of their own, against a model."""
    first, later = read_halves(robot, folder)
    cpu = time.process_time()
    result = diagnose(first, robot, later, seed=0)
    return {
        "lines": lines_apart(result),
        "seconds_of_processor": round(time.process_time() - cpu, 1),
        "effects": effects_of(result),
        "nmse_named": [round(f.nmse_named, 5) for f in result.verdict.fit],
        "nmse_full": [round(float(f.nmse_full or f.nmse_named), 5) for f in result.verdict.fit],
    }


def main() -> int:
    """Run the study; 0 if every line is passed."""
    parser = parser_of(__doc__)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        robot = calibrated(options.data, Path(scratch))
        folder = options.data / "ur10e_loaded"
        first, later = read_halves(robot, folder)
        start, cpu = time.perf_counter(), time.process_time()
        result = diagnose(first, robot, seed=0)
        seconds, processor = time.perf_counter() - start, time.process_time() - cpu
        maker = load_any(options.data / UR10E.folder / UR10E.urdf)
        apart = {k: held_apart(m, folder) for k, m in (("calibrated", robot), ("maker", maker))}
        groups = in_groups(robot, options.data)
    layers = ("named", "identified", "full")
    errors = {k: unseen_errors(result, result.corrected.with_layers(k), later) for k in layers}
    found = lines(result, errors["named"][0])
    claims = found | {f"{k}, held apart: {c}": met for k, one in apart.items() for c, met in one["lines"].items()}
    claims |= {f"in groups: {c}": met for c, met in groups["lines"].items()}
    told = {
        "study": "loaded",
        "passed": all(claims.values()),
        "lines": found,
        "seconds": round(seconds, 1),
        "seconds_of_processor": round(processor, 1),
        "effects": effects_of(result),
        "nmse_of_the_second_halves": {k: [round(float(x), 5) for x in e[0]] for k, e in errors.items()},
        "nmse_of_their_motion": {k: [round(float(x), 5) for x in e[1]] for k, e in errors.items()},
        "held_out_as_recordings_of_their_own": apart,
        "in_groups": groups,
    }
    (HERE / "loaded.json").write_text(json.dumps(told, indent=1, ensure_ascii=False) + "\n")
    for claim, passed in claims.items():
        print(f"{'met    ' if passed else 'NOT MET'} {claim}")
    return 0 if told["passed"] else 1


if __name__ == "__main__":
    raise SystemExit(main())
