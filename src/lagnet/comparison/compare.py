"""Which of several parameter sets explains recordings better, joint by joint, and what the recordings cannot decide."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.comparison.advice import Advice, advice
from lagnet.comparison.blocks import block_length, block_sums, stretch_errors
from lagnet.comparison.resolution import Resolution, resolution
from lagnet.errors import LagnetError
from lagnet.models.corrected.model import CorrectedModel
from lagnet.recordings.conditioning.condition import condition
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.descriptions.writing import write_text
from lagnet.rigid_body.robot import Robot

DRAWS = 2000
LEVEL = (2.5, 97.5)  # percentiles of an interval
SCHEMA, FILE = "lagnet-compare/1", "compare.json"
ALIKE = 1e-6  # of the torque: two models of one kinematics differ by their parameters alone


@dataclass(frozen=True, eq=False)
class JointComparison:
    """One joint.

    Args:
        joint: name.
        nmse: shape (models,), error over the torque's scatter, friction and offset fitted beside each.
        interval: shape (models, 2), 95 %.
        against_best: shape (models, 2), 95 % of a model's error less that of the best.
        best: index of the model with the smallest error.
        also: indices of models that are not told from it.
    """

    joint: str
    nmse: np.ndarray
    interval: np.ndarray
    against_best: np.ndarray
    best: int
    also: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Comparison:
    """What recordings say of several models.

    Args:
        names: of the models.
        joints: one comparison a joint.
        blocks: how many pieces of time the intervals rest on.
        parameters: base parameters of the sets; None where the models are no robots of one kinematics.
        reason: why there are none, else "".
        to_record: what would decide the rest.
    """

    names: tuple[str, ...]
    joints: tuple[JointComparison, ...]
    blocks: int
    parameters: Resolution | None
    reason: str
    to_record: tuple[Advice, ...]


def compare(models: Sequence[Any], names: Sequence[str], recordings: Sequence[Recording], seed: int = 0) -> Comparison:
    """Hold several models of one robot against recordings.

    Args:
        models: robots, corrected or learned models with the same joints.
        names: what they are called.
        recordings: with torque.
        seed: of the bootstrap and of poses that are tried.

    Raises:
        LagnetError: fewer than two models, or other joints.
    """
    if len(models) < 2:
        raise LagnetError("one model is nothing to compare", where="--robot", next_step="give at least two")
    for model, name in zip(models, names, strict=True):
        if tuple(model.joints) != tuple(models[0].joints):
            raise LagnetError(f"{name} has other joints than {names[0]}", where="--robot", choices=models[0].joints)
    conditioned = condition(recordings)
    parts = stretch_errors(models, conditioned)
    if not parts:
        raise LagnetError("no recording is long enough to compare on", next_step="give some seconds of motion")
    length = block_length(parts, conditioned.rate)
    sums = [block_sums(parts, j, length) for j in range(models[0].n_dof)]
    blocks = len(sums[0].torque)
    weights = np.random.default_rng(seed).multinomial(blocks, np.full(blocks, 1.0 / blocks), size=DRAWS).astype(float)
    joints = tuple(
        _joint(name, s.nmse(np.ones((1, blocks)))[0], s.nmse(weights))
        for name, s in zip(models[0].joints, sums, strict=True)
    )
    robots, reason = _one_kinematics(models)
    if robots is None:
        return Comparison(tuple(names), joints, blocks, None, reason, ())
    found = resolution(robots, parts, conditioned, length)
    noise = np.array([np.sqrt(j.nmse[j.best]) for j in joints]) * np.std(
        np.concatenate([p.torque for p in parts]), axis=0
    )
    return Comparison(tuple(names), joints, blocks, found, "", advice(robots[0], found, noise, seed))


def _joint(name: str, nmse: np.ndarray, draws: np.ndarray) -> JointComparison:
    best = int(np.argmin(nmse))
    interval = np.percentile(draws, LEVEL, axis=0).T
    worse = np.percentile(draws - draws[:, [best]], LEVEL, axis=0).T
    also = tuple(int(m) for m in range(len(nmse)) if m != best and worse[m, 0] <= 0.0)
    return JointComparison(name, nmse, interval, worse, best, also)


def _one_kinematics(models: Sequence[Any]) -> tuple[list[Robot] | None, str]:
    """The bodies of all models, if they differ by their inertial parameters alone."""
    robots = [_bodies(m) for m in models]
    if not all(isinstance(r, Robot) for r in robots):
        return None, "not every model has bodies whose parameters could be compared"
    rng = np.random.default_rng(0)
    q, v, a = rng.uniform(-1.0, 1.0, (3, 20, models[0].n_dof))
    first = robots[0]
    table = first.joint_torque_regressor(q, v, a)
    for robot in robots[1:]:
        by_parameters = table @ robot.inertial_parameters().ravel() + robot.armature * a
        torque = robot.inverse_dynamics(q, v, a)
        if np.max(np.abs(by_parameters - torque)) > ALIKE * max(float(np.max(np.abs(torque))), 1e-12):
            return None, "the models differ in kinematics, gravity or mounting, not in parameters alone"
    return robots, ""


def _bodies(model: Any) -> Any:
    return model.bodies() if isinstance(model, CorrectedModel) and hasattr(model, "inertial_parameters") else model


def to_json(result: Comparison) -> dict[str, Any]:
    """Plain data."""
    out: dict[str, Any] = {
        "schema": SCHEMA,
        "models": list(result.names),
        "blocks": result.blocks,
        "joints": [
            {
                "joint": j.joint,
                "best": result.names[j.best],
                "not_told_from_best": [result.names[m] for m in j.also],
                "models": [
                    {
                        "model": result.names[m],
                        "nmse": float(j.nmse[m]),
                        "ci95": [float(x) for x in j.interval[m]],
                        "above_best_ci95": [float(x) for x in j.against_best[m]],
                    }
                    for m in range(len(result.names))
                ],
            }
            for j in result.joints
        ],
        "parameters": None if result.parameters is None else _parameters(result.names, result.parameters),
        "parameters_missing_because": result.reason or None,
        "to_record": [{"words": a.words(), "enough": a.is_enough} | _plain(a) for a in result.to_record],
    }
    return out


def _plain(entry: Advice) -> dict[str, Any]:
    return {
        "parameter": entry.parameter,
        "motion": entry.motion,
        "joint": entry.joint,
        "pose_rad": list(entry.pose),
        "difference_nm": entry.difference,
        "noise_nm": entry.noise,
    }


def _parameters(names: tuple[str, ...], found: Resolution) -> list[dict[str, Any]]:
    resolved = set(found.resolved.tolist())
    return [
        {
            "parameter": found.names[k],
            "values": {name: float(found.values[m, k]) for m, name in enumerate(names)},
            "recordings_say": None if not np.isfinite(found.estimate[k]) else float(found.estimate[k]),
            "standard_error": None if not np.isfinite(found.error[k]) else float(found.error[k]),
            "resolved": k in resolved,
        }
        for k in found.differing.tolist()
    ]


def write_comparison(result: Comparison, folder: str | Path) -> Path:
    """Writes `compare.json`."""
    path = Path(folder) / FILE
    write_text(path, json.dumps(to_json(result), indent=1, allow_nan=False) + "\n")
    return path
