"""`mujoco.sysid` (package mujoco[sysid]) on recorded torque, given the parameters that its user would have to know.

τ = `mj_inverse` of (q, v, a) plus a constant, low-passed like the recorded torque. Free are of each moving body its
pseudo-inertia (ten numbers in the package's own chart, within its own bounds), of each joint damping, friction loss,
armature and the constant: 14 numbers a joint. The package's least squares and intervals; residuals over the root mean
square torque of each joint.
"""

from __future__ import annotations

import tempfile
from functools import partial
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from mujoco import sysid

from lagnet.diagnosis.problem.problem import Problem, Segment

ITERATIONS = 12  # of its least squares, at most
LEAST_INERTIA = 1e-6  # [kg m²] principal moment below which MuJoCo refuses a body
WIDE = 10.0  # upper bounds of joint parameters over what would explain a joint's whole torque


class MujocoSysid:
    """A fit to the fitted pieces of a problem.

    Args:
        robot: nominal model, where its least squares starts.
        problem: recordings as conditioned.

    Raises:
        ImportError: the package is there without its optional parts.
    """

    def __init__(self, robot: Any, problem: Problem) -> None:
        if not hasattr(sysid, "optimize"):  # the package hides what it could not import
            raise ImportError("mujoco is installed without its extra `sysid`")
        self.problem, self.spec = problem, _spec(robot)
        self.unit = np.sqrt(np.mean(np.concatenate([problem.reduce(p, p.tau) for p in problem.fit]) ** 2, axis=0))
        self.start = self._parameters()
        found, result = sysid.optimize(self.start, self._residual, verbose=False, max_iters=ITERATIONS, x_scale="jac")
        self.x, self.evaluated = found.as_vector(), self._residual(found.as_vector(), found)[0]
        _, self.half_widths = sysid.calculate_intervals(self.evaluated, np.asarray(result.jac))

    def torque(self, piece: Segment) -> np.ndarray:
        """Torque along a piece, shape (n, dof) [N m]."""
        model, offset = self._model(self.x, self.start.copy())
        return inverse(model, piece) + offset

    def told(self) -> dict[str, Any]:
        """What it says of the cause: numbers with intervals, and nothing else."""
        low, high = self.start.get_bounds()
        known = np.isfinite(self.half_widths)
        moved = known & (np.abs(self.x - self.start.as_vector()) > self.half_widths)
        at_bound = np.minimum(self.x - low, high - self.x) < 1e-3 * (high - low)
        return {
            "parameters_that_the_user_must_list": int(self.x.size),
            "with_an_interval": int(known.sum()),
            "intervals_without_the_nominal_value": int(moved.sum()),
            "at_a_bound": int(at_bound.sum()),
            "names_a_cause": False,
            "evidence_against_a_rival": False,
        }

    def _parameters(self) -> Any:
        model, parameters = self.spec.compile(), sysid.ParameterDict()
        pseudo = sysid.InertiaType.Pseudo
        for body in range(1, model.nbody):
            name = model.body(body).name
            change = partial(_set_body, name=name)
            parameters.add(sysid.body_inertia_param(self.spec, model, name, pseudo, modifier=change))
        speed, acceleration = (
            np.sqrt(np.mean(np.concatenate([getattr(p, n) for p in self.problem.fit]) ** 2, axis=0)) for n in "va"
        )
        for joint, name in enumerate(self.problem.joints):
            most = WIDE * self.unit[joint] / np.array([speed[joint], 1.0, acceleration[joint]])
            for field, top in zip(("damping", "frictionloss", "armature"), most, strict=True):
                change = partial(_set_joint, name=name, field=field)
                parameters.add(sysid.Parameter(f"{name}_{field}", 0.01 * top, 0.0, top, modifier=change))
            parameters.add(sysid.Parameter(f"{name}_offset", 0.0, -WIDE * self.unit[joint], WIDE * self.unit[joint]))
        return parameters

    def _model(self, x: np.ndarray, parameters: Any) -> tuple[mujoco.MjModel, np.ndarray]:
        parameters.update_from_vector(x)
        offset = np.array([parameters[f"{name}_offset"].value[0] for name in self.problem.joints])
        return sysid.apply_param_modifiers(parameters, self.spec.copy()), offset

    def _residual(self, x: np.ndarray, parameters: Any) -> tuple[list[np.ndarray], list, list]:
        """Of one vector of parameters (k,) or of several (k, m), as `sysid.optimize` asks: shape (n, …) a piece."""
        columns = [self._errors(one, parameters) for one in np.atleast_2d(np.asarray(x).T)]
        pieces = [np.column_stack(parts) for parts in zip(*columns, strict=True)]
        return [p[:, 0] if np.ndim(x) == 1 else p for p in pieces], [], []

    def _errors(self, x: np.ndarray, parameters: Any) -> list[np.ndarray]:
        model, offset = self._model(x, parameters)
        problem = self.problem
        return [(problem.reduce(p, p.tau - inverse(model, p) - offset) / self.unit)[p.counts] for p in problem.fit]


def inverse(model: mujoco.MjModel, piece: Segment) -> np.ndarray:
    """`mj_inverse` at every sample, shape (n, dof) [N m]."""
    data, out = mujoco.MjData(model), np.empty_like(piece.q)
    qpos, qvel, qacc, found = data.qpos, data.qvel, data.qacc, data.qfrc_inverse
    for row, (q, v, a) in enumerate(zip(piece.q, piece.v, piece.a, strict=True)):
        qpos[:], qvel[:], qacc[:] = q, v, a
        mujoco.mj_inverse(model, data)
        out[row] = found
    return out


def _set_body(spec: mujoco.MjSpec, parameter: Any, name: str) -> None:
    """The package's own modifier leaves an orientation that MuJoCo 4.0 does not compile beside a full inertia."""
    sysid.apply_body_inertia(spec, name, parameter)
    spec.body(name).iquat = [1.0, 0.0, 0.0, 0.0]


def _set_joint(spec: mujoco.MjSpec, parameter: Any, name: str, field: str) -> None:
    joint = spec.joint(name)
    value = float(parameter.value[0])
    if field == "damping" and not np.isscalar(joint.damping):
        joint.damping = np.r_[value, np.zeros(np.size(joint.damping) - 1)]
    else:
        setattr(joint, field, value)


def _spec(robot: Any) -> mujoco.MjSpec:
    """The nominal model without contacts and limits, bodies that MuJoCo refuses raised to the least that it takes."""
    with tempfile.TemporaryDirectory() as folder:
        robot.write_mjcf(Path(folder) / "arm.xml")
        spec = mujoco.MjSpec.from_file(str(Path(folder) / "arm.xml"))
    for body in spec.bodies[1:]:
        ixx, iyy, izz, ixy, ixz, iyz = body.fullinertia
        moments, axes = np.linalg.eigh([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
        if moments[0] < LEAST_INERTIA or moments[2] > moments[0] + moments[1]:
            raised = np.maximum(moments, LEAST_INERTIA)
            raised[2] = min(raised[2], 0.999 * (raised[0] + raised[1]))
            full = axes @ np.diag(raised) @ axes.T
            body.fullinertia = [full[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
    flags = mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_LIMIT
    spec.option.disableflags |= int(flags)
    return spec
