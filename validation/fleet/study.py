"""Changes of a concealed fleet against what was told of it.

python -m validation.fleet.study [--quick] [--work FOLDER] [--workers N] [--seed S] [--search every|unusual]
                                  [--size ROBOTS RECORDINGS] [--result FILE]
"""

from __future__ import annotations

import argparse
import hashlib
import json
import resource
import tempfile
import time
from pathlib import Path
from typing import Any

import lagnet
from lagnet.tracking.engine import EngineSettings
from lagnet.tracking.track import track
from validation.fleet.baseline import told_by_slopes
from validation.fleet.generate import write_fleet
from validation.fleet.scoring import score

HERE = Path(__file__).resolve().parent
FULL, QUICK = (40, 12), (10, 8)
FOUND, WRONG = 0.95, 0.02


def run(folder: Path, size: tuple[int, int], options: argparse.Namespace) -> dict[str, Any]:
    """Draws, tracks and scores a fleet; what a folder holds already is not done again."""
    manifest = folder / "fleet" / "fleet.toml"
    if not (folder / "fleet" / "envelope.sha256").exists():
        write_fleet(folder / "fleet", *size, options.seed, options.search)
    start, spent = time.perf_counter(), _processor_seconds()
    result = track(manifest, folder / "out", EngineSettings(workers=options.workers), _show)
    seconds, spent = time.perf_counter() - start, _processor_seconds() - spent
    text = (folder / "fleet" / "envelope.json").read_text()
    sealed = (folder / "fleet" / "envelope.sha256").read_text().strip()
    if hashlib.sha256(text.encode()).hexdigest() != sealed:
        raise RuntimeError("the envelope is not the one that was sealed")
    truth = json.loads(text)
    told = {(e.robot, e.joint) for e in result.analysis.events}
    return {
        "robots": size[0],
        "recordings": size[0] * size[1],
        "seed": options.seed,
        "search": options.search,
        "seconds": round(seconds, 1),
        "processor_seconds": round(spent, 1),
        "failed": len(result.failed),
        "searched": len({r.recording for r in result.rows if r.diagnosis}),
        "tracked": score(truth, result),
        "baseline": told_by_slopes(truth, result),
        "joints_told": len(told),
        "events": [_plain(e) for e in result.analysis.events],
    }


def _processor_seconds() -> float:
    """Of this process and of workers that have ended."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(u.ru_utime + u.ru_stime for u in used)


def _show(title: str, done: int, total: int) -> None:
    if done == total or done % 40 == 0:
        print(f"{title}: {done} of {total}", flush=True)


def _plain(event: Any) -> dict[str, Any]:
    named = {n: getattr(event, n) for n in ("robot", "joint", "effect", "parameter", "kind")}
    return named | {
        "date": f"{event.date:%Y-%m-%d}",
        "change": round(event.change, 4),
        "p_value": float(f"{event.p_value:.2g}"),
    }


def judge(found: dict[str, Any], with_odd: bool) -> list[dict[str, Any]]:
    """Pass lines; that of the odd robot needs the sisters of a full fleet."""
    s = found["tracked"]
    lines = [
        ("changes found ≥ 95 %", s["found"], s["found"] >= FOUND),
        ("robots without a change wrongly told ≤ 2 %", s["wrong_robots"], s["wrong_robots"] <= WRONG),
        ("robot and joint without a change wrongly told ≤ 2 %", s["wrong_joints"], s["wrong_joints"] <= WRONG),
        ("dates within one recording", s["worst_date"], s["worst_date"] <= 1),
        ("robots that only warmed up and were told to have changed: 0", s["warm_told"], s["warm_told"] == 0),
        ("the odd robot stands apart at its joint", s["odd_found"], s["odd_found"]),
    ]
    return [{"claim": c, "found": f, "passed": bool(p)} for c, f, p in (lines if with_odd else lines[:-1])]


def keep(file: Path, result: dict[str, Any]) -> None:
    """Writes a result; one with the search of every recording stands beside that without, under `every`."""
    known = json.loads(file.read_text()) if file.exists() else {}
    if result["search"] == "every":
        result = {**known, "every": result}
    elif "every" in known:
        result = {**result, "every": known["every"]}
    file.write_text(json.dumps(result, indent=1, ensure_ascii=False) + "\n")


def main() -> int:
    """Run the study; 0 if every line is passed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="ten robots, eight recordings; writes nothing")
    parser.add_argument("--work", type=Path, help="folder that keeps the fleet and its diagnoses")
    parser.add_argument("--workers", type=int, help="processes; else one a core")
    parser.add_argument("--seed", type=int, default=2025)
    parser.add_argument("--search", default="unusual", choices=("every", "unusual"))
    parser.add_argument("--size", type=int, nargs=2, default=FULL, help="robots and recordings of each")
    parser.add_argument("--result", type=Path, default=HERE / "result.json", help="of a full run")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        size = QUICK if options.quick else tuple(options.size)
        found = run(options.work or Path(scratch), size, options)
    lines = judge(found, size == FULL)
    for line in lines:
        print(f"{'met    ' if line['passed'] else 'NOT MET'} {line['claim']}: {line['found']}")
    passed = all(line["passed"] for line in lines)
    if not options.quick:
        keep(
            options.result, {"study": "fleet", "version": lagnet.__version__, "passed": passed, **found, "lines": lines}
        )
    return 0 if passed else 1


if __name__ == "__main__":
    raise SystemExit(main())
