"""What an effect sees of a recording: motion on an even clock, and the torque that the nominal model gives for it."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, field, replace
from typing import Any, cast

import numpy as np

from lagnet.effects.rest import blurred_sign, held_direction
from lagnet.rigid_body.changed_bodies_torque import torque_of_change
from lagnet.rigid_body.inertia import is_physically_consistent
from lagnet.rigid_body.robot import Robot
from lagnet.types import JointVector, RigidBodyModel, RobotModel, Samples, Trajectory, inertial_parameters_of

BODIES = "torque of bodies"  # key of the last parameters and torque of each body: little, however long the motion


@dataclass(frozen=True, eq=False)
class Motion:
    """One uninterrupted stretch of motion.

    Args:
        time: shape (n,), [s].
        q, v, a: shape (n, dof), smoothed joint motion [rad, rad/s, rad/s²].
        load: shape (n, dof), torque that the model with all effects so far gives [N m].
        slow: shape (dof,), speed below which the sign of the velocity is blurred [rad/s]; the ε of s(v).
        model: the nominal model, an `InverseDynamics`; effects that change bodies ask `bodies` or `robot` for it.
        recorded: shape (n, dof), recorded torque, low-passed [N m]; None where there is no recording.
        held: shape (dof,), share of the dry friction that stays while a joint rests; None: none, or no order.
        recording: which of the recordings under diagnosis it is a part of; None: none of them.
        straight: shape (dof,), whether s(v) rises in a straight line to ±1 instead of along tanh; None: nowhere.
        cache: shared store of regressors that several effects need.
    """

    time: Samples
    q: Trajectory
    v: Trajectory
    a: Trajectory
    load: Trajectory
    slow: JointVector
    model: Any
    recorded: Trajectory | None = None
    held: JointVector | None = None
    recording: int | None = None
    straight: np.ndarray | None = None
    cache: dict = field(default_factory=dict, repr=False)

    @property
    def bodies(self) -> RigidBodyModel:
        """The nominal model, for effects that need its regressor; they are asked for none where it has none."""
        return cast(RigidBodyModel, self.model)

    @property
    def robot(self) -> RobotModel:
        """The nominal model, for effects that need its frames; they are asked for none where it has none."""
        return cast(RobotModel, self.model)

    @property
    def n_dof(self) -> int:
        """Number of joints."""
        return self.q.shape[1]

    def direction(self, joint: int) -> np.ndarray:
        """s(v) of one joint, shape (n,): the sign of the velocity, without a jump at zero."""
        straight = self.straight is not None and bool(self.straight[joint])
        direction = blurred_sign(self.v[:, joint], self.slow[joint], straight)
        if self.held is None or not self.held[joint] > 0:
            return direction
        return held_direction(self.time, self.v[:, joint], self.slow[joint], direction, self.held[joint])

    def with_load(self, load: Trajectory) -> Motion:
        """The same motion under another model torque."""
        return replace(self, load=load)

    def link_parameters(self, joint: int) -> np.ndarray:
        """Inertial parameters of the modelled link behind one joint, shape (10,); zeros without any."""
        has_links = hasattr(self.model, "inertial_parameters")
        return inertial_parameters_of(self.model)[joint] if has_links else np.zeros(10)

    def link_regressor(self, joint: int) -> np.ndarray:
        """Torque per unit of each inertial parameter of the body behind one joint, shape (n, dof, 10)."""
        whole = getattr(self.model, "joint_torque_regressor", None)
        if whole is None:
            return self.remembered(f"link_{joint}", lambda: self.bodies.link_regressor(joint, self.q, self.v, self.a))

        def links() -> list[np.ndarray]:  # one link costs as much as all
            columns = whole(self.q, self.v, self.a)
            return [np.ascontiguousarray(columns[..., 10 * k : 10 * k + 10]) for k in range(self.n_dof)]

        return self.remembered("links", links)[joint]

    def body_torque(self, joint: int, parameters: np.ndarray) -> np.ndarray:
        """Torque of a body behind one joint, shape (n, dof) [N m]: its regressor times its ten inertial parameters.

        Where the regressor is not known yet, by Newton–Euler, and kept; a body that is asked for again with other
        parameters has its own regressor from then on.
        """
        if "links" in self.cache or not isinstance(self.model, Robot):
            return np.asarray(self.link_regressor(joint) @ parameters)
        model, last = self.model, self.remembered(BODIES, dict)
        if joint in last and np.array_equal(last[joint][0], parameters):
            return np.asarray(last[joint][1])
        if ("asked", joint) in self.cache:
            own = self.remembered(("columns", joint), lambda: model.link_regressor(joint, self.q, self.v, self.a))
            return np.asarray(own @ parameters)
        change = np.zeros((self.n_dof, parameters.size))
        change[joint] = parameters
        torque = torque_of_change(model, change, self.q, self.v, self.a)
        torque.setflags(write=False)
        self.cache["asked", joint], last[joint] = True, (parameters.copy(), torque)
        return torque

    def body_alone(self, joint: int, parameters: np.ndarray) -> Robot | None:
        """The arm with one body behind a joint and no other, without rotors.

        None where the change is no real body, or the model holds more than bodies, as a corrected one does.
        """
        if not isinstance(self.model, Robot) or not is_physically_consistent(parameters):
            return None
        bodies = np.zeros((self.n_dof, 10))
        bodies[joint] = parameters
        return self.model.with_armature(np.zeros(self.n_dof)).with_inertial_parameters(bodies)

    def remembered(self, key: Hashable, make: Any) -> Any:
        """The value of `make()`, kept for the other effects that ask for the same key."""
        if key not in self.cache:
            self.cache[key] = make()
        return self.cache[key]
