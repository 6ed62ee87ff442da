"""SARCOS arm, 5-fold on the rows of the public test file: four models side by side. See README.md."""

from __future__ import annotations

import argparse
import json
import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.models.kinds import AugmentedSettings
from lagnet.models.torque_network import TorqueNetworkSettings
from lagnet.recordings.recording import Recording
from lagnet.recordings.sarcos import load_sarcos
from lagnet.training.settings import TrainingSettings
from lagnet.training.train import train

HERE = Path(__file__).parent
DATA = Path(os.environ.get("LAGNET_DATA_DIR", HERE.parents[2] / "shared" / "data"))
FOLDS, INNER = (
    5,
    0.1,
)  # folds of all rows, a seed each; share of training rows to stop by
SMALL = TorqueNetworkSettings(hidden=(64, 64))
MODELS: dict[str, Any] = {
    "delan": (None, TrainingSettings(steps=1500)),
    "delan-blackbox": (None, TrainingSettings(steps=1500, learning_rate=3e-3)),
    "ffnn": (SMALL, TrainingSettings(steps=1500, learning_rate=3e-3)),
    "delan-ffnn": (AugmentedSettings(residual=SMALL), TrainingSettings(steps=1500, learning_rate=3e-3, penalty=1e-4)),
}


def folds(rows: Recording) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """(train, inner, test) rows of each fold, no row in two of the three."""
    order = np.random.default_rng(0).permutation(len(rows))
    out = []
    for test in np.array_split(order, FOLDS):
        rest = np.setdiff1d(order, test, assume_unique=True)
        inner = rest[: int(INNER * len(rest))]
        out.append((rest[len(inner) :], inner, test))
    return out


def run(quick: bool) -> dict[str, Any]:
    """Mean squared error of each joint on rows that no training saw, every row judged once."""
    rows = load_sarcos(DATA / "sarcos" / "sarcos_inv_test.mat")
    cuts = folds(rows)[: 1 if quick else FOLDS]
    models: dict[str, Any] = {}
    for kind, (settings, training) in MODELS.items():
        training = replace(training, steps=100) if quick else training
        found = [_fold_error(rows, cut, kind, settings, training, seed) for seed, cut in enumerate(cuts)]
        by_joint = np.mean(found, axis=0)
        sums = [float(np.sum(f)) for f in found]
        models[kind] = {"mse_by_joint": by_joint.tolist(), "sum": float(by_joint.sum()), "sum_by_fold": sums}
        print(kind, models[kind], flush=True)
    sums = {kind: m["sum"] for kind, m in models.items()}
    return {"folds": len(cuts), "rows": len(rows), "models": models, "passed": judge(sums)}


def judge(sums: dict[str, float]) -> dict[str, bool]:
    """The pass line of README.md."""
    return {f"delan-ffnn below {k}": sums["delan-ffnn"] < s for k, s in sums.items() if k != "delan-ffnn"}


def _fold_error(
    rows: Recording, cut: tuple[np.ndarray, ...], kind: str, settings: Any, training: TrainingSettings, seed: int
) -> np.ndarray:
    seen, inner, test = (rows.rows(np.sort(part)) for part in cut)
    model = train([seen], kind, seed=seed, holdout=[inner], settings=settings, training=training).model
    assert test.v is not None
    assert test.a is not None
    return np.mean((model.inverse_dynamics(test.q, test.v, test.a) - test.tau) ** 2, axis=0)


def draw_figure(result: dict[str, Any], path: Path) -> None:
    """Mean squared error by joint and model, as in Table 1 of the paper."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axis = pyplot.subplots(figsize=(7, 3.4))
    for place, (kind, found) in enumerate(result["models"].items()):
        errors = found["mse_by_joint"]
        axis.bar(np.arange(len(errors)) + 0.2 * place, errors, 0.2, label=f"{kind} (sum {found['sum']:.2f})")
    axis.set(yscale="log", xlabel="joint", ylabel="mean squared error [N² m²]")
    axis.legend(fontsize=7)
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
        draw_figure(result, HERE / "figure.png")


if __name__ == "__main__":
    main()
