"""Fixtures shared by all rooms: where the real recordings lie, and what a strict run may not skip."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

os.environ.setdefault("JAX_NUM_CPU_DEVICES", "1")  # before JAX: else the first `lagnet train` would change it for all
STRICT = os.environ.get("LAGNET_TEST_STRICT") == "1"  # set in CI: a missing browser or data set fails the run
DEFAULT_DATA = Path(__file__).resolve().parents[2] / "shared" / "data"


def _absent(what: str) -> None:
    if STRICT:
        pytest.fail(f"{what} is missing, and this run may not skip")
    pytest.skip(f"{what} is not on this machine")


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Folder of the real recordings (LAGNET_DATA_DIR)."""
    folder = Path(os.environ.get("LAGNET_DATA_DIR", DEFAULT_DATA))
    if not (folder / "manifest.json").exists():
        _absent("the folder of real recordings (LAGNET_DATA_DIR)")
    return folder


@pytest.fixture(scope="session")
def contracts(shared_data: Path) -> Path:
    """Folder of the contracts: check_outputs.py and verdict.schema.json."""
    folder = shared_data.parent / "contracts"
    if not folder.exists():
        _absent("the folder of contracts")
    return folder


@pytest.fixture(scope="session")
def chromium() -> str:
    """Path of a headless-capable Chromium."""
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if found is None:
        _absent("Chromium")
    return str(found)
