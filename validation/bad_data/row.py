"""What comes of one corruption when it is diagnosed by the public call: refusal, sentences, names, time."""

from __future__ import annotations

import time
from collections.abc import Collection
from dataclasses import dataclass

import lagnet
from lagnet.errors import LagnetError
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import Robot
from validation.bad_data.corruptions import Corruption


@dataclass(frozen=True)
class Row:
    """What came of one corruption.

    Args:
        arm, corruption: what was corrupted and how.
        seconds: wall time of the whole diagnosis.
        cpu_seconds: processor time of the same, which is what it takes on a machine of its own.
        refused: the sentence, or "".
        told: sentences of the verdict's `data_quality`.
        cause_told: whether one of them, or the refusal, names the cause.
        names: effects that were named, with their joint; None where no diagnosis was made.
        wrong_names: number of those that are not among the right ones.
        lost_names: number of the right ones that were not named, where a diagnosis was made.
    """

    arm: str
    corruption: str
    seconds: float
    cpu_seconds: float
    refused: str
    told: tuple[str, ...]
    cause_told: bool
    names: tuple[str, ...] | None
    wrong_names: int
    lost_names: int = 0

    @property
    def answered(self) -> bool:
        """Whether the cause was told, or the right diagnosis made."""
        return self.cause_told or (self.names is not None and not self.wrong_names and bool(self.names))


def names_of(verdict) -> tuple[str, ...]:
    """Each named effect with its joint."""
    return tuple(f"{e.effect} at {e.joint}" for e in verdict.effects)


def diagnosed(
    robot: Robot, arm: str, corruption: Corruption, recordings: list[Recording], right: Collection[str]
) -> Row:
    """Diagnoses corrupted recordings.

    Args:
        robot: nominal model.
        arm: its name.
        corruption: what was done to the recordings.
        recordings: as they are after it.
        right: names that a diagnosis may give, as by `names_of`.
    """
    began, cpu, refused, told, names = time.perf_counter(), time.process_time(), "", (), None
    try:
        verdict = lagnet.diagnose(recordings, robot=robot).verdict
        names = names_of(verdict)
        told = tuple(d["detail"] for d in verdict.data_quality)
    except LagnetError as error:
        refused = str(error)
    seconds, cpu = time.perf_counter() - began, time.process_time() - cpu
    cause = any(word in text for text in (refused, *told) for word in corruption.words)
    wrong = len(set(names or ()) - set(right))
    lost = 0 if names is None else len(set(right) - set(names))
    row = Row(arm, corruption.name, seconds, cpu, refused, told, cause, names, wrong, lost)
    state = "answered" if row.answered else "NOT ANSWERED"
    print(f"{arm:13} {row.corruption:36} {cpu:6.1f} s  {state}, {wrong} wrong, {lost} lost", flush=True)
    return row
