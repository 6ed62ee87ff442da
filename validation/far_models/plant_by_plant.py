"""The command line of a study that takes its plants one after the other and keeps what it has after each."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

QUICK = 1  # plants


def run(
    parser: argparse.ArgumentParser,
    studied: Callable[[int], dict[str, Any]],
    summary: Callable[[list[dict[str, Any]]], dict[str, Any]],
    told: Sequence[str],
    full: int,
    home: Path,
) -> dict[str, Any]:
    """Study the plants that the command line asks for, write the result, and give its summary.

    Args:
        parser: of the command line, with `--quick` for one plant.
        studied: figures of a plant by its number.
        told: those that are printed.
        full: plants of a whole run.
        home: folder of the result file.
    """
    parser.add_argument("--plants", type=int, default=full)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    plants: list[dict[str, Any]] = []
    out = given.out or (None if given.quick else home / "result.json")
    for number in range(given.first, given.first + (QUICK if given.quick else given.plants)):
        plants.append({"plant": number, **studied(number)})
        print({k: plants[-1][k] for k in ("plant", *told)}, flush=True)
        if out:  # after each, so that a run that is cut keeps what it has
            text = json.dumps({"summary": summary(plants), "plants": plants}, indent=1)
            out.write_text(text + "\n", encoding="utf-8")
    figures = summary(plants)
    print(json.dumps(figures, indent=1))
    return figures
