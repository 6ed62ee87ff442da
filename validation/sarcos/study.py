"""SARCOS arm, 5-fold on the rows of the public test file: four models side by side. See README.md."""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.recordings.datasets.sarcos import load_sarcos
from lagnet.recordings.recording import Recording
from lagnet.training.settings import TrainingSettings
from validation.equal_budget import trained

HERE = Path(__file__).parent
DATA = Path(os.environ.get("LAGNET_DATA_DIR", HERE.parents[2] / "shared" / "data"))
RESULT = HERE / "result.json"
FOLDS, INNER = 5, 0.1  # folds of all rows, a seed each; share of training rows to stop by
SECONDS = 9.0  # processor time of the steps of one training, the same for every model
PLAN: dict[str, TrainingSettings] = {  # chosen on the inner rows of the first fold
    "delan": TrainingSettings(),
    "delan-blackbox": TrainingSettings(weight_decay=0.1),
    "ffnn": TrainingSettings(weight_decay=0.5),
    "delan-ffnn": TrainingSettings(weight_decay=1.0, separation="stages"),
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


def run(quick: bool, kinds: Sequence[str]) -> dict[str, Any]:
    """Mean squared error of each joint on rows that no training saw, every row judged once."""
    rows = load_sarcos(DATA / "sarcos" / "sarcos_inv_test.mat")
    cuts = folds(rows)[: 1 if quick else FOLDS]
    models: dict[str, Any] = {} if len(kinds) == len(PLAN) else json.loads(RESULT.read_text())["models"]
    for kind in kinds:
        found = [_fold(rows, cut, kind, seed, 0.1 if quick else SECONDS) for seed, cut in enumerate(cuts)]
        errors = np.array([f["mse_by_joint"] for f in found])
        models[kind] = {"mse_by_joint": errors.mean(axis=0).tolist(), "sum": float(errors.sum(axis=1).mean())}
        models[kind] |= {"spread": float(errors.sum(axis=1).std(ddof=1)) if len(found) > 1 else None, "folds": found}
        print(kind, models[kind]["sum"], models[kind]["spread"], flush=True)
    return {"rows": len(rows), "models": models, "passed": judge(models)}


def judge(models: dict[str, Any]) -> dict[str, bool]:
    """The pass line of README.md."""
    ours = models["delan-ffnn"]["sum"]
    return {f"delan-ffnn below {k}": ours < m["sum"] for k, m in models.items() if k != "delan-ffnn"}


def _fold(rows: Recording, cut: tuple[np.ndarray, ...], kind: str, seed: int, seconds: float) -> dict[str, Any]:
    """Errors on the rows held out, and what the training took."""
    seen, inner, test = (rows.rows(np.sort(part)) for part in cut)
    done = trained([seen], kind, seconds, PLAN[kind], seed=seed, holdout=[inner])
    model, stats = done.result.model, done.result.stats
    assert test.v is not None
    assert test.a is not None
    error = model.inverse_dynamics(test.q, test.v, test.a) - test.tau
    outside = model.residual_torque(test.q, test.v, test.a)
    return {
        "mse_by_joint": np.mean(error**2, axis=0).tolist(),
        "sum": float(np.mean(error**2, axis=0).sum()),
        "outside_mechanics": (outside.var(axis=0) / test.tau.var(axis=0)).tolist(),
        **{name: stats[name] for name in ("seed", "steps", "kept_step")},
        "cpu_seconds": done.cpu_seconds,
    }


def draw_figure(result: dict[str, Any], path: Path) -> None:
    """Mean squared error by joint and model, as in Table 1 of the paper."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axis = pyplot.subplots(figsize=(7, 3.4))
    for place, (kind, found) in enumerate(result["models"].items()):
        errors = found["mse_by_joint"]
        axis.bar(np.arange(len(errors)) + 0.2 * place, errors, 0.2, label=f"{kind} (sum {found['sum']:.1f})")
    axis.set(yscale="log", xlabel="joint", ylabel="mean squared error [N² m²]")
    axis.legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    pyplot.close(figure)


def main() -> None:
    """Write result.json and figure.png; in quick mode only print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a minute, for CI: runs everything, proves nothing")
    parser.add_argument("--only", choices=PLAN, help="train this model anew and keep the results of the others")
    given = parser.parse_args()
    quick = given.quick
    result = run(quick, [given.only] if given.only else list(PLAN))
    print(json.dumps(result["passed"], indent=2))
    if not quick:
        RESULT.write_text(json.dumps(result, indent=2) + "\n")
        draw_figure(result, HERE / "figure.png")


if __name__ == "__main__":
    main()
