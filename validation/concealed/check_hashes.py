"""Hold the envelopes and verdicts of a run against the hashes that were published: python -m ... check_hashes FOLDER"""

from __future__ import annotations

import hashlib
import sys
from pathlib import Path


def broken(folder: Path) -> list[str]:
    """Files whose bytes are not what was published, or that are missing."""
    wrong = []
    for listing, inside in (("seals.sha256", "envelopes"), ("witnesses.sha256", "witnesses"), ("verdicts.sha256", "")):
        for line in (folder / listing).read_text().splitlines():
            published, name = line.split("  ", 1)
            file = folder / inside / name
            if published == "failed":
                continue
            if not file.exists() or hashlib.sha256(file.read_bytes()).hexdigest() != published:
                wrong.append(str(file))
    return wrong


if __name__ == "__main__":
    found = broken(Path(sys.argv[1]))
    closed = [name for name in found if not Path(name).exists()]
    print("\n".join(f"not as published: {name}" for name in found if name not in closed) or "every hash holds")
    if closed:
        print(f"{len(closed)} files are not there: a run that is not finished, or files that were taken away")
    sys.exit(bool(found))
