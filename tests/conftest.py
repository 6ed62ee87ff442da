"""Fixtures shared by all rooms: where the real recordings lie, what a strict run may not skip, a headless browser."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest
from jaxtyping import install_import_hook

os.environ.setdefault("JAX_NUM_CPU_DEVICES", "1")  # before JAX: else the first `lagnet train` would change it for all
CHECKED = ("lagnet.models", "lagnet.training")  # rooms whose arguments and results are held to their annotations
if os.environ.get("LAGNET_RUNTIME_CHECKS") == "1":  # `make test-checked`
    os.environ.setdefault("JAX_NUMPY_RANK_PROMOTION", "raise")  # a forgotten axis is an error, never a silent broadcast
    install_import_hook(CHECKED, "beartype.beartype")
STRICT = os.environ.get("LAGNET_TEST_STRICT") == "1"  # set in CI: a missing browser or data set fails the run
DEFAULT_DATA = Path(__file__).resolve().parents[2] / "shared" / "data"

QUIET_CHROMIUM = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
)


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


@dataclass(frozen=True)
class Rendered:
    """What a browser made of a page.

    Args:
        dom: the document after its scripts ran.
        console: lines that the page wrote to the console, errors and broken policies among them.
        requests: addresses asked for other than the page itself.
    """

    dom: str
    console: tuple[str, ...]
    requests: tuple[str, ...]

    @property
    def drawn(self) -> int:
        """Number of plots that plotly.js has drawn."""
        return len(re.findall(r'class="plot[^"]*js-plotly-plot', self.dom))

    @property
    def text(self) -> str:
        """The words that a reader sees, tables and plots included, scripts and styles left out."""
        visible = re.sub(r"<(script|style)\b.*?</\1>", " ", self.dom, flags=re.DOTALL)
        return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", visible))


@pytest.fixture
def browse(chromium: str, tmp_path: Path) -> Callable[[Path], Rendered]:
    """Open a page in headless Chromium, with a fresh profile, and return what became of it."""

    def opened(page: Path, query: str = "") -> Rendered:
        log = tmp_path / "network.json"
        command = [
            chromium,
            *QUIET_CHROMIUM,
            f"--user-data-dir={tmp_path / 'profile'}",
            "--host-resolver-rules=MAP * ~NOTFOUND",
            f"--log-net-log={log}",
            "--enable-logging=stderr",
            "--v=0",
            "--virtual-time-budget=8000",
            "--dump-dom",
            page.resolve().as_uri() + query,
        ]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
        console = tuple(line for line in done.stderr.splitlines() if "CONSOLE" in line)
        return Rendered(done.stdout, console, _requests(log, page))

    return opened


def _requests(log: Path, page: Path) -> tuple[str, ...]:
    """Addresses that the page asked for; what Chromium asks for by itself has no initiator."""
    events = json.loads(log.read_text(errors="replace"))["events"]
    asked = [event.get("params", {}) for event in events]
    addresses = {entry["url"] for entry in asked if entry.get("initiator", "not an origin") != "not an origin"}
    own = ("data:", "blob:", page.resolve().as_uri())
    return tuple(sorted(address for address in addresses if not address.startswith(own)))
