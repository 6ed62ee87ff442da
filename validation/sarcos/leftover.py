"""What a conservative model leaves of the SARCOS torques, told by names of the catalogue. See README.md."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from sklearn.ensemble import HistGradientBoostingRegressor

from lagnet.effects.catalogue import effect_named
from lagnet.effects.motion import Motion
from lagnet.recordings.datasets.sarcos import load_sarcos
from lagnet.recordings.recording import Recording
from validation.equal_budget import trained
from validation.sarcos.study import DATA, PLAN, SECONDS, folds

HERE = Path(__file__).parent
NAMES = (  # odd in v: what mechanics cannot imitate; all else the DeLaN may have taken for its own
    "viscous_friction",
    "coulomb_friction",
    "stribeck_friction",
    "quadratic_drag",
    "load_dependent_friction",
)
SLOW = 0.05  # of the root mean square speed: below it the sign of the velocity is blurred
SURE = 2.0  # standard errors over folds by which a name must lower the error
CUTS = 10  # folds of rows in which coefficients are fitted on all others


def run(quick: bool) -> dict[str, Any]:
    """Residuals of DeLaNs on rows that they never saw, and what explains them."""
    rows = load_sarcos(DATA / "sarcos" / "sarcos_inv_test.mat")
    seen, load = unseen_torque(rows, 0.1 if quick else SECONDS, 1 if quick else None)
    motion = _motion(rows, load, seen)
    left = rows.tau[seen] - load
    return {"rows": len(left), "joints": [explained(motion, left, joint) for joint in range(rows.tau.shape[1])]}


def unseen_torque(rows: Recording, seconds: float, count: int | None) -> tuple[np.ndarray, np.ndarray]:
    """Row numbers, and the torque that a DeLaN gives for each, trained on other folds."""
    where, torque = [], []
    for seed, (train, inner, test) in enumerate(folds(rows)[:count]):
        parts = [rows.rows(np.sort(part)) for part in (train, inner)]
        model = trained([parts[0]], "delan", seconds, PLAN["delan"], seed=seed, holdout=[parts[1]]).result.model
        assert rows.v is not None
        assert rows.a is not None
        where.append(test)
        torque.append(model.inverse_dynamics(rows.q[test], rows.v[test], rows.a[test]))
        print("fold", seed, flush=True)
    return np.concatenate(where), np.concatenate(torque)


def _motion(rows: Recording, load: np.ndarray, seen: np.ndarray) -> Motion:
    """The rows as an effect sees them; their times are numbers without meaning, which these effects do not look at."""
    assert rows.v is not None
    assert rows.a is not None
    q, v, a = (x[seen] for x in (rows.q, rows.v, rows.a))
    slow = SLOW * np.sqrt(np.mean(v**2, axis=0))
    return Motion(np.arange(len(q), dtype=float), q, v, a, load, slow, None)


def explained(motion: Motion, left: np.ndarray, joint: int) -> dict[str, Any]:
    """Names that lower the error of one joint on rows not fitted to, and what no name could better."""
    target = left[:, joint] - left[:, joint].mean()
    cuts = np.array_split(np.random.default_rng(joint).permutation(len(target)), CUTS)
    nothing = np.zeros((len(target), 0))
    whole = _errors(nothing, target, cuts)
    names, errors = _chosen({name: _forms(motion, name, joint) for name in NAMES}, nothing, target, cuts)
    ceiling = _errors_of_trees(motion, target, cuts)
    shares = {"explained": errors, "ceiling": ceiling}
    return {"names": names, **{word: float(1.0 - x.mean() / whole.mean()) for word, x in shares.items()}}


def _chosen(
    forms: dict[str, list[np.ndarray]], columns: np.ndarray, target: np.ndarray, cuts: Sequence[np.ndarray]
) -> tuple[list[str], np.ndarray]:
    """One name after the other, the best first, as long as one lowers the error beyond chance; errors by fold."""
    names: list[str] = []
    errors = _errors(columns, target, cuts)
    while forms:
        tried = {name: _best(columns, each, target, cuts) for name, each in forms.items()}
        name = min(tried, key=lambda n: tried[n][0].mean())
        gain = errors - tried[name][0]
        if gain.mean() <= SURE * gain.std(ddof=1) / np.sqrt(len(cuts)):
            break
        errors, columns = tried[name]
        names.append(name)
        forms = {other: each for other, each in forms.items() if other != name}
    return names, errors


def _forms(motion: Motion, name: str, joint: int) -> list[np.ndarray]:
    effect = effect_named(name)
    return [effect.columns(motion, joint, shape).reshape(len(motion.q), -1) for shape in effect.shapes(motion, joint)]


def _best(
    columns: np.ndarray, forms: Sequence[np.ndarray], target: np.ndarray, cuts: Sequence[np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    """Errors by fold and columns with the form that adds most."""
    wider = [np.hstack([columns, form]) for form in forms]
    found = [(_errors(x, target, cuts), x) for x in wider]
    return min(found, key=lambda pair: pair[0].mean())


def _errors(columns: np.ndarray, target: np.ndarray, cuts: Sequence[np.ndarray]) -> np.ndarray:
    """Mean squared error of each fold, coefficients fitted on the others."""
    out = []
    for cut in cuts:
        rest = np.setdiff1d(np.arange(len(target)), cut, assume_unique=True)
        coefficients = np.linalg.lstsq(columns[rest], target[rest], rcond=None)[0]
        out.append(np.mean((target[cut] - columns[cut] @ coefficients) ** 2))
    return np.array(out)


def _errors_of_trees(motion: Motion, target: np.ndarray, cuts: Sequence[np.ndarray]) -> np.ndarray:
    """The same for boosted trees on (q, v, a): what any smooth function of the row could tell."""
    state, out = np.hstack([motion.q, motion.v, motion.a]), []
    for cut in cuts:
        rest = np.setdiff1d(np.arange(len(target)), cut, assume_unique=True)
        trees = HistGradientBoostingRegressor(max_iter=200, random_state=0).fit(state[rest], target[rest])
        out.append(np.mean((target[cut] - trees.predict(state[cut])) ** 2))
    return np.array(out)


def main() -> None:
    """Write leftover.json; in quick mode only print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a minute, for CI: runs everything, proves nothing")
    quick = parser.parse_args().quick
    result = run(quick)
    for joint, found in enumerate(result["joints"]):
        print(joint, found)
    if not quick:
        (HERE / "leftover.json").write_text(json.dumps(result, indent=2) + "\n")


if __name__ == "__main__":
    main()
