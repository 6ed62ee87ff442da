"""One interruption of a running command: a signal at a moment, or a disk that is full from some byte on."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from validation.kills.commands import PATIENCE, POLL, Command, environment, stamp

KINDS = ("kill -9", "Ctrl-C", "full disk")
# A process that a shell starts in the background ignores Ctrl-C, and would hand this on.
START = """import os, resource, signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
if int(sys.argv[1]):
    resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[1]),) * 2)
os.execv(sys.argv[2], sys.argv[2:])
"""


@dataclass(frozen=True)
class Interruption:
    """What happens to a command.

    Args:
        kind: of `KINDS`.
        after: [s] at which the signal is sent.
        since_writing: whether that counts from the first change in the output folder, not from the start.
        largest: of a file, in bytes, on the disk that is full.
    """

    kind: str
    after: float = 0.0
    since_writing: bool = False
    largest: int = 0


@dataclass(frozen=True)
class Ended:
    """How a command ended.

    Args:
        felt: whether it was still running when the signal came; True for a full disk.
        code: exit code, negative for a signal.
        printed: standard output.
        said: standard error.
        seconds: wall time.
    """

    felt: bool
    code: int
    printed: str
    said: str
    seconds: float


def interrupted(command: Command, out: Path, by: Interruption) -> Ended:
    """Runs a command and interrupts it."""
    before, began = stamp(out), time.perf_counter()
    with subprocess.Popen(
        [sys.executable, "-c", START, str(by.largest), *command.line(out)],
        cwd=command.inputs,
        env=environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        felt = True
        if by.kind != "full disk":
            felt = _signalled(process, out, before, by)
        try:
            printed, said = process.communicate(timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            process.kill()
            printed, said = process.communicate()
            said += "\nwent on after the interruption"
    felt = felt and (by.kind != "kill -9" or process.returncode == -signal.SIGKILL)  # else it had ended just before
    return Ended(felt, process.returncode, printed, said, time.perf_counter() - began)


def _signalled(process: subprocess.Popen, out: Path, before: tuple, by: Interruption) -> bool:
    began = time.perf_counter()
    if by.since_writing:
        while process.poll() is None and stamp(out) == before:
            time.sleep(POLL)
        began = time.perf_counter()
    try:
        process.wait(max(0.0, by.after - (time.perf_counter() - began)))
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGKILL if by.kind == "kill -9" else signal.SIGINT)
        return True
    return False
