"""The readings that are tested, in order. One a file."""

from lagnet.diagnosis.data_quality.check import ReadingCheck
from lagnet.diagnosis.data_quality.checks.another_robot import AnotherRobot
from lagnet.diagnosis.data_quality.checks.clock_scale import ClockScale
from lagnet.diagnosis.data_quality.checks.joint_order import JointOrder
from lagnet.diagnosis.data_quality.checks.position_unit import PositionUnit
from lagnet.diagnosis.data_quality.checks.torque_lag import TorqueLag

CHECKS: tuple[type[ReadingCheck], ...] = (
    JointOrder,
    ClockScale,
    PositionUnit,
    TorqueLag,
    AnotherRobot,
)
CHECK_NAMES: tuple[str, ...] = tuple(check.name for check in CHECKS)
