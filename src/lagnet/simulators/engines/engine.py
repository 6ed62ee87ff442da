"""What replay asks of an engine: start somewhere, take commanded torques, say where the joints are."""

from __future__ import annotations

from abc import ABC, abstractmethod
from pathlib import Path
from types import TracebackType
from typing import ClassVar

from lagnet.types import JointVector


class Engine(ABC):
    """A loaded model that moves; torques are those that a log holds, positions those of encoders.

    Args of final classes: the folder that an exporter wrote, and the step [s].
    """

    name: ClassVar[str]

    @abstractmethod
    def put(self, q: JointVector, v: JointVector) -> None:
        """Start at positions and speeds, shape (dof,) [rad, rad/s]."""

    @abstractmethod
    def read(self) -> tuple[JointVector, JointVector]:
        """Positions and speeds, shape (dof,) [rad, rad/s]."""

    @abstractmethod
    def advance(self, torque: JointVector, seconds: float) -> None:
        """Let time pass under a commanded torque, shape (dof,) [N m]."""

    def close(self) -> None:
        """Give back what the engine holds."""
        return

    def __enter__(self) -> Engine:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def steps_of(seconds: float, step: float) -> int:
    """Steps that make up a time; at least one."""
    return max(1, round(seconds / step))


def first_model(folder: Path) -> Path:
    """The model file of an export."""
    return next(p for name in ("model.xml", "model.urdf") if (p := folder / name).is_file())
