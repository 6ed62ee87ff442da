"""A headless browser for pages, and diagnoses to write about."""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

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

    def opened(page: Path) -> Rendered:
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
            page.resolve().as_uri(),
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
