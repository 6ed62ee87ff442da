"""The command `lagnet`, also as `python -m lagnet`: Ctrl-C is one line even while modules are loaded."""

from __future__ import annotations

import sys

INTERRUPTED = 3


def run() -> int:
    """Runs the command line of this process.

    Returns:
        The exit code, see `lagnet.cli.main`.
    """
    try:
        from lagnet.cli.main import main

        return main()
    except KeyboardInterrupt:
        print("lagnet: interrupted", file=sys.stderr)
        return INTERRUPTED


if __name__ == "__main__":
    sys.exit(run())
