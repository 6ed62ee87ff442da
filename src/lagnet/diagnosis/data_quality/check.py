"""What a check against a torque model is: another reading of the recordings under which they fit the model."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from lagnet.diagnosis.data_quality.misfit import misfits, whole
from lagnet.diagnosis.data_quality.samples import Samples, thinned
from lagnet.types import InverseDynamics

FEW = 160  # samples at which readings are compared
MANY = 1200  # at which the best are
FITS = 0.2  # misfit of a reading that counts as fitting
BETTER = 0.35  # of the misfit as recorded, and of what a mounting and a load leave, that a reading may leave


@dataclass(frozen=True, eq=False)
class Evidence:
    """Recordings and a model as the checks see them.

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
        """Samples for judging one."""
        return thinned(self.series, MANY)

    @cached_property
    def misfits(self) -> np.ndarray:
        """Misfit of each joint as recorded, shape (dof,)."""
        return misfits(self.many, self.model.inverse_dynamics(self.many.q, self.many.v, self.many.a))

    @cached_property
    def as_recorded(self) -> float:
        """Geometric mean of the misfits as recorded."""
        return float(whole(self.misfits))

    def accepts(self, reading: Reading) -> bool:
        """Whether a reading fits, and the recordings as they are do not."""
        return reading.misfit < min(FITS, BETTER * self.as_recorded)


@dataclass(frozen=True)
class Reading:
    """Another reading of the recordings.

    Args:
        check: name of the check that tried it.
        channel: columns that are read otherwise.
        misfit: geometric mean over the joints under this reading.
        detail: what was seen.
        mend: lines of the mapping file, or the step, that mend it.
        prior: by which the misfit of a reading is raised, for readings that are less usual than others.
    """

    check: str
    channel: str
    misfit: float
    detail: str
    mend: str
    prior: float = 1.0


class ReadingCheck(ABC):
    """One way to read recordings otherwise. A variant is a new file in `checks/` and a line in `CHECKS`."""

    name: ClassVar[str]
    title: ClassVar[str]
    always: ClassVar[bool] = False  # also tried where the recordings fit the model as they are
    last: ClassVar[bool] = False  # tried only where no other reading fits

    @abstractmethod
    def readings(self, evidence: Evidence) -> Iterator[Reading]:
        """The best readings of this kind, judged on many samples."""
