"""CMA-ES over the parameters that public tools fit, four a joint and two of the arm, by rollouts of recordings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from cmaes import CMA

from lagnet.models.corrected.servo_driven import ServoDrivenModel
from lagnet.recordings.recording import Recording
from lagnet.servos.parameters import INDEX, law_vector

OF_JOINT = (("kp", 0.05, 50.0), ("viscous", 0.005, 10.0), ("coulomb", 0.001, 2.0), ("rotor", 1e-4, 0.1))
OF_ARM = (("delay", 1e-3, 0.1), ("load_driving", 1e-3, 2.0))


def fitted_by_search(
    robot: Any,
    recordings: Sequence[Recording],
    gains: Sequence[float],
    joints: Sequence[int],
    evaluations: int,
    seed: int,
    step: float,
) -> ServoDrivenModel:
    """The robot with the laws of the best of so many evaluations; parameters are searched by their logarithms."""
    table = [*OF_JOINT] * len(joints) + [*OF_ARM]
    low, high = (np.log(np.array([row[k] for row in table])) for k in (1, 2))
    search = CMA(mean=(low + high) / 2.0, sigma=1.0, bounds=np.stack([low, high], axis=1), seed=seed)
    best, best_error, done = search.mean, np.inf, 0
    while done < evaluations:
        told = []
        for _ in range(search.population_size):
            x = search.ask()
            error = _error(_model(robot, joints, x), recordings, gains, joints, step)
            told.append((x, error))
            if error < best_error:
                best, best_error = x, error
        search.tell(told)
        done += search.population_size
    return _model(robot, joints, best)


def _model(robot: Any, joints: Sequence[int], x: np.ndarray) -> ServoDrivenModel:
    values, laws = np.exp(x), np.tile(law_vector(viscous=1.0), (robot.n_dof, 1))
    for n, joint in enumerate(joints):
        for k, (name, _, _) in enumerate(OF_JOINT):
            laws[joint, INDEX[name]] = values[len(OF_JOINT) * n + k]
    laws[:, INDEX["delay"]] = values[-2]
    laws[:, [INDEX["load_driving"], INDEX["load_driven"]]] = values[-1]
    return ServoDrivenModel(robot, laws, (True,) * robot.n_dof)


def _error(
    model: ServoDrivenModel, recordings: Sequence[Recording], gains: Sequence[float], joints: Sequence[int], step: float
) -> float:
    total, count = 0.0, 0
    for recording, gain in zip(recordings, gains, strict=True):
        q = rolled(model, recording, gain, step)[:, joints]
        total += float(np.sum((q - recording.q[:, joints]) ** 2))
        count += q.size
    return total / count


def rolled(model: ServoDrivenModel, recording: Recording, gain: float, step: float) -> np.ndarray:
    """The whole recording from its first sample by its commands alone, shape (n, dof)."""
    signals = {"enabled": recording.enabled, "voltage": recording.voltage, "gain": gain, "step": step}
    return model.rollout(np.array(recording.command), recording.time, recording.q[0], **signals)
