"""FIGAROH (package figaroh) on recorded torque: base parameters by weighted least squares, and its consistent fit.

It is given the motion as the diagnosis conditions it. Torque and regressor go through its own decimation filter, whose
cut-off is close to the band of the diagnosis. Friction, actuator inertia and joint offset are switched on; which of
them an arm needs its user has to know.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from figaroh.data.trajectory import JOINT_FORCE, JOINT_TORQUE, TrajectoryData
from figaroh.identification import BaseIdentification
from figaroh.identification.selection import run_physical_fit
from figaroh.tools.regressor import build_regressor_basic, build_regressor_reduced
from figaroh.tools.robot import Robot

from lagnet.diagnosis.problem.problem import OVERSAMPLING, Problem, Segment

MOST_AT_ONCE = 12  # factor of decimation in one go that its filter can do
CONFIG = """
robot: {{name: arm, properties: {{joints: {{active_joints: [{joints}]}}, mechanics: {{}}}}}}
tasks:
  identification:
    type: dynamic_identification
    problem:
      use_joint_torques: true
      qr_relative_tolerance: 1.0e-4
      model_components: {{friction: true, actuator_inertia: true, joint_offset: true}}
    signal_processing: {{sampling_frequency: {rate}, cutoff_frequency: {band}}}
    physical_fit: {{enabled: false, max_seconds: 120}}
"""


class _Identification(BaseIdentification):
    """The subclass that FIGAROH asks of its user: where the data comes from, and that it is conditioned already."""

    def __init__(self, robot: Robot, config: str, data: TrajectoryData) -> None:
        super().__init__(robot, config)
        self.given = data
        self.identif_config |= {"act_idxq": list(range(robot.model.nq)), "act_idxv": list(range(robot.model.nv))}

    def load_trajectory_data(self, data_source: str | None = None) -> TrajectoryData:
        return self.given

    def process_kinematics_data(self, filter_config: Any = None) -> None:
        self.processed_data = dict(self.raw_data)


class Figaroh:
    """A fit to the fitted pieces of a problem.

    Args:
        robot: nominal model.
        problem: recordings as conditioned.
    """

    def __init__(self, robot: Any, problem: Problem) -> None:
        with tempfile.TemporaryDirectory() as folder:
            urdf, config = Path(folder) / "arm.urdf", Path(folder) / "arm.yaml"
            robot.write_bare_urdf(urdf)
            text = CONFIG.format(joints=", ".join(problem.joints), rate=problem.rate, band=problem.bandwidth)
            config.write_text(text)
            model = Robot(str(urdf), folder)
            self.own = _Identification(model, str(config), _trajectory(robot, problem))
        self.own.initialize()
        step = max(2, min(MOST_AT_ONCE, int(problem.rate / (OVERSAMPLING * problem.bandwidth))))
        self.own.solve(decimation_factor=step, plotting=False, wls=True)
        self.physical: dict[str, Any] | None = None

    def fit_consistent(self) -> None:
        """Its second way: all parameters, physically consistent, by semidefinite programming."""
        self.physical = run_physical_fit(self.own)

    def torque(self, piece: Segment) -> np.ndarray:
        """Torque of the base parameters along a piece, shape (n, dof) [N m]."""
        reduced = build_regressor_reduced(self._regressor(piece), self.own._idx_eliminated)
        return self._by_joint(reduced[:, self.own._base_indices] @ self.own.phi_base, piece)

    def consistent_torque(self) -> Callable[[Segment], np.ndarray] | None:
        """Torque of the physically consistent parameters; None where it rejects them itself."""
        found = self.physical
        if found is None or not found["accepted"]:
            return None
        values = np.asarray(found["record"].theta)
        return lambda piece: self._by_joint(self._regressor(piece) @ values, piece)

    def told(self) -> dict[str, Any]:
        """What it says of the cause: base parameters with relative standard deviations, and nothing else."""
        spread = np.asarray(self.own.result["wls_std_deviations"], dtype=float)
        standard = len(self.own.standard_parameter)
        return {
            "parameters_that_the_user_must_list": standard,
            "base_parameters": len(self.own.params_base),
            "combinations_of_several_parameters": sum(" " in name for name in self.own.params_base),
            "with_a_standard_deviation_below_30_percent": int((spread < 30.0).sum()),
            "physical_fit": None if self.physical is None else str(self.physical["reason"]),
            "names_a_cause": False,
            "evidence_against_a_rival": False,
        }

    def _regressor(self, piece: Segment) -> np.ndarray:
        return build_regressor_basic(self.own.robot, piece.q, piece.v, piece.a, self.own.identif_config)

    def _by_joint(self, stacked: np.ndarray, piece: Segment) -> np.ndarray:
        return stacked.reshape(piece.q.shape[1], len(piece.q)).T


def _trajectory(robot: Any, problem: Problem) -> TrajectoryData:
    """The fitted pieces one after the other; samples that do not count, and seams, masked."""
    masks = []
    for p in problem.fit:
        mask = np.zeros(len(p.time), dtype=bool)
        mask[p.keep[0] : p.keep[-1] + 1] = True
        masks.append(mask)
    q, v, a, tau = (np.concatenate([getattr(p, name) for p in problem.fit]) for name in ("q", "v", "a", "tau"))
    slides = [kind == "prismatic" for kind in robot.joint_types]
    return TrajectoryData(
        t=np.arange(len(q)) / problem.rate,
        joint_names=problem.joints,
        q=q,
        dq=v,
        ddq=a,
        effort=tau,
        effort_kind=[JOINT_FORCE if s else JOINT_TORQUE for s in slides],
        effort_unit=["N" if s else "N·m" for s in slides],
        mask=np.concatenate(masks),
    )
