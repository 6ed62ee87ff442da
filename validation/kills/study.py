"""Kills a writing process at random moments and looks at what stands under final names.

python -m validation.kills.study            # writes result.json
python -m validation.kills.study --quick    # ten kills, writes nothing
"""

from __future__ import annotations

import argparse
import json
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from lagnet.files import PART, finite_json, write_whole

KILLS, QUICK, SEED = 100, 10, 0
SIGNALS = (signal.SIGKILL, signal.SIGINT, signal.SIGTERM)


def main() -> None:
    """Runs the study."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    quick = parser.parse_args().quick
    figures = kills(QUICK if quick else KILLS, SEED)
    print(figures)
    assert not figures["half_written"] + figures["missing"]
    if not quick:
        write_whole(Path(__file__).with_name("result.json"), finite_json({"figures": figures}))


def kills(count: int, seed: int) -> dict[str, int]:
    """So many kills of one writer after another in the same folder."""
    rng, before = np.random.default_rng(seed), {}
    figures = dict.fromkeys(("kills", "half_written", "missing", "left_over_parts"), 0)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for _ in range(count):
            _killed(folder, rng)
            figures["kills"] += 1
            found = {path: _generation(folder / path) for path in _names()}
            figures["half_written"] += sum(g == -1 for g in found.values())
            figures["missing"] += sum(g is None and path in before for path, g in found.items())
            before = {path: g for path, g in found.items() if g is not None}
        figures["left_over_parts"] = sum(PART in path.name for path in folder.iterdir())
    return figures


def _names() -> tuple[str, ...]:
    return "verdict.json", "corrected/corrected.json", "corrected/nominal.json"


def _killed(folder: Path, rng: np.random.Generator) -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "validation.kills.writer", str(folder)], stderr=subprocess.DEVNULL
    )
    begun = time.perf_counter()
    stamp = (folder / "verdict.json").stat().st_mtime if (folder / "verdict.json").exists() else 0.0
    while time.perf_counter() - begun < 30 and not _written_since(folder / "verdict.json", stamp):
        time.sleep(0.01)
    time.sleep(float(rng.uniform(0.0, 0.15)))
    process.send_signal(SIGNALS[int(rng.integers(len(SIGNALS)))])
    process.wait()


def _written_since(path: Path, stamp: float) -> bool:
    return path.exists() and path.stat().st_mtime > stamp


def _generation(path: Path) -> int | None:
    """The generation of a whole file, -1 of half of one, None where there is none."""
    try:
        said = json.loads(path.read_text(encoding="utf-8"))
        return int(said["generation"]) if said["end"] == said["generation"] else -1
    except FileNotFoundError:
        return None
    except (ValueError, KeyError):
        return -1


if __name__ == "__main__":
    main()
