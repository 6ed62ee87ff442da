"""The command `lagnet`, also as `python -m lagnet`: what Ctrl-C does from the first moment to the last."""

from __future__ import annotations

import os
import signal
import sys
from types import FrameType

INTERRUPTED = 3
AGAIN = 0.02  # [s] after which it is asked again whether modules are still being loaded
IMPORT = "<frozen importlib._bootstrap>"


def run() -> int:
    """Runs the command line of this process.

    Returns:
        The exit code, see `lagnet.cli.main`.
    """
    try:
        if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGALRM, control_c)
            signal.signal(signal.SIGINT, control_c)
        from lagnet.cli.main import main

        code = main()
    except KeyboardInterrupt:
        print("lagnet: interrupted", file=sys.stderr)
        code = INTERRUPTED
    return leave(code)


def leave(code: int) -> int:
    """All is written and said: from here to the end of the interpreter, nothing hides the exit code.

    An interrupted interpreter is left at once: Python ends one by signal 2 whose Ctrl-C came inside of exec or eval,
    though it was handled, and JAX may crash while it is taken down in the middle of its work.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.setitimer(signal.ITIMER_REAL, 0.0)
    signal.signal(signal.SIGALRM, signal.SIG_IGN)
    if code == INTERRUPTED:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
    return code


def control_c(_: int, frame: FrameType | None) -> None:
    """Interrupts, but neither while a module is loaded, which compiled ones crash of, nor beside the command.

    Raises:
        KeyboardInterrupt: the command runs and no module is being loaded; otherwise the question is put again soon,
            which an interpreter that ends no longer hears.
    """
    beside = frame is not None and frame.f_code is run.__code__  # before the command began, or after its last line
    while frame is not None:
        if beside or frame.f_code is leave.__code__ or frame.f_code.co_filename == IMPORT:
            signal.setitimer(signal.ITIMER_REAL, AGAIN)
            return
        frame = frame.f_back
    raise KeyboardInterrupt


if __name__ == "__main__":
    sys.exit(run())
