"""Write a simulation to a folder: recordings, the settings, and the truth in a file of its own."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from lagnet.errors import LagnetError
from lagnet.files import finite_json, write_whole
from lagnet.recordings.recording import Recording
from lagnet.recordings.writing import write_recording

TRUTH = "truth.json"


def check_free(folder: Path) -> None:
    """Refuse a folder that already holds something: recordings of two simulations must not mix.

    Raises:
        LagnetError: the folder is a file, or is not empty.
    """
    if folder.exists() and not folder.is_dir():
        raise LagnetError("is a file", where=str(folder), next_step="give a new folder")
    if folder.is_dir() and any(folder.iterdir()):
        raise LagnetError("the folder is not empty", where=str(folder), next_step="give a new folder or empty this one")


def write_simulation(folder: Path, truth: dict, recordings: Iterable[Recording]) -> Iterator[Path]:
    """Write recordings as they are finished, each in one step, so that an interruption leaves only whole files.

    Args:
        folder: new or empty.
        truth: what was injected; written first, to `truth.json`.
        recordings: written to `trajectory_0.csv`, `trajectory_1.csv`, …

    Yields:
        The path of each recording.
    """
    check_free(folder)
    folder.mkdir(parents=True, exist_ok=True)
    _write_json(folder / TRUTH, truth)
    known = {"robot": truth["robot"], "settings": truth["settings"]}
    _write_json(folder / "settings.json", known)
    for index, recording in enumerate(recordings):
        yield write_recording(recording, folder / f"trajectory_{index}.csv")


def _write_json(path: Path, content: dict) -> None:
    write_whole(path, finite_json(content))
