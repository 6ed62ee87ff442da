"""Which of several parameter sets explains recordings better, joint by joint, and what the recordings cannot decide."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.comparison.advice import Advice, advice
from lagnet.comparison.blocks import BlockSums, block_length, block_sums, stretch_errors
from lagnet.comparison.differences import Difference
from lagnet.comparison.joints import JointComparison, bootstrap_weights, judge_joint
from lagnet.comparison.resolution import Resolution, resolution
from lagnet.errors import LagnetError
from lagnet.models.corrected.model import CorrectedModel
from lagnet.recordings.conditioning.condition import condition
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.declared_friction import declared_friction
from lagnet.rigid_body.robot import Robot

ALIKE = 1e-6  # of the torque: two models of one kinematics differ by their parameters alone


@dataclass(frozen=True, eq=False)
class Comparison:
    """What recordings say of several models.

    Args:
        names: of the models.
        joints: one comparison a joint, of the bodies: offset, viscous and dry friction are fitted beside each model.
        as_published: the same with the friction that each model declares itself; None where none declares any.
        blocks: how many pieces of time the intervals rest on.
        parameters: parameters of the sets; None where the models are no robots of one kinematics.
        reason: why there are none, else "".
        to_record: what would decide the rest.
    """

    names: tuple[str, ...]
    joints: tuple[JointComparison, ...]
    as_published: tuple[JointComparison, ...] | None
    blocks: int
    parameters: Resolution | None
    reason: str
    to_record: tuple[Advice, ...]

    @property
    def differences(self) -> tuple[Difference, ...] | None:
        """Every parameter in which the sets differ, those that stand out most first."""
        found = self.parameters
        if found is None:
            return None
        said, error = found.estimate.tolist(), found.error.tolist()
        out = [
            Difference(found.names[k], found.unit(k), tuple(found.values[:, k].tolist()), said[k], error[k])
            for k in found.differing.tolist()
        ]
        return tuple(sorted(out, key=lambda d: -d.errors_apart))


def check_models(models: Sequence[Any], names: Sequence[str]) -> None:
    """Refuses what cannot be compared.

    Raises:
        LagnetError: fewer than two models, one of them twice, or other joints.
    """
    if len(models) < 2:
        raise LagnetError("one model is nothing to compare", where="--robot", next_step="give at least two")
    for i, (model, name) in enumerate(zip(models, names, strict=True)):
        if name in names[:i]:
            raise LagnetError(f"{name} is given twice", where="--robot", next_step="give sets that differ")
        if tuple(model.joints) != tuple(models[0].joints):
            raise LagnetError(f"{name} has other joints than {names[0]}", where="--robot", choices=models[0].joints)


def compare(models: Sequence[Any], names: Sequence[str], recordings: Sequence[Recording], seed: int = 0) -> Comparison:
    """Hold several models of one robot against recordings of torque.

    Args:
        models: robots, corrected or learned models with the same joints.
        names: what they are called.
        recordings: with torque.
        seed: of the bootstrap and of poses that are tried.

    Raises:
        LagnetError: fewer than two models, one of them twice, other joints, or no torque.
    """
    check_models(models, names)
    conditioned = condition(recordings)
    parts = stretch_errors(models, conditioned)
    if not parts:
        raise LagnetError("no recording is long enough to compare on", next_step="give some seconds of motion")
    length, every = block_length(parts, conditioned.rate), models[0].joints
    sums = [block_sums(parts, j, length) for j in range(models[0].n_dof)]
    blocks = len(sums[0].torque)
    weights = bootstrap_weights(blocks, seed)
    joints = tuple(_joint(name, s, weights) for name, s in zip(every, sums, strict=True))
    friction = np.array([declared_friction(m) if isinstance(m, Robot) else np.zeros((m.n_dof, 2)) for m in models])
    published = None
    if friction.any():
        own = [s.with_friction(friction[:, j]) for j, s in enumerate(sums)]
        published = tuple(_joint(name, s, weights) for name, s in zip(every, own, strict=True))
    robots, reason = _one_kinematics(models)
    if robots is None:
        return Comparison(tuple(names), joints, published, blocks, None, reason, ())
    if not all(isinstance(m, Robot) for m in models):
        friction[:] = 0.0  # a corrected model's own friction is no number of its file
    found = resolution(robots, parts, conditioned, length, friction)
    noise = np.array([np.sqrt(j.nmse[j.best]) for j in joints]) * np.std(
        np.concatenate([p.torque for p in parts]), axis=0
    )
    to_record = advice(robots[0], found, noise, seed)
    return Comparison(tuple(names), joints, published, blocks, found, "", to_record)


def _joint(name: str, sums: BlockSums, weights: np.ndarray) -> JointComparison:
    return judge_joint(name, sums.nmse(np.ones((1, weights.shape[1])))[0], sums.nmse(weights))


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
