"""Two-link arm that writes letters: torque and its parts on unseen letters. See README.md."""

from __future__ import annotations

import argparse
import json
import os
import time
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.recordings.datasets.characters import TEST_LETTERS, Characters, load_characters
from lagnet.training.settings import TrainingSettings
from lagnet.training.train import train

HERE = Path(__file__).parent
DATA = Path(os.environ.get("LAGNET_DATA_DIR", HERE.parents[2] / "shared" / "data"))
LIMITS = {"torque": 1e-6, "inertial": 2e-6, "coriolis": 1e-6, "gravity": 1e-6, "seconds": 30.0}
PUBLISHED = {"torque": 2.2e-5, "inertial": 3.2e-5, "coriolis": 1.4e-5, "gravity": 2.0e-5, "seconds": 113.0}
KINDS = {
    "delan": TrainingSettings(steps=3000, patience=1.0),
}


def judged(model: Any, data: Characters, test: np.ndarray) -> dict[str, float]:
    """Mean squared error over the samples of the test letters, summed over the two joints [N² m²]."""
    run = data.recording
    q, v, a = run.q[test], run.v[test], run.a[test]
    found = {
        "torque": (model.inverse_dynamics(q, v, a), run.tau),
        "inertial": (np.einsum("nij,nj->ni", model.mass_matrix(q), a), data.inertial_torque),
        "coriolis": (model.coriolis_torque(q, v), data.coriolis_torque),
        "gravity": (model.gravity_torque(q), data.gravity_torque),
    }
    return {term: float(np.mean((x - true[test]) ** 2, axis=0).sum()) for term, (x, true) in found.items()}


def run(seeds: int, quick: bool) -> dict[str, Any]:
    """Train on seventeen letters, judge on e, q and v."""
    data = load_characters(DATA / "delan_characters" / "characters.npz")
    test = data.letters(TEST_LETTERS)
    models: dict[str, Any] = {}
    for kind, training in KINDS.items():
        settings = TrainingSettings(steps=200) if quick else training
        found = []
        for seed in range(seeds):
            began = time.process_time()
            fit = train(
                [data.recording.rows(~test)], kind, seed=seed, training=settings, joint_types=("continuous",) * 2
            )
            found.append(
                {
                    **judged(fit.model, data, test),
                    "seconds": fit.stats["seconds"],
                    "cpu_seconds": time.process_time() - began,
                }
            )
            print(kind, seed, found[-1], flush=True)
        median = {name: float(np.median([f[name] for f in found])) for name in (*LIMITS, "cpu_seconds")}
        models[kind] = {"median": median, "seeds": found}
    load = os.getloadavg()[0]
    passed = {name: models["delan"]["median"][name] <= limit for name, limit in LIMITS.items()}
    return {
        "test_letters": TEST_LETTERS,
        "published": PUBLISHED,
        "machine_load": load,
        "models": models,
        "passed": passed,
    }


def draw_figure(result: dict[str, Any], path: Path) -> None:
    """Bars of the four errors beside the published ones."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    terms = [name for name in LIMITS if name != "seconds"]
    rows = {"published DeLaN": PUBLISHED, **{k: m["median"] for k, m in result["models"].items()}}
    figure, axis = pyplot.subplots(figsize=(6, 3.4))
    for place, (name, errors) in enumerate(rows.items()):
        axis.bar(np.arange(len(terms)) + 0.25 * place, [errors[t] for t in terms], 0.25, label=name)
    axis.plot(np.arange(len(terms)) + 0.25, [LIMITS[t] for t in terms], "k_", markersize=40, label="pass line")
    axis.set(yscale="log", ylabel="mean squared error, sum of joints [N² m²]")
    axis.set_xticks(np.arange(len(terms)) + 0.25, terms)
    axis.legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    pyplot.close(figure)


def main() -> None:
    """Write result.json and figure.png; in quick mode only print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a minute, for CI: runs everything, proves nothing")
    quick = parser.parse_args().quick
    result = run(seeds=1 if quick else 5, quick=quick)
    print(json.dumps(result["passed"], indent=2))
    if not quick:
        (HERE / "result.json").write_text(json.dumps(result, indent=2) + "\n")
        draw_figure(result, HERE / "figure.png")


if __name__ == "__main__":
    main()
