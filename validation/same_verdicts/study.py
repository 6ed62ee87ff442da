"""Do two versions of lagnet give the same verdicts, and in which time? Plants and real arms, by each version in turn.

python -m validation.same_verdicts.study VERSION VERSION ... [--plants 8] [--quick] [--data DIR] [--out DIR]
A version is a commit, a folder with its own src/, or "now", the lagnet that the study runs with. All are compared
with the first; give it again at the end to see what times scatter by.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from validation.ablations.plan import SIMULATED, Source
from validation.real_arms.arms import EMPS, TX40, UR10E, Arm
from validation.same_verdicts.compare import differences, largest_change, names_of

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SEED = 49
ARMS = {arm.name: arm for arm in (EMPS, TX40, UR10E)}
HERE_NOW = "now"  # the lagnet that this study runs with
EXPECTED = ("fit[].nmse_nominal", "fit[].nmse_named")  # told over all held-out samples since contract 11


def cases(data: Path, home: Path, plants: int, arms: tuple[Arm, ...]) -> list[dict[str, Any]]:
    """Files of every case, plants simulated where they have to be."""
    out = []
    for number in range(plants):
        plant = Source(SIMULATED, SEED, plants, 0).plant(number, home, data)
        if plant is not None:
            files = [str(plant.folder.resolve() / f"{name}.csv") for name in plant.plan.recordings]
            parts = {"robot": plant.plan.robot, "fit": files[:-1], "holdout": files[-1:], "torque_constant": None}
            out.append({"name": f"plant_{number}", **parts})
    for arm in arms:
        folder = data.resolve() / arm.folder
        fit, held = ([str(folder / f) for f in part] for part in (arm.fit, arm.holdout))
        parts = {"robot": str(folder / arm.urdf), "fit": fit, "holdout": held, "torque_constant": arm.torque_constant}
        out.append({"name": arm.name, **parts})
    return out


def ask(number: int, version: str, asked: Path, out: Path) -> Path:
    """The verdicts of one version, from its folder or from a checkout of its own; where they are."""
    if version == HERE_NOW:
        return _told(None, asked, out / "verdicts" / f"{number}_now")
    if (Path(version) / "src").is_dir():
        return _told(Path(version).resolve(), asked, out / "verdicts" / f"{number}_folder")
    commit = _git("rev-parse", "--short=12", version)
    tree = (out / "trees" / commit).resolve()
    _git("worktree", "add", "--detach", str(tree), commit)
    try:
        return _told(tree, asked, out / "verdicts" / f"{number}_{commit}")
    finally:
        _git("worktree", "remove", "--force", str(tree))


def _told(tree: Path | None, asked: Path, folder: Path) -> Path:
    command = [sys.executable, str(HERE / "told.py"), str(asked.resolve()), str(folder.resolve())]
    path = {} if tree is None else {"PYTHONPATH": str(tree / "src")}
    subprocess.run(command, env=os.environ | path, cwd=tree, check=True)
    return folder


def compared(old: dict[str, Any], new: dict[str, Any]) -> dict[str, Any]:
    """What differs in one case."""
    found = {k: w for k, w in differences(old["verdict"], new["verdict"]) if w != "added" and k not in EXPECTED}
    return {
        "same_names": names_of(old["verdict"]) == names_of(new["verdict"]),
        "largest_change_of_a_parameter": largest_change(old["verdict"], new["verdict"]),
        "other_values": found,
        "added": sorted({k for k, w in differences(old["verdict"], new["verdict"]) if w == "added"}),
        "processor_seconds": round(new["processor_seconds"], 2),
    }


def _read(file: Path, folders: Sequence[Path]) -> dict[str, Any]:
    """What a version told of a case, files named within the study's folders."""
    text = file.read_text()
    for folder in folders:
        text = text.replace(f"{folder.resolve()}/", "")
    return json.loads(text)


def _git(*words: str) -> str:
    return subprocess.run(["git", *words], cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()


def main() -> int:
    """Ask every version; 0 if the second gives the verdicts of the first and the last but one takes no longer."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("versions", nargs="*", default=[HERE_NOW, HERE_NOW])
    parser.add_argument("--plants", type=int, default=8)
    parser.add_argument("--quick", action="store_true", help="one plant and no arm; writes nothing")
    default = os.environ.get("LAGNET_DATA_DIR", str(HERE.parents[2] / "shared" / "data"))
    parser.add_argument("--arms", nargs="*", choices=ARMS, default=list(ARMS))
    parser.add_argument("--data", type=Path, default=Path(default), help="folder of the data sets (LAGNET_DATA_DIR)")
    parser.add_argument("--out", type=Path, default=Path("out") / "same_verdicts")
    given = parser.parse_args()
    given.out = given.out / "quick" if given.quick else given.out
    asked, arms = given.out / "cases.json", () if given.quick else tuple(ARMS[a] for a in given.arms)
    given.out.mkdir(parents=True, exist_ok=True)
    asked.write_text(json.dumps(cases(given.data, given.out, 1 if given.quick else given.plants, arms)))
    names = [case["name"] for case in json.loads(asked.read_text())]
    folders = [ask(n, version, asked, given.out) for n, version in enumerate(given.versions)]
    told = {f.name: {n: _read(f / f"{n}.json", (given.out, given.data)) for n in names} for f in folders}
    first, second, *_ = told
    rows = {v: {n: compared(told[first][n], of[n]) for n in names} for v, of in told.items()}
    seconds = {v: round(sum(x["processor_seconds"] for x in of.values()), 1) for v, of in rows.items()}
    same = all(not row["other_values"] for row in rows[second].values())
    lines = {
        "the second says the same": same,
        "the last but one is no slower": [*seconds.values()][-2] <= seconds[first],
    }
    result = {
        "study": "same_verdicts",
        "lines": lines,
        "cases": len(names),
        "same_names": {v: sum(row["same_names"] for row in of.values()) for v, of in rows.items()},
        "same_to_the_last_digit": {v: sum(not row["other_values"] for row in of.values()) for v, of in rows.items()},
        "processor_seconds": seconds,
        "versions": rows,
    }
    print(json.dumps(lines | {"processor_seconds": seconds}))
    if not given.quick:
        (HERE / "result.json").write_text(json.dumps(result, indent=1, ensure_ascii=False) + "\n")
    return 0 if all(lines.values()) else 1


if __name__ == "__main__":
    raise SystemExit(main())
