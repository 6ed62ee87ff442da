"""The command `lagnet`, also as `python -m lagnet`: Ctrl-C is one line even while modules are loaded."""

from __future__ import annotations

import signal
import sys

INTERRUPTED = 3


def run() -> int:
    """Runs the command line of this process.

    Returns:
        The exit code, see `lagnet.cli.main`.
    """
    try:
        from lagnet.cli.main import main

        code = main()
        # All is written and said; while the interpreter ends, Ctrl-C would kill it and hide the exit code.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        return code
    except KeyboardInterrupt:
        print("lagnet: interrupted", file=sys.stderr)
        return INTERRUPTED


if __name__ == "__main__":
    sys.exit(run())
