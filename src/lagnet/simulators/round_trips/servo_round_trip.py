"""The same position commands to a servo-driven model and to its export in an engine: how far the two motions part."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

from lagnet.models.corrected.servo_driven import ServoDrivenModel
from lagnet.simulators.corrected_arm.servo_arm import servo_arm
from lagnet.simulators.engines.servo_engines import servo_engine
from lagnet.simulators.servo_exporters.registry import SERVO_EXPORTERS
from lagnet.types import JointVector, Samples, Trajectory

FINE = 5e-5  # [s], step of the model's own rollouts


def rolled_out(model: ServoDrivenModel, time: Samples, sent: Trajectory, q0: JointVector) -> Trajectory:
    """The model's own motion, shape (n, dof) [rad]."""
    return model.rollout(sent, time, q0, step=FINE)


def servo_engine_motion(
    model: ServoDrivenModel,
    exporter: str,
    engine: str,
    given: tuple[Samples, Trajectory, JointVector],
    step: float,
) -> Trajectory:
    """The motion of what an exporter writes, in an engine; given: times, commands and start; shape (n, dof) [rad]."""
    time, sent, q0 = given
    out = np.empty_like(sent)
    with tempfile.TemporaryDirectory() as folder:
        SERVO_EXPORTERS[exporter].write(servo_arm(model), Path(folder))
        with servo_engine(engine, Path(folder), step) as running:
            running.put(q0, np.zeros_like(q0))
            for k in range(time.size):
                out[k], _ = running.read()
                running.advance(sent[k], float(time[1] - time[0]))
    return out
