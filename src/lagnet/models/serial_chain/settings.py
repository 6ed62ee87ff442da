"""What to fit in a serial chain, and how long to look for it."""

from __future__ import annotations

from dataclasses import dataclass, field

from lagnet.errors import ModelError
from lagnet.models.serial_chain.mechanics.joint_terms import check_joint_terms

STANDARD_GRAVITY = 9.80665  # [m/s²]
SLOW = 0.02  # of a joint's root-mean-square speed: where Coulomb friction changes sign


@dataclass(frozen=True)
class SearchSettings:
    """How long to look.

    Args:
        batch: starts that descend together.
        least_starts: starts made before a minimum is believed that leaves more than `convincing` of the torque.
        most_starts: starts after which the best so far is taken.
        iterations: steps a start.
        convincing: share of the torque's energy; a minimum below it that two starts reached is believed at once.
        exact: share below which one start is enough and stops: no wrong shape explains torque to this precision.
        lengths: root mean square of the random offsets that the full problem starts from [m].
    """

    batch: int = 4
    least_starts: int = 24
    most_starts: int = 120
    iterations: int = 40
    convincing: float = 1e-3
    exact: float = 1e-11
    lengths: float = 0.3


@dataclass(frozen=True)
class SerialChainSettings:
    """What to fit and how.

    Args:
        joint_terms: what joints may add to the rigid arm, none for ideal torque; dropped where held-out torque does not
            ask for them.
        holdout: share of the samples kept from fitting, to choose between candidates.
        candidates: minima of the relaxed problem that are carried on where none is exact.
        reweighings: rounds of estimating each joint's noise and refitting.
        search: how long to look for the axes and lengths.
    """

    joint_terms: tuple[str, ...] = ()
    holdout: float = 0.2
    candidates: int = 3
    reweighings: int = 2
    search: SearchSettings = field(default_factory=SearchSettings)

    def __post_init__(self) -> None:
        object.__setattr__(self, "joint_terms", check_joint_terms(self.joint_terms))
        if not 0 < self.holdout < 1:
            raise ModelError(f"holdout is {self.holdout}, expected a share between 0 and 1")
