"""What a training said on its way: errors by joint over steps and time."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, replace


@dataclass(frozen=True)
class Report:
    """State of a training after some steps.

    Args:
        step: gradient steps done; total: all that are planned.
        seconds: wall-clock since the start, compilation included; left: estimate of what remains.
        loss: mean over the last steps of what is being lowered.
        train, held_out: torque error of each joint as a share of its variance, on training and held-out samples.
    """

    step: int
    total: int
    seconds: float
    left: float
    loss: float
    train: tuple[float, ...]
    held_out: tuple[float, ...]

    def line(self) -> str:
        """One plain line for a log."""
        joints = " ".join(f"{x:.1e}" for x in self.held_out)
        return (
            f"step {self.step}/{self.total}  loss {self.loss:.2e}  held out by joint {joints}  {self.left:.0f} s left"
        )


@dataclass
class History:
    """All reports of a training, in order, and which step was kept."""

    reports: list[Report] = field(default_factory=list)
    kept_step: int = 0
    stopped_early: bool = False
    interrupted: bool = False

    def plain(self) -> list[dict]:
        """All reports as plain values, for a checkpoint."""
        return [asdict(report) for report in self.reports]

    @staticmethod
    def of_plain(values: list[dict]) -> History:
        """The history of which `plain` gave the reports.

        Raises:
            TypeError: these are none.
        """
        reports = [Report(**value) for value in values]
        return History([replace(r, train=tuple(r.train), held_out=tuple(r.held_out)) for r in reports])

    def followed_by(self, later: History) -> History:
        """This training and one that went on from its result, counted through."""
        done = self.reports[-1].step if self.reports else 0
        spent = self.reports[-1].seconds if self.reports else 0.0
        shifted = [
            replace(r, step=r.step + done, total=r.total + done, seconds=r.seconds + spent) for r in later.reports
        ]
        kept = later.kept_step + done
        return History([*self.reports, *shifted], kept, later.stopped_early, later.interrupted)
