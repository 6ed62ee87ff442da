"""The checks of data, in the order in which they run: what is set aside by one is not seen by the next."""

from lagnet.recordings.quality.check import QualityCheck
from lagnet.recordings.quality.checks.clock_unit import ClockUnit
from lagnet.recordings.quality.checks.dead_channels import DeadChannels
from lagnet.recordings.quality.checks.held_samples import HeldSamples
from lagnet.recordings.quality.checks.lost_packets import LostPackets
from lagnet.recordings.quality.checks.outliers import Outliers
from lagnet.recordings.quality.checks.position_steps import PositionSteps
from lagnet.recordings.quality.checks.quantisation import Quantisation
from lagnet.recordings.quality.checks.repeated_packets import RepeatedPackets
from lagnet.recordings.quality.checks.sensor_saturation import SensorSaturation
from lagnet.recordings.quality.checks.slow_sampling import SlowSampling
from lagnet.recordings.quality.checks.source_clock import SourceClock
from lagnet.recordings.quality.checks.stuck_channels import StuckChannels
from lagnet.recordings.quality.checks.velocity_of_positions import VelocityOfPositions

CHECKS: tuple[type[QualityCheck], ...] = (
    ClockUnit,
    DeadChannels,
    LostPackets,
    SourceClock,
    HeldSamples,
    RepeatedPackets,
    Outliers,
    StuckChannels,
    PositionSteps,
    VelocityOfPositions,
    SlowSampling,
    SensorSaturation,
    Quantisation,
)
CHECK_NAMES: tuple[str, ...] = tuple(check.name for check in CHECKS)
