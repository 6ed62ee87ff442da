"""One trial: a command, an empty folder or one with a finished result, an interruption, and what stands there then."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from validation.kills.commands import Command, finish
from validation.kills.interrupt import Ended, Interruption, interrupted
from validation.kills.standing import CHECKPOINT, broken_promises, digests, drafts, finished, half_written

SOONER = 0.8  # of the time before, where a signal came after the end
REASON = "File too large"  # what the system says of a file that is larger than it may be


@dataclass(frozen=True)
class Reference:
    """What an uninterrupted run of a command wrote.

    Args:
        command: the run that is interrupted.
        new: digests of what it writes.
        old: folder with the finished result of another run of the same command, None for an empty folder.
    """

    command: Command
    new: Mapping[str, str]
    old: Path | None = None


@dataclass(frozen=True)
class Row:
    """What came of one interruption.

    Args:
        command, into_finished, kind, since_writing, moment: what was done; the moment in s, or in bytes on a full disk.
        code, said: exit code and what was said on standard error.
        half_written: files under final names that do not parse.
        lost: files that are neither those of the finished result that was there nor those of the new run, or are gone.
        mixed: whether files of both runs stand side by side.
        drafts: that were left over.
        claims: whether the folder claims to be finished; unkept: what it does not keep then.
        clean: whether the command ended with the promised code and one line.
        checkpoint: whether a training left one; same_weights: whether the same command, run again to its end, gave the
            weights of the run that was not disturbed; None where that was not asked.
    """

    command: str
    into_finished: bool
    kind: str
    since_writing: bool
    moment: float
    code: int
    said: str
    half_written: tuple[str, ...]
    lost: tuple[str, ...]
    mixed: bool
    drafts: int
    claims: bool
    unkept: str
    clean: bool
    checkpoint: bool | None = None
    same_weights: bool | None = None

    @property
    def faultless(self) -> bool:
        """Whether nothing was damaged, lost or said badly."""
        damaged = bool(self.half_written or self.lost or self.mixed or self.unkept)
        return self.clean and not damaged and self.same_weights is not False


def tried(reference: Reference, draw: Callable[[float], Interruption], folder: Path, contracts: Path | None) -> Row:
    """Interrupts, drawing again and sooner where the command had ended before, and looks at what stands there."""
    out, sooner = folder / "out", 1.0
    while True:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        if reference.old:
            shutil.copytree(reference.old, out)
        by = draw(sooner)
        ended = interrupted(reference.command, out, by)
        if ended.felt:
            return _looked_at(reference, by, ended, out, contracts)
        sooner *= SOONER


def _looked_at(reference: Reference, by: Interruption, ended: Ended, out: Path, contracts: Path | None) -> Row:
    name, old = reference.command.name, digests(reference.old) if reference.old else {}
    now, half = digests(out), tuple(half_written(out))
    strange = {n for n in now if now[n] not in (old.get(n), reference.new.get(n))}
    of_old = {n for n in now if now[n] == old.get(n) != reference.new.get(n)}
    of_new = {n for n in now if now[n] == reference.new.get(n) != old.get(n)}
    claims = not half and finished(name, out)
    unfinished_model = name == "train" and not old and not claims  # the best so far, and no other run's
    lost = (set() if unfinished_model else strange) | (set(old) - set(now))
    checkpoint = same = None
    unkept = broken_promises(name, out, contracts) if claims else ""
    if old and not claims:
        unkept = "the finished result is no more"
    if name == "train" and not old:
        checkpoint = any(CHECKPOINT in path.name for path in out.glob("*"))
        finish(reference.command, out)
        same = digests(out) == reference.new
    said = ended.said.strip().replace(str(out), out.name)
    return Row(
        *(name, bool(old), by.kind, by.since_writing, by.largest or round(by.after, 3), ended.code, said, half),
        *(tuple(sorted(lost)), bool(of_old and of_new), drafts(out), claims, unkept),
        *(clean(by.kind, ended, out, claims), checkpoint, same),
    )


def clean(kind: str, ended: Ended, out: Path, complete: bool) -> bool:
    """Whether a command ended as promised: the code, and one line that says what happened, and where on a full disk."""
    said, lines = ended.said.strip(), ended.said.strip().splitlines()
    refused = ended.code == 2 and len(lines) == 1 and "not empty" in said  # by simulate, as without an interruption
    if kind == "kill -9":
        return ended.code == -9
    if kind == "Ctrl-C":
        told = sum("interrupted" in line for line in (*lines, *ended.printed.splitlines()))
        done = ended.code == 0 and complete and not said
        return done or refused or (ended.code == 3 and told == 1 and len(lines) <= 1)
    return refused or (ended.code == 2 and len(lines) == 1 and str(out) in said and REASON in said)
