"""The order of a blind study: draw, publish the seals, simulate, diagnose blindly, hash the verdicts, open, score."""

from __future__ import annotations

import json
import platform
import shutil
import tempfile
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path

from validation.plants.blind import BlindResult, diagnose_all
from validation.plants.make import make, open_envelopes, seal
from validation.plants.scoring import Score, confusion, score, summary
from validation.plants.spec import PlantSpec


@dataclass(frozen=True)
class Line:
    """One line that a figure must not cross: at least or at most a limit."""

    figure: str
    limit: float
    at_least: bool

    def kept(self, figures: dict) -> bool:
        """Whether the figure keeps the line; a figure that is missing does not."""
        value = figures[self.figure]
        return value is not None and (value >= self.limit if self.at_least else value <= self.limit)


def conduct(specs: Sequence[PlantSpec], out: Path, processes: int) -> list[Score]:
    """Run the protocol; `out` ends up with seals, verdict hashes, verdicts and opened envelopes.

    Envelopes are held in memory until every verdict is hashed: there is no file that a diagnosis could read.
    """
    seal(specs, out)
    with tempfile.TemporaryDirectory() as folder:
        beyond = make(specs, Path(folder), processes)
        results = diagnose_all([Path(folder) / spec.name for spec in specs], out / "verdicts", processes)
    _publish_verdicts(results, out)
    open_envelopes(specs, out / "envelopes")
    scores = [score(spec, result, beyond[spec.name]) for spec, result in zip(specs, results, strict=True)]
    for result in results:
        (result.folder / "holdout_torque.parquet").unlink(missing_ok=True)  # large, and made anew by the same command
    return scores


def _publish_verdicts(results: Sequence[BlindResult], out: Path) -> None:
    lines = [f"{r.sha256 or 'failed'}  verdicts/{r.name}/verdict.json\n" for r in results]
    (out / "verdicts.sha256").write_text("".join(lines))


def fresh(out: Path) -> Path:
    """An empty folder in place of what an earlier run left there."""
    if out.exists():
        shutil.rmtree(out)
    out.mkdir(parents=True)
    return out


def report(scores: list[Score], lines: Sequence[Line], study: dict, path: Path) -> bool:
    """Write result.json; whether every pass line was kept."""
    figures = summary(scores)
    passed = {line.figure: line.kept(figures) for line in lines}
    content = {
        "study": study,
        "versions": {"lagnet": version("lagnet"), "pybullet": version("pybullet"), "python": platform.python_version()},
        "pass_lines": [asdict(line) | {"kept": passed[line.figure]} for line in lines],
        "figures": figures,
        "by_group": {name: summary(part) for name, part in _groups(scores).items()},
        "confusion": confusion(scores),
        "plants": [asdict(s) for s in scores],
    }
    path.write_text(json.dumps(content, indent=1) + "\n")
    for line in lines:
        sign = ">=" if line.at_least else "<="
        value = figures[line.figure]
        shown = "nothing" if value is None else f"{value:.4g}"
        print(f"{'kept  ' if passed[line.figure] else 'BROKEN'} {line.figure} = {shown} {sign} {line.limit:g}")
    for failure in figures["failures"]:
        print("failed:", failure)
    return all(passed.values()) and not figures["failures"]


def _groups(scores: list[Score]) -> dict[str, list[Score]]:
    groups: dict[str, list[Score]] = {}
    for s in scores:
        groups.setdefault(f"{len(s.hidden)} hidden", []).append(s)
        groups.setdefault(s.robot, []).append(s)
    return groups
