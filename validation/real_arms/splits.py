"""The identified layer and the learned remainder on other splits of the real recordings, beside the same baselines.

python -m validation.real_arms.splits [--quick] [--data DIR]
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from validation.real_arms.arms import UR10E
from validation.real_arms.joint_states import read_joint_states
from validation.real_arms.layers import Case, cases, cut, read, study
from validation.real_arms.options import parser_of

from lagnet.models.files.loading import load_any
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.quality.screen import screen

HERE = Path(__file__).resolve().parent
UR10E_SPLITS = {
    "ur10e: fit_0, fit_1 | fit_3": (("fit_0", "fit_1"), ("fit_3",)),
    "ur10e: fit_2, fit_3 | fit_0": (("fit_2", "fit_3"), ("fit_0",)),
    "ur10e: holdout | fit_0, fit_2": (("holdout",), ("fit_0", "fit_2")),
    "ur10e: fit_0 to fit_3 | point_to_point": (("fit_0", "fit_1", "fit_2", "fit_3"), ("point_to_point",)),
}
TURNED = ("emps", "staubli_tx40", "panda", "loaded_0", "loaded_1")  # fitted on what is held out elsewhere


def splits(data: Path) -> dict[str, Callable[[], Case]]:
    """Nominal model, fitted and held-out recordings of each split; none of them is used in `layers`."""
    whole = cases(data)

    def turned(name: str) -> Case:
        robot, fit, held = whole[name]()
        return robot, held, fit

    def of_ur10e(fit: tuple[str, ...], held: tuple[str, ...]) -> Case:
        robot = load_any(data / UR10E.folder / UR10E.urdf)
        return robot, *([read(data / "ur10e" / f"{f}.csv.gz", robot, UR10E) for f in part] for part in (fit, held))

    def ur10() -> Case:
        robot = load_any("ur10")
        first, last = cut(read_joint_states(data / "bags" / "ur10_exciting_trajectory.db3", robot.joints), 0.3)
        return robot, last, first

    def panda_bag(share: float, turned: bool) -> Case:
        robot = load_any("panda")
        log = load_recording(data / "bags" / "panda_exciting_trajectory.db3", robot=robot)
        first, last = cut(screen(log, robot).recording, share)  # on its source's clock, for the baselines, too
        return robot, *((last, first) if turned else (first, last))

    return {
        **{f"{name}: turned round": (lambda name=name: turned(name)) for name in TURNED},
        "ur10: last 70 % | first 30 %": ur10,
        "panda_bag: first 75 % | rest": lambda: panda_bag(0.75, False),
        "panda_bag: last half | first half": lambda: panda_bag(0.5, True),
        **{name: (lambda parts=parts: of_ur10e(*parts)) for name, parts in UR10E_SPLITS.items()},
    }


def summary(found: dict[str, Any]) -> dict[str, Any]:
    """How the layers' errors compare with the baselines', joint by joint over all splits."""
    of = {way: np.concatenate([e["nmse"][way] for e in found.values()]) for way in ("least_squares", *OTHERS)}
    best = np.minimum(of["least_squares"], of["least_squares_and_trees"])
    identified, full = of["identified"] / of["least_squares"], of["full"] / best
    names = [f"{name}, joint {j + 1}" for name, e in found.items() for j in range(len(e["nmse"]["identified"]))]
    return {
        "joints": len(names),
        "identified_over_least_squares_median": round(float(np.median(identified)), 3),
        "identified_beyond_1.1": [n for n, x in zip(names, identified, strict=True) if x > 1.1],
        "full_over_better_baseline_median": round(float(np.median(full)), 3),
        "full_beyond_1.05": [n for n, x in zip(names, full, strict=True) if x > 1.05],
    }


OTHERS = ("least_squares_and_trees", "identified", "full")


def main() -> int:
    """Run the splits; 0 if no joint's identified layer is beyond 1.1 times least squares, nor full beyond 1.05."""
    options = parser_of(__doc__, "the first split alone").parse_args()
    found = {}
    for name, case in list(splits(options.data).items())[: 1 if options.quick else None]:
        found[name] = study(name.split(":")[0], case())
        print(name, json.dumps(found[name]["nmse"]), found[name]["seconds"], flush=True)
    told = summary(found)
    print(json.dumps(told, indent=1))
    if not options.quick:
        (HERE / "splits.json").write_text(json.dumps({"summary": told, "splits": found}, indent=1) + "\n")
    return 1 if told["identified_beyond_1.1"] or told["full_beyond_1.05"] else 0


if __name__ == "__main__":
    raise SystemExit(main())
