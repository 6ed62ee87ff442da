"""The command `lagnet`, also as `python -m lagnet`: what Ctrl-C does from the first moment to the last."""

from __future__ import annotations

import atexit
import os
import signal
import sys
from contextlib import suppress
from types import FrameType
from typing import NoReturn

INTERRUPTED = 3
AGAIN = 0.02  # [s] after which it is asked again whether modules are still being loaded
IMPORT = "<frozen importlib._bootstrap>"
COLLECTED = ("__del__", "_xla_gc_callback")  # called by the garbage collector, which swallows what they raise


def run() -> NoReturn:
    """Runs the command line of this process and ends it with the exit code, see `lagnet.cli.main`."""
    os.environ.setdefault("NUMPY_MADVISE_HUGEPAGE", "0")  # large arrays live for milliseconds: huge pages cost more
    try:
        if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGALRM, control_c)
            signal.signal(signal.SIGINT, control_c)
        from lagnet.cli.main import main

        code = main()
    except KeyboardInterrupt:
        print("lagnet: interrupted", file=sys.stderr)
        code = INTERRUPTED
    leave(code)


def leave(code: int) -> NoReturn:
    """All is written and said: from here to the end of the process, nothing hides the exit code.

    What Python modules do at the end is done, unless the command was interrupted; then the process ends at once.
    Compiled modules are not taken down: threads of theirs that still run would abort it, with code 134 in the place of
    the command's. Python also ends by signal 2 where a Ctrl-C came inside of exec or eval, though it was handled.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.setitimer(signal.ITIMER_REAL, 0.0)
    signal.signal(signal.SIGALRM, signal.SIG_IGN)
    if code != INTERRUPTED:
        atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError):  # nobody reads any more
            stream.flush()
    os._exit(code)


def control_c(_: int, frame: FrameType | None) -> None:
    """Interrupts, but not where that would do harm or be lost; there the question is put again soon.

    Raises:
        KeyboardInterrupt: the command runs, no module is being loaded, and no garbage collected.
    """
    beside = frame is not None and frame.f_code is run.__code__  # before the command began, or after its last line
    while frame is not None:
        if beside or _unheard(frame):
            signal.setitimer(signal.ITIMER_REAL, AGAIN)
            return
        frame = frame.f_back
    raise KeyboardInterrupt


def _unheard(frame: FrameType) -> bool:
    """Whether an interruption from here crashes compiled modules that fail halfway, is swallowed, or comes too late."""
    code = frame.f_code
    return code is leave.__code__ or code.co_filename == IMPORT or code.co_name in COLLECTED


if __name__ == "__main__":
    run()
