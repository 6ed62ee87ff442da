"""Hold verdicts against opened envelopes: names, joints, parameters, and the share of the true law's gain."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

from validation.plants.blind import BlindResult
from validation.plants.body import joint_names
from validation.plants.spec import Hidden, PlantSpec

LARGEST_TIE = 3  # names in a tie, the first included, that still count as an answer


@dataclass(frozen=True)
class Score:
    """One plant's verdict against its truth.

    Args:
        plant, robot: of which.
        hidden: (effect, joint) that were hidden.
        claims: (effect, joint, names tied with it) that were claimed.
        found: hidden effects that a claim on the right joint names, alone or in a tie of at most three.
        named_alone: hidden effects that a claim names without a tie.
        joint_right, joint_judged: of the claims that name a hidden effect, those on its joint, and all.
        wrong: claims that match nothing hidden, alone or in their tie.
        halves: claims beside another that matches the same hidden effect, as an offset beside Coulomb friction, both
            tied with friction that differs by direction.
        errors: relative parameter errors of the effects named, by "effect.parameter".
        covered: whether the 95 % interval holds the truth, by "effect.parameter".
        gain_share: gain in held-out error reached, over the true law's; None where nothing was hidden.
        seconds: wall time.
        failure: why there is no verdict.
    """

    plant: str
    robot: str
    hidden: list[tuple[str, str | None]]
    claims: list[tuple[str, str | None, list[str]]]
    found: int = 0
    named_alone: int = 0
    joint_right: int = 0
    joint_judged: int = 0
    wrong: int = 0
    halves: int = 0
    errors: dict[str, float] = field(default_factory=dict)
    covered: dict[str, bool] = field(default_factory=dict)
    gain_share: float | None = None
    seconds: float = 0.0
    failure: str = ""


def score(spec: PlantSpec, result: BlindResult, beyond: np.ndarray) -> Score:
    """Score one plant.

    Args:
        spec: the opened envelope.
        result: the verdict.
        beyond: shape (n, dof), what the held-out torque truly has beyond the nominal bodies [N m].
    """
    hidden = [(h.effect, h.joint) for h in spec.hidden]
    if result.verdict is None:
        return Score(spec.name, spec.robot, hidden, [], seconds=result.seconds, failure=result.message)
    effects = result.verdict["effects"]
    claims = [(e["effect"], e["joint"], list(e["tied_with"])) for e in effects]
    pairs = _pairs(spec.hidden, effects)
    named = [(h, e) for h, e in pairs if e["effect"] == h.effect]
    near = [e for e in effects if any(h.effect in _names(e) for h in spec.hidden)]
    errors, covered = {}, {}
    for h, e in named:
        for key, error, inside in _parameters(h, e):
            if np.isfinite(error):
                errors[f"{h.effect}.{key}"] = error
            if inside is not None:
                covered[f"{h.effect}.{key}"] = inside
    return Score(
        spec.name,
        spec.robot,
        hidden,
        claims,
        found=len(pairs),
        named_alone=sum(not e["tied_with"] for _, e in named),
        joint_right=sum(any(h.effect in _names(e) and h.joint == e["joint"] for h in spec.hidden) for e in near),
        joint_judged=len(near),
        **_unpaired(hidden, claims, len(pairs)),
        errors=errors,
        covered=covered,
        gain_share=_gain_share(spec.robot, result.folder, beyond) if spec.hidden else None,
        seconds=result.seconds,
    )


def _unpaired(
    hidden: list[tuple[str, str | None]], claims: list[tuple[str, str | None, list[str]]], pairs: int
) -> dict:
    """Claims that are not paired with a hidden effect: wrong ones, and second halves of a tie that holds the truth."""
    matching = sum(
        any((name, joint) in hidden for name in ([effect, *tied] if len(tied) < LARGEST_TIE else [effect]))
        for effect, joint, tied in claims
    )
    return {"wrong": len(claims) - matching, "halves": matching - pairs}


def score_again(kept: dict) -> Score:
    """A score of a result file with its claims held against the truth anew."""
    hidden = [(effect, joint) for effect, joint in kept["hidden"]]
    claims = [(effect, joint, list(tied)) for effect, joint, tied in kept["claims"]]
    return Score(**kept | {"hidden": hidden, "claims": claims} | _unpaired(hidden, claims, kept["found"]))


def _names(claim: dict) -> list[str]:
    names = [claim["effect"], *claim["tied_with"]]
    return names if len(names) <= LARGEST_TIE else names[:1]


def _pairs(hidden: tuple[Hidden, ...], claims: list[dict]) -> list[tuple[Hidden, dict]]:
    """Hidden effects and the claims that name them on their joint, one to one, exact names first."""
    pairs: list[tuple[Hidden, dict]] = []
    for exact in (True, False):
        for h in hidden:
            if any(h is taken for taken, _ in pairs):
                continue
            free = [e for e in claims if e["joint"] == h.joint and not any(e is taken for _, taken in pairs)]
            fits = [e for e in free if (e["effect"] == h.effect if exact else h.effect in _names(e))]
            pairs += [(h, fits[0])] if fits else []
    return pairs


def _parameters(h: Hidden, claim: dict) -> list[tuple[str, float, bool | None]]:
    """(name, relative error, whether the interval holds the truth) of each parameter that both sides have."""
    given = {p["name"]: p for p in claim["parameters"]}
    out: list[tuple[str, float, bool | None]] = []
    groups = (("cx", "cy", "cz"), ("theta_1", "theta_2"), ("Fx", "Fy", "Fz"), ("px", "py", "pz"))
    for group in groups:  # vectors: a small component has no error of its own
        if all(k in given and k in h.values for k in group):
            true = np.array([h.values[k] for k in group])
            seen = np.array([given[k]["value"] for k in group])
            out.append(("+".join(group), float(np.linalg.norm(seen - true) / np.linalg.norm(true)), None))
            out += [(k, np.nan, _inside(h.values[k], given[k])) for k in group]
    done = {name for name, _, _ in out}
    for name, value in h.values.items():
        if name in given and name not in done:
            scale = 1.0 if name == "q0" else abs(value)  # a rest position is an angle: its zero means nothing
            out.append((name, abs(given[name]["value"] - value) / scale, _inside(value, given[name])))
    return out


def _inside(value: float, parameter: dict) -> bool:
    return bool(parameter["ci95"][0] <= value <= parameter["ci95"][1])


def _gain_share(robot: str, folder: Path, beyond: np.ndarray) -> float:
    """Gain of the named physics over the gain of the true extra torque, on the raw held-out samples, all joints."""
    table = pq.read_table(folder / "holdout_torque.parquet").to_pydict()
    reached = possible = 0.0
    for j in range(len(joint_names(robot))):
        measured, nominal, corrected = (np.array(table[f"tau_{k}_{j}"]) for k in ("measured", "nominal", "corrected"))
        power = np.var(measured)
        before = np.mean((measured - nominal) ** 2)
        reached += (before - np.mean((measured - corrected) ** 2)) / power
        possible += (before - np.mean((measured - nominal - beyond[:, j]) ** 2)) / power
    return float(reached / possible)


def summary(scores: list[Score]) -> dict:
    """The figures that pass lines are drawn through."""
    hidden = sum(len(s.hidden) for s in scores)
    found, wrong = sum(s.found for s in scores), sum(s.wrong for s in scores)
    claims = sum(len(s.claims) for s in scores)
    empty = [s for s in scores if not s.hidden]
    errors = np.array([e for s in scores for e in s.errors.values()])
    covered = [c for s in scores for c in s.covered.values()]
    gains = np.array([s.gain_share for s in scores if s.gain_share is not None])
    judged = sum(s.joint_judged for s in scores)
    return {
        "plants": len(scores),
        "failures": [f"{s.plant}: {s.failure}" for s in scores if s.failure],
        "hidden_effects": hidden,
        "recall": found / hidden if hidden else None,
        "recall_named_alone": sum(s.named_alone for s in scores) / hidden if hidden else None,
        "precision": (claims - wrong) / claims if claims else None,
        "wrong_share": wrong / claims if claims else 0.0,
        "unpaired_share": (claims - found) / claims if claims else 0.0,
        "right_joint": sum(s.joint_right for s in scores) / judged if judged else None,
        "plants_without_physics": len(empty),
        "claims_on_plants_without_physics": sum(len(s.claims) for s in empty),
        "median_parameter_error": float(np.median(errors)) if errors.size else None,
        "interval_coverage": float(np.mean(covered)) if covered else None,
        "median_gain_share": float(np.median(gains)) if gains.size else None,
        "share_of_plants_with_gain_over_95_percent": float(np.mean(gains >= 0.95)) if gains.size else None,
        "median_seconds": float(np.median([s.seconds for s in scores])),
    }


def confusion(scores: list[Score]) -> dict[str, dict[str, int]]:
    """How often each hidden effect was answered by each name; "nothing" where no claim on its joint was made."""
    table: dict[str, dict[str, int]] = {}
    for s in scores:
        for effect, joint in s.hidden or [("nothing", None)]:
            here = [c for c in s.claims if c[1] == joint or effect == "nothing"]
            right = [c for c in here if effect in (c[0], *c[2])]
            answer = effect if right else (here[0][0] if here else "nothing")
            row = table.setdefault(effect, {})
            row[answer] = row.get(answer, 0) + 1
    return table
