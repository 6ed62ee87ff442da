"""Bad data is told as bad data: the table of corruptions on a UR-5, and more drawn by a seed over five arms.

python -m validation.bad_data.study                  # writes result.json, part by part
python -m validation.bad_data.study --parts drawn    # one part anew, the others as they stand there
python -m validation.bad_data.study --parts drawn --arms ur10e    # of it, the rows of one arm anew
python -m validation.bad_data.study --quick          # three rows, writes nothing
"""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np

import lagnet
from lagnet.diagnosis.data_quality.inspect import inspect_quality
from lagnet.files import finite_json, write_whole
from validation.bad_data.corruptions import CORRUPTIONS, Corruption
from validation.bad_data.drawn import ARMS, SEED, drawn, names_counted, plant, planted
from validation.bad_data.row import Row, diagnosed
from validation.bad_data.sound import SoundSettings, drawn_settings, sound_recording

RESULT = Path(__file__).with_name("result.json")
SOUND = 200
OTHERS = ("ur10", "ur3", "kinova", "z1")
QUICK = ("one dropped packet as zeros", "joints in alphabetical order", "torque 300 ms late")


def main() -> None:
    """Runs the study."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=list(PARTS))
    parser.add_argument("--arms", nargs="+", choices=ARMS, default=list(ARMS), help="of the drawn part")
    asked = parser.parse_args()
    if asked.quick:
        assert all(row.answered for row in table([c for c in CORRUPTIONS if c.name in QUICK]))
        return
    for part in asked.parts:
        if part == "drawn":
            for arm in asked.arms:  # written arm by arm
                write(with_part(_known(), part, with_arm(_known(), arm, drawn([arm]))))
        else:
            write(with_part(_known(), part, PARTS[part]()))


def write(result: dict) -> None:
    """Writes the result; sentences name files of `LAGNET_DATA_DIR` without the place of that folder."""
    place = str(Path(os.environ["LAGNET_DATA_DIR"])) + os.sep
    write_whole(RESULT, finite_json(json.loads(json.dumps(result).replace(json.dumps(place)[1:-1], ""))))


def _known() -> dict:
    return json.loads(RESULT.read_text(encoding="utf-8")) if RESULT.exists() else {"figures": {}}


def table(corruptions: Sequence[Corruption], others: Sequence[str] = ()) -> list[Row]:
    """The rows of the table: whole diagnoses of a UR-5."""
    robot = lagnet.load_robot("ur5")
    broken = [(c, c.do(plant(robot, 7), np.random.default_rng(SEED))) for c in corruptions]
    rows = [diagnosed(robot, "ur5", corruption, log, planted(robot)) for corruption, log in broken]
    for name in others:
        log = [
            sound_recording(lagnet.load_robot(name), SoundSettings(), np.random.default_rng(k), path=f"run_{k}.csv")
            for k in range(3)
        ]
        foreign = Corruption(f"the log of {name}", lambda r, _: r, (f"the robot {name}",))
        rows.append(diagnosed(robot, "ur5", foreign, log, set()))
    return rows


def sound() -> list[str]:
    """Alarms on sound recordings of all kinds."""
    rng, alarms = np.random.default_rng(SEED), []
    robots = [lagnet.load_robot(name) for name in ("ur5", "panda", "ur10", "ur3", "kinova", "z1")]
    for k in range(SOUND):
        robot = robots[k % len(robots)]
        found = inspect_quality([sound_recording(robot, drawn_settings(rng), rng)], robot)
        alarms += [f"{robot.source} {k}: {f.sentence()}" for f in found]
    return alarms


PARTS: dict[str, Callable[[], list]] = {
    "table": lambda: table(CORRUPTIONS, OTHERS),
    "drawn": drawn,
    "sound": sound,
}


def with_arm(result: dict, arm: str, rows: Sequence[Row]) -> list[Row]:
    """The drawn rows in the order of the arms, those of one arm in the place of those before."""
    known = [Row(**row) for row in result.get("drawn", []) if row["arm"] != arm]
    return sorted([*known, *rows], key=lambda row: ARMS.index(row.arm))


def with_part(result: dict, part: str, found: list) -> dict:
    """The result with the figures and all rows of one part in the place of those before."""
    figures = {"table": _of_table, "drawn": names_counted, "sound": _of_alarms}[part](found)
    rows = [asdict(row) if isinstance(row, Row) else row for row in found]
    kept = {k: v for k, v in result["figures"].items() if k != part}
    return {**result, "figures": {**kept, part: figures}, part: json.loads(json.dumps(rows))}


def _of_table(rows: Sequence[Row]) -> dict:
    return {
        "rows": len(rows),
        "answered": sum(r.answered for r in rows),
        "cause_told": sum(r.cause_told for r in rows),
        "wrong_names": sum(r.wrong_names for r in rows),
        "slowest_s": max(r.seconds for r in rows),
        "slowest_cpu_s": max(r.cpu_seconds for r in rows),
    }


def _of_alarms(alarms: Sequence[str]) -> dict:
    return {"recordings": SOUND, "alarms": len(alarms)}


if __name__ == "__main__":
    main()
