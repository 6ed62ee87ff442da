"""The options that the studies on real recordings share."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

DATA = Path(__file__).resolve().parents[3] / "shared" / "data"


def parser_of(about: str | None, quick: str = "") -> argparse.ArgumentParser:
    """A parser with `--data`, and with `--quick` where a quick version is described."""
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    if quick:
        parser.add_argument("--quick", action="store_true", help=f"{quick}; writes nothing")
    default = Path(os.environ.get("LAGNET_DATA_DIR", str(DATA)))
    parser.add_argument("--data", type=Path, default=default, help="folder of the data sets (LAGNET_DATA_DIR)")
    return parser
