"""Two real robots followed over their recordings by commands and positions alone: what drifts, and what does not.

python -m validation.real_fleet.study [--quick] [--work FOLDER]
"""

from __future__ import annotations

import argparse
import json
import os
import tempfile
import time
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from lagnet.tracking.tables import TrackRow
from lagnet.tracking.track import Track, track
from validation.motion_real.study import PENDULUM

HERE = Path(__file__).resolve().parent
DATA = Path(os.environ.get("LAGNET_DATA_DIR", HERE.parents[2] / "shared" / "data"))
SETTINGS = ["[settings]", 'search = "unusual"', "reports = false"]
BENCH_GAIN = 100.0  # kp of the bench that the others are stated over


def bench(folder: Path, logs: Sequence[Path]) -> Path:
    """Manifest of the XL330: dates of the file names, gains of the files, temperatures that the servo reported."""
    if not (folder / "pendulum.urdf").exists():  # a file written anew has its work done again
        (folder / "pendulum.urdf").write_text(PENDULUM, encoding="utf-8")
    listed = ", ".join(json.dumps(str(log)) for log in logs)
    lines = [*SETTINGS, "[[make]]", 'name = "xl330"', 'robot = "pendulum.urdf"', f"calibration = [{listed}]"]
    lines += ["[[robot]]", 'name = "servo"']
    for log in logs:
        gain = json.loads(log.read_text(encoding="utf-8"))["kp"] / BENCH_GAIN
        lines += ["[[robot.recordings]]", f"files = {json.dumps(str(log))}"]
        lines += ['date_in_name = "%Y-%m-%d_%Hh%Mm%S"', f"gain = {gain}"]
    return _written(folder, lines)


def arm(folder: Path, motions: Sequence[Path]) -> Path:
    """Manifest of the SO-101, whose logs have no date: a minute apart in the order of their names."""
    robot = json.dumps(str(DATA / "so101" / "so101.xml"))
    listed = ", ".join(json.dumps(str(m)) for m in motions[::3])
    lines = [*SETTINGS, "[[make]]", 'name = "so101"', f"robot = {robot}", f"calibration = [{listed}]"]
    lines += ["[[robot]]", 'name = "arm"']
    for minute, motion in enumerate(motions):
        lines += ["[[robot.recordings]]", f"files = {json.dumps(str(motion))}", f"date = 2026-01-01T00:{minute:02d}:00"]
    return _written(folder, lines)


def _written(folder: Path, lines: Sequence[str]) -> Path:
    path = folder / "fleet.toml"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def followed(manifest: Path) -> dict[str, Any]:
    """Changes told, and each parameter over the recordings with its 95 % intervals."""
    begun = time.perf_counter()
    found = track(manifest, manifest.parent / "out", progress=_show)
    return {"seconds": round(time.perf_counter() - begun, 1), **summary(found)}


def _show(title: str, done: int, total: int) -> None:
    if done % 10 == 0 or done == total:
        print(f"{title}: {done} of {total}", flush=True)


def summary(found: Track) -> dict[str, Any]:
    """Plain values of a track: first and last value, scatter, changes, outliers and errors."""
    series: dict[str, list[TrackRow]] = defaultdict(list)
    for row in found.rows:
        if row.value is not None:
            series[f"{row.joint} {row.effect} {row.parameter} [{row.unit}]"].append(row)
    return {
        "recordings": len({r.recording for r in found.rows}),
        "errors": [r.error for r in found.failed],
        "searched": len({r.diagnosis for r in found.rows if r.diagnosis}),
        "temperature": [_short(t) for t in sorted({r.temperature for r in found.rows if r.temperature is not None})],
        "parameters": {
            name: [[_short(x) for x in (r.value, r.lower, r.upper)] for r in rows] for name, rows in series.items()
        },
        "outliers": {name: n for name, rows in series.items() if (n := sum(bool(r.outlier) for r in rows))},
        "not_followed": [
            {n: getattr(one, n) for n in ("joint", "effect", "named", "reason")} for one in found.not_followed
        ],
        "changes": [
            {"joint": e.joint, "effect": e.effect, "parameter": e.parameter, "kind": e.kind, "change": _short(e.change)}
            for e in found.analysis.events
        ],
    }


def _short(value: float | None) -> float | None:
    return None if value is None else float(f"{value:.4g}")


def main() -> None:
    """Follows both robots, or three logs of the bench with --quick, and writes result.json."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="three logs of the bench; nothing is written")
    parser.add_argument("--work", type=Path, help="folder that keeps what is finished")
    options, result = parser.parse_args(), {}
    quick = options.quick
    logs = sorted((DATA / "bam_xl330").glob("*.json"))
    motions = sorted(p for p in (DATA / "so101").iterdir() if p.is_dir())
    sets = {"XL330": (bench, logs[:3] if quick else logs), "SO-101": (arm, motions)}
    for name, (write, files) in sets.items():
        with tempfile.TemporaryDirectory() as scratch:
            folder = Path(options.work or scratch) / name
            folder.mkdir(parents=True, exist_ok=True)
            result[name] = followed(write(folder, files))
        print(name, json.dumps(result[name], ensure_ascii=False), flush=True)
        if quick:
            return
        text = json.dumps(result, indent=1, ensure_ascii=False, allow_nan=False)
        (HERE / "result.json").write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
