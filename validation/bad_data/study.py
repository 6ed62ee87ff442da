"""Bad data is told as bad data: the table of corruptions on a UR-5, and more drawn by a seed over five arms.

python -m validation.bad_data.study                  # writes result.json, part by part
python -m validation.bad_data.study --parts drawn    # one part anew, the others as they stand there
python -m validation.bad_data.study --quick          # three rows, writes nothing
"""

from __future__ import annotations

import argparse
import json
import os
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

import lagnet
from lagnet.diagnosis.data_quality.inspect import inspect_quality
from lagnet.errors import LagnetError
from lagnet.files import finite_json, write_whole
from lagnet.recordings.quality.finding import Finding
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import Robot
from validation.bad_data.corruptions import CORRUPTIONS, Corruption
from validation.bad_data.sound import SoundSettings, drawn_settings, sound_recording

RESULT = Path(__file__).with_name("result.json")
ARMS, REAL = ("ur5", "panda", "kinova"), ("ur10e", "staubli_tx40")
DRAWN, SOUND, SEED = 60, 200, 1
OTHERS = ("ur10", "ur3", "kinova", "z1")
QUICK = ("one dropped packet as zeros", "joints in alphabetical order", "torque 300 ms late")


@dataclass(frozen=True)
class Row:
    """What came of one corruption.

    Args:
        arm, corruption: what was corrupted and how.
        seconds: wall time of the whole diagnosis (of the checks alone where it was not run).
        cpu_seconds: processor time of the same, which is what it takes on a machine of its own.
        refused: the sentence, or "".
        told: sentences of the verdict's `data_quality`.
        cause_told: whether one of them names the cause.
        names: effects that were named, with their joint; None where no diagnosis was made.
        wrong_names: those that do not act.
    """

    arm: str
    corruption: str
    seconds: float
    cpu_seconds: float
    refused: str
    told: tuple[str, ...]
    cause_told: bool
    names: tuple[str, ...] | None
    wrong_names: int

    @property
    def answered(self) -> bool:
        """Whether the cause was told, or the right diagnosis made."""
        return self.cause_told or (self.names is not None and not self.wrong_names and bool(self.names))


def main() -> None:
    """Runs the study."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=list(PARTS))
    asked = parser.parse_args()
    if asked.quick:
        assert all(row.answered for row in table([c for c in CORRUPTIONS if c.name in QUICK]))
        return
    for part in asked.parts:
        write(with_part(_known(), part, PARTS[part]()))


def write(result: dict) -> None:
    """Writes the result; sentences name files of `LAGNET_DATA_DIR` without the place of that folder."""
    place = str(Path(os.environ["LAGNET_DATA_DIR"])) + os.sep
    write_whole(RESULT, finite_json(json.loads(json.dumps(result).replace(json.dumps(place)[1:-1], ""))))


def _known() -> dict:
    return json.loads(RESULT.read_text(encoding="utf-8")) if RESULT.exists() else {"figures": {}}


def plant(robot: Robot, seed: int) -> list[Recording]:
    """Three sound recordings of an arm with viscous friction at its second joint and a spring at its third."""
    rng, out = np.random.default_rng(seed), []
    for k in range(3):
        r = sound_recording(robot, SoundSettings(viscous=0.0), rng, path=f"run_{k}.csv")
        speed = np.gradient(r.q, r.time, axis=0)
        added = np.zeros_like(r.tau)
        added[:, 1], added[:, 2] = 12.0 * speed[:, 1], 15.0 * (r.q[:, 2] - 0.2)
        out.append(Recording(r.time, r.q, r.tau + added, r.joints, path=r.path))
    return out


def table(corruptions: Sequence[Corruption], others: Sequence[str] = ()) -> list[Row]:
    """The rows of the table: whole diagnoses of a UR-5."""
    robot = lagnet.load_robot("ur5")
    true = {f"viscous_friction at {robot.joints[1]}", f"joint_spring at {robot.joints[2]}"}
    rows = [_diagnosed(robot, "ur5", c, c.do(plant(robot, 7), np.random.default_rng(SEED)), true) for c in corruptions]
    for name in others:
        log = [
            sound_recording(lagnet.load_robot(name), SoundSettings(), np.random.default_rng(k), path=f"run_{k}.csv")
            for k in range(3)
        ]
        foreign = Corruption(f"the log of {name}", lambda r, _: r, (f"the robot {name}",))
        rows.append(_diagnosed(robot, "ur5", foreign, log, set()))
    return rows


def _diagnosed(robot, arm: str, corruption: Corruption, recordings: list[Recording], true: set[str]) -> Row:
    began, cpu, refused, told, names = time.perf_counter(), time.process_time(), "", (), None
    try:
        verdict = lagnet.diagnose(recordings, robot=robot).verdict
        names = tuple(f"{e.effect} at {e.joint}" for e in verdict.effects)
        told = tuple(d["detail"] for d in verdict.data_quality)
    except LagnetError as error:
        refused = str(error)
    seconds, cpu = time.perf_counter() - began, time.process_time() - cpu
    cause = any(word in text for text in (refused, *told) for word in corruption.words)
    row = Row(arm, corruption.name, seconds, cpu, refused, told, cause, names, len(set(names or ()) - true))
    print(f"{row.corruption:36} {cpu:6.1f} s  {'answered' if row.answered else 'NOT ANSWERED'}", flush=True)
    return row


def drawn() -> list[Row]:
    """Corruptions drawn by a seed over five arms, two of them real: the checks alone."""
    rng, rows = np.random.default_rng(SEED), []
    arms = [(name, lagnet.load_robot(name), None) for name in ARMS] + [(n, *_real(n)) for n in REAL]
    for k in range(DRAWN):
        name, robot, recordings = arms[k % len(arms)]
        given = list(recordings or plant(robot, 100 + k))
        fitting = [c for c in CORRUPTIONS if c.least_joints <= robot.n_dof and _changes(c, robot.joints)]
        corruption = fitting[int(rng.integers(len(fitting)))]
        broken, began, cpu = corruption.do(given, rng), time.perf_counter(), time.process_time()
        found = inspect_quality(broken, robot)
        rows.append(_inspected(name, corruption, found, (time.perf_counter() - began, time.process_time() - cpu)))
        print(f"{name:14} {corruption.name:36} {'told' if rows[-1].cause_told else 'NOT TOLD'}", flush=True)
    return rows


def _inspected(arm: str, corruption: Corruption, found: Sequence[Finding], seconds: tuple[float, float]) -> Row:
    told = tuple(f.detail for f in found)
    refused = next((f.sentence() for f in found if f.refused), "")
    cause = any(word in text for text in told for word in corruption.words)
    return Row(arm, corruption.name, *seconds, refused, told, cause, None, 0)


def _changes(corruption: Corruption, joints: tuple[str, ...]) -> bool:
    """Whether the alphabetical order is another than the model's."""
    return "alphabetical" not in corruption.name or list(joints) != sorted(joints)


def _real(name: str) -> tuple[Robot, list[Recording]]:
    data = Path(os.environ["LAGNET_DATA_DIR"]) / name
    robot = lagnet.load_robot(next(data.glob("*.urdf")))
    constants = [14.87, 13.26, 11.13, 10.62, 11.03, 11.47] if name == "ur10e" else None
    files = sorted(data.glob("fit*.csv.gz"))[:3]
    return robot, [lagnet.load_recording(f, robot=robot, torque_constant=constants) for f in files]


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


def with_part(result: dict, part: str, found: list) -> dict:
    """The result with the figures and all rows of one part in the place of those before."""
    figures = {"table": _of_table, "drawn": _of_drawn, "sound": _of_alarms}[part](found)
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


def _of_drawn(rows: Sequence[Row]) -> dict:
    arms = dict.fromkeys(r.arm for r in rows)
    told = {
        arm: f"{sum(r.cause_told for r in rows if r.arm == arm)} of {sum(r.arm == arm for r in rows)}" for arm in arms
    }
    return {"rows": len(rows), "cause_told": sum(r.cause_told for r in rows), "cause_told_by_arm": told}


def _of_alarms(alarms: Sequence[str]) -> dict:
    return {"recordings": SOUND, "alarms": len(alarms)}


if __name__ == "__main__":
    main()
