"""A limit on processor time: without its rules a diagnosis may weigh so many names that it comes to no end."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

PATIENCE = 90.0  # [s] of processor time, thirty times what a diagnosis takes


@contextmanager
def patience(seconds: float = PATIENCE) -> Iterator[None]:
    """Ends what takes longer, in the main thread.

    Raises:
        TimeoutError: so much processor time was spent.
    """

    def stop(signal_number: int, frame: FrameType | None) -> None:
        raise TimeoutError(f"no end after {seconds:g} s of processor time")

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)
