"""What stands under the final names of an output folder: whole or half, and of which run."""

from __future__ import annotations

import hashlib
import json
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow.csv
import pyarrow.parquet

from lagnet.files import PART
from lagnet.models.files.saving import load_model

CHECKPOINT = "checkpoint"
SAID_LAST = {"diagnose": "verdict.json", "train": "model.json", "simulate": "trajectory_1.csv"}
NOT_COMPARED = ("model.json",)  # holds the seconds that the training took


def final_files(folder: Path) -> dict[str, Path]:
    """Files under final names, by their path in the folder; drafts and a model's hidden spare are none."""
    found = [path for path in sorted(folder.rglob("*")) if path.is_file()]
    names = {str(path.relative_to(folder)): path for path in found}
    return {name: path for name, path in names.items() if not name.startswith(".") and PART not in name}


def drafts(folder: Path) -> int:
    """Drafts that were left."""
    return sum(PART in path.name for path in folder.rglob("*")) + sum(
        PART in path.name for path in folder.parent.glob(f".{folder.name}.*")
    )


def half_written(folder: Path) -> list[str]:
    """Files under final names that do not parse to their end."""
    return [name for name, path in final_files(folder).items() if not whole(path)]


def whole(path: Path) -> bool:
    """Whether a file parses to its end."""
    try:
        PARSERS[path.suffix](path)
    except (ValueError, OSError, KeyError, ElementTree.ParseError):  # pyarrow's errors are among these
        return False
    return True


def _page(path: Path) -> None:
    if not path.read_text(encoding="utf-8").rstrip().endswith("</html>"):
        raise ValueError("a page without an end")


def _archive(path: Path) -> None:
    with np.load(path, allow_pickle=False) as arrays:
        for name in arrays.files:
            arrays[name]


def _table(path: Path) -> None:
    if not path.read_bytes().endswith(b"\n"):
        raise ValueError("a last line without an end")
    pyarrow.csv.read_csv(path)


PARSERS: dict[str, Callable[[Path], object]] = {
    ".json": lambda path: json.loads(path.read_text(encoding="utf-8")),
    ".parquet": pyarrow.parquet.read_table,
    ".npz": _archive,
    ".html": _page,
    ".urdf": ElementTree.parse,
    ".csv": _table,
}


def digests(folder: Path) -> dict[str, str]:
    """SHA-256 of all files that the same command writes anew byte for byte."""
    files = final_files(folder).items()
    compared = {n: p for n, p in files if n not in NOT_COMPARED and CHECKPOINT not in n}
    return {name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in compared.items()}


def finished(name: str, folder: Path) -> bool:
    """Whether a folder claims to hold all that a command writes."""
    if not (folder / SAID_LAST[name]).is_file():
        return False
    return name != "train" or not load_model(folder).training["interrupted"]


def broken_promises(name: str, folder: Path, contracts: Path | None) -> str:
    """What a folder that claims to be finished does not keep; "" where all is kept."""
    if name == "train":
        load_model(folder)  # holds the weights against their checksum
    if name != "diagnose" or contracts is None:
        return ""
    words = [sys.executable, str(contracts / "check_outputs.py"), str(folder)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    return done.stdout.strip() if done.returncode else ""
