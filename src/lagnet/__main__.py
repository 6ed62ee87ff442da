"""`python -m lagnet`: the same as the command `lagnet`."""

import sys

from lagnet.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
