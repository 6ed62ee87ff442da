"""Writes generation after generation of a diagnosis-like folder and of a learned model, until it is killed."""

from __future__ import annotations

import sys
from pathlib import Path

from lagnet.files import finite_json, write_folder_whole, write_whole

SIZE = 400_000  # numbers: a file that takes some time


def main(folder: Path) -> None:
    """Never returns."""
    generation, numbers = 0, finite_json([1.5] * SIZE, indent=None).strip()
    while True:
        generation += 1
        text = f'{{"generation": {generation}, "numbers": {numbers}, "end": {generation}}}'
        write_folder_whole(folder / "corrected", lambda made, text=text: _fill(made, text))
        write_whole(folder / "verdict.json", text)


def _fill(made: Path, text: str) -> None:
    for name in ("corrected.json", "nominal.json"):
        write_whole(made / name, text)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
