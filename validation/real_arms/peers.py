"""Peers on the same recordings: `mujoco.sysid` and FIGAROH beside the diagnosis and plain least squares, in one run.

python -m validation.real_arms.peers [--only NAME...] [--data DIR]
"""

from __future__ import annotations

import contextlib
import importlib
import io
import json
import logging
import time
from collections.abc import Callable
from dataclasses import replace
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits
from validation.real_arms.layers import BANDS, cases, errors_of
from validation.real_arms.least_squares import LeastSquares
from validation.real_arms.options import parser_of

from lagnet.diagnosis.diagnose import Diagnosis, diagnose
from lagnet.diagnosis.problem.dry_friction import fit_sign_model
from lagnet.diagnosis.problem.problem import Problem, Segment, pose_problem
from lagnet.recordings.conditioning.condition import condition

HERE = Path(__file__).resolve().parent
WORSE = 1.05  # times the best peer's mean error, at most
Torque = Callable[[Segment], np.ndarray]


class Table:
    """What each way predicts, takes and says."""

    def __init__(self, problem: Problem, band: float) -> None:
        self.problem, self.band, self.rows = problem, band, {}

    def add(self, way: str, torque: Torque, seconds: float, told: dict[str, Any] | None = None) -> None:
        """Errors of a way on held-out samples, its seconds of processor, and what it says of the cause."""
        every, moving = errors_of(self.problem, torque, self.band)
        row: dict[str, Any] = {
            "nmse": _short(every),
            "nmse_in_motion": _short(moving),
            "processor_s": round(seconds, 2),
        }
        self.rows[way] = row if told is None else row | {"told": told}
        print(f"  {way:24s} {row['nmse']} mean {np.mean(every):.5f}, {row['processor_s']} s", flush=True)

    def missing(self, way: str, why: str) -> None:
        """A way that did not run, and why."""
        self.rows[way] = {"missing": why}
        print(f"  {way:24s} did not run: {why}", flush=True)


def _short(x: np.ndarray) -> list[float]:
    return [round(float(e), 5) for e in x]


def study(name: str, case: Callable[[], tuple]) -> dict[str, Any]:
    """All ways on one set."""
    robot, fit_on, held = case()
    fit = condition(fit_on)
    problem = fit_sign_model(pose_problem(robot, fit, condition(held, fit.bandwidth)))
    table = Table(problem, BANDS.get(name, 5.0))
    print(f"{name}: {sum(p.time.size for p in problem.fit)} samples fitted at {problem.rate:.0f} Hz", flush=True)
    table.add("nominal", lambda p: p.load, 0.0)
    start = time.process_time()
    with threadpool_limits(1):
        plain = LeastSquares(robot, problem)
    table.add("least_squares", plain.torque, time.process_time() - start)
    start = time.process_time()
    found = diagnose(fit_on, robot, held, seed=0)
    spent = time.process_time() - start
    for layer in ("named", "identified", "full"):
        model = found.corrected.with_layers(layer)
        table.add(f"lagnet_{layer}", _torque_of(model), spent, _told(found) if layer == "named" else None)
    with threadpool_limits(1):
        _mujoco(table, robot)
        _figaroh(table, robot)
    return {"bandwidth_hz": fit.bandwidth, "told_at_hz": table.band, "ways": table.rows}


def _torque_of(model: Any) -> Torque:
    return lambda p: replace(model, recording=p.origin).torque_along(p.time, p.q, p.v, p.a)


def _told(found: Diagnosis) -> dict[str, Any]:
    entries = found.verdict.effects
    return {
        "parameters_that_the_user_must_list": 0,
        "names": [f"{e.effect} {e.joint or 'whole arm'}" for e in entries],
        "names_a_cause": bool(entries),
        "evidence_against_a_rival": True,
    }


def _mujoco(table: Table, robot: Any) -> None:
    with _or_missing(table, "mujoco_sysid"):
        module = importlib.import_module("validation.real_arms.mujoco_sysid")
        start = time.process_time()
        with contextlib.redirect_stdout(io.StringIO()):
            peer = module.MujocoSysid(robot, table.problem)
        table.add("mujoco_sysid", peer.torque, time.process_time() - start, peer.told())


def _figaroh(table: Table, robot: Any) -> None:
    with _or_missing(table, "figaroh"):
        module = importlib.import_module("validation.real_arms.figaroh_fit")
        logging.getLogger("figaroh").setLevel(logging.CRITICAL)
        start = time.process_time()
        with contextlib.redirect_stdout(io.StringIO()):
            peer = module.Figaroh(robot, table.problem)
        middle = time.process_time()
        table.add("figaroh", peer.torque, middle - start, peer.told())
    with _or_missing(table, "figaroh_consistent"):
        middle = time.process_time()
        with contextlib.redirect_stdout(io.StringIO()):
            peer.fit_consistent()
        spent, torque = time.process_time() - middle, peer.consistent_torque()
        if torque is None:
            table.missing("figaroh_consistent", f"it rejects its own fit: {peer.told()['physical_fit']}")
        else:
            table.add("figaroh_consistent", torque, spent, peer.told())


@contextlib.contextmanager
def _or_missing(table: Table, way: str) -> Any:
    """A peer that fails is told with its error, and stops nothing."""
    try:
        yield
    except Exception as error:
        table.missing(way, f"{type(error).__name__}: {error}"[:300])


def lines(found: dict[str, Any]) -> dict[str, bool | str]:
    """Pass lines of each set: mean over joints of the full correction against each peer that ran."""
    out: dict[str, bool | str] = {}
    for name, entry in found.items():
        ours = np.mean(entry["ways"]["lagnet_full"]["nmse"])
        peers = {w: r["nmse"] for w, r in entry["ways"].items() if w.startswith(("mujoco", "figaroh")) and "nmse" in r}
        claim = f"{name}: mean of full at most {WORSE} x the best peer's"
        out[claim] = bool(ours <= WORSE * min(np.mean(e) for e in peers.values())) if peers else "no peer ran"
    return out


def main() -> int:
    """Run the study; 0 if every line is passed."""
    parser = parser_of(__doc__)
    parser.add_argument("--only", nargs="*", help="these sets alone; writes nothing")
    options = parser.parse_args()
    chosen = cases(options.data)
    found = {name: study(name, chosen[name]) for name in options.only or chosen}
    held = lines(found)
    for claim, result in held.items():
        print(
            f"{'met    ' if result is True else 'NOT MET'} {claim}{'' if isinstance(result, bool) else ': ' + result}"
        )
    passed = all(result is True for result in held.values())
    if not options.only:
        result = {"study": "real_arms_peers", "passed": passed, "versions": _versions(), "lines": held, "arms": found}
        (HERE / "peers.json").write_text(json.dumps(result, indent=1) + "\n")
    return 0 if passed else 1


def _versions() -> dict[str, str]:
    out = {}
    for package in ("mujoco", "figaroh"):
        try:
            out[package] = metadata.version(package)
        except metadata.PackageNotFoundError:
            out[package] = "not installed"
    return out


if __name__ == "__main__":
    raise SystemExit(main())
