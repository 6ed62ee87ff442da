"""A reading check: another interpretation of the recorded columns, tested by its misfit to the torque model."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from lagnet.diagnosis.data_quality.misfit import geometric_mean, misfits
from lagnet.diagnosis.data_quality.samples import Samples, thinned
from lagnet.types import InverseDynamics

FEW = 160  # samples on which all readings are compared
MANY = 1200  # samples on which the best of them are
FITS = 0.2  # largest misfit of a reading that fits
BETTER = 0.35  # largest misfit of a reading over that as recorded, and over that with another mounting and body
EXPLAINED = 0.6  # misfit below which the model explains a joint
WORSE = 2.0  # misfit above which a joint speaks against the model
LEAST_JOINTS = 0.5  # share of the joints that must speak for or against a reading


@dataclass(frozen=True, eq=False)
class Evidence:
    """Smoothed recordings and a model, with the misfits that several checks need.

    Args:
        model: the nominal model.
        series: smoothed stretches of the recordings.
    """

    model: InverseDynamics
    series: tuple[Samples, ...]

    @cached_property
    def few(self) -> Samples:
        """Samples for comparing many readings."""
        return thinned(self.series, FEW)

    @cached_property
    def many(self) -> Samples:
        """Samples for the best of them."""
        return thinned(self.series, MANY)

    @cached_property
    def misfits(self) -> np.ndarray:
        """Misfit of each joint as recorded, shape (dof,)."""
        return misfits(self.many, self.model.inverse_dynamics(self.many.q, self.many.v, self.many.a))

    @cached_property
    def as_recorded(self) -> float:
        """Geometric mean of the misfits as recorded."""
        return float(geometric_mean(self.misfits))

    def accepts(self, reading: Reading) -> bool:
        """Whether a reading fits, and far better than the recordings as they are."""
        return reading.agreed or fits_far_better(reading.misfits, self.misfits)


def fits_far_better(misfits: np.ndarray, others: np.ndarray) -> bool:
    """Whether misfit < FITS and misfit / other < BETTER, as geometric means over the joints that tell the two apart.

    A joint whose torque the model explains neither way, such as a wrist of which it knows no friction, tells nothing.
    Of an arm one joint is not enough: what it lacks may look so.

    Args:
        misfits, others: of each joint in two interpretations, shape (dof,).
    """
    telling = (np.fmin(misfits, others) < EXPLAINED) | ~(np.fmax(misfits, others) < WORSE)
    if telling.sum() < min(2, telling.size) or telling.mean() < LEAST_JOINTS:
        return False
    misfit = float(geometric_mean(misfits[telling]))
    return misfit < min(FITS, BETTER * float(geometric_mean(others[telling])))


@dataclass(frozen=True, eq=False)
class Reading:
    """Another interpretation of recorded columns, with its misfit.

    Args:
        check: name of the check that proposes it.
        channel: columns that are interpreted otherwise.
        misfits: of each joint under this reading, shape (dof,).
        detail: sentence on what was found.
        mend: lines of the mapping file, or the step, that correct it.
        prior: factor on the misfit, above 1 for readings that are less common than others.
        agreed: whether the joints, each judged alone, agree on it: then no other model is compared.
    """

    check: str
    channel: str
    misfits: np.ndarray
    detail: str
    mend: str
    prior: float = 1.0
    agreed: bool = False

    @property
    def misfit(self) -> float:
        """Geometric mean of the misfits over all joints."""
        return float(geometric_mean(self.misfits))


class ReadingCheck(ABC):
    """One kind of reading. A variant is a new file in `checks/` and a line in `CHECKS`."""

    name: ClassVar[str]
    title: ClassVar[str]
    always: ClassVar[bool] = False  # also tried where the recordings fit the model as they are
    last: ClassVar[bool] = False  # tried only where no other reading fits

    @abstractmethod
    def readings(self, evidence: Evidence) -> Iterator[Reading]:
        """The best readings of this kind, their misfit on `evidence.many`."""
