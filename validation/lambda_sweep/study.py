"""DeLaN-FFNN under five weights of ε on a damped UR-5. See README.md."""

from __future__ import annotations

import argparse
import itertools
import json
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.rigid_body.robot import load_description
from lagnet.training.settings import TrainingSettings
from validation.damped.data import Damping, damped_motion
from validation.damped.study import TEST, TEST_SEED, told
from validation.equal_budget import trained
from validation.ideal.motion import MotionSettings

HERE = Path(__file__).parent
PENALTIES = (1e-6, 1e-4, 1e-2, 1.0, 100.0)
SAMPLES, SECONDS = 20_000, 12.0
FACTOR = 5.0  # by which a λ that silences ε must be worse than the best
LINES = {"torque": "torque error", "inertial": "H a error", "gravity": "g error", "epsilon": "size of ε"}


def run(quick: bool) -> dict[str, Any]:
    """Errors and size of ε under each λ."""
    robot = load_description("ur5")
    data = damped_motion(robot, MotionSettings(motions=60), 0, 2000 if quick else SAMPLES, Damping())
    test = damped_motion(robot, TEST, TEST_SEED, None, Damping())
    found = []
    for penalty in PENALTIES[::2] if quick else PENALTIES:
        seconds = 0.3 if quick else SECONDS
        training = TrainingSettings(penalty=penalty, separation="joint")
        done = trained([data], "delan-ffnn", seconds, training, joint_types=("continuous",) * 6)
        found.append(_point(penalty, told(done, robot, test)))
        print(found[-1], flush=True)
    return {"samples": len(data), "test_samples": len(test), "sweep": found, "passed": judge(found)}


def _point(penalty: float, found: dict[str, Any]) -> dict[str, Any]:
    means = {term: _mean(found["errors"][term]) for term in ("torque", "inertial", "coriolis", "gravity")}
    spent = {name: found[name] for name in ("steps", "cpu_seconds")}
    return {"penalty": penalty, **means, "epsilon": _mean(found["residual_share"]), **spent}


def _mean(values: list[float | None]) -> float:
    return float(np.mean([x for x in values if x is not None]))


def judge(sweep: list[dict[str, Any]]) -> dict[str, bool]:
    """The pass line of README.md."""
    torque, epsilon = ([point[name] for point in sweep] for name in ("torque", "epsilon"))
    return {
        "large_penalty_is_worse": torque[-1] >= FACTOR * min(torque),
        "epsilon_falls_with_the_penalty": all(x >= y for x, y in itertools.pairwise(epsilon)),
    }


def draw_figure(sweep: list[dict[str, Any]], path: Path) -> None:
    """Errors and size of ε over λ, both logarithmic, as in Fig. 5 of the paper."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axis = pyplot.subplots(figsize=(6, 3.4))
    for name, label in LINES.items():
        axis.plot([p["penalty"] for p in sweep], [p[name] for p in sweep], marker="o", label=label)
    axis.set(xscale="log", yscale="log", xlabel="λ", ylabel="share of variance")
    axis.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    pyplot.close(figure)


def main() -> None:
    """Write result.json and figure.png; in quick mode only print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a minute, for CI: runs everything, proves nothing")
    quick = parser.parse_args().quick
    result = run(quick)
    print(json.dumps(result["passed"], indent=2))
    if not quick:
        (HERE / "result.json").write_text(json.dumps(result, indent=2) + "\n")
        draw_figure(result["sweep"], HERE / "figure.png")


if __name__ == "__main__":
    main()
