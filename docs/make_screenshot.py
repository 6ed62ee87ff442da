"""Take the picture of a report that the README shows: make_screenshot.py report.html docs/images/report.png

Needs Chromium. Run it on the report of `lagnet demo` or of a real diagnosis, never on a drawing of one.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--virtual-time-budget=8000",
)


def take(page: Path, picture: Path, width: int, height: int, scale: float, dark: bool) -> None:
    """Draw the top of a page, width by height in CSS pixels, into a PNG."""
    browser = next((found for name in BROWSERS if (found := shutil.which(name))), None)
    if browser is None:
        sys.exit(f"no browser found (looked for {', '.join(BROWSERS)})")
    picture.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as profile:
        command = [browser, *FLAGS, f"--user-data-dir={profile}", f"--window-size={width},{height}"]
        command += [f"--force-device-scale-factor={scale}", f"--blink-settings=preferredColorScheme={0 if dark else 1}"]
        command += [f"--screenshot={picture.resolve()}", page.resolve(strict=True).as_uri()]
        subprocess.run(command, check=True, timeout=120, stderr=subprocess.DEVNULL)
    print(f"{picture}: {picture.stat().st_size / 1024:.0f} KiB")


def main() -> None:
    """Read the command line and take the picture."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page", type=Path, help="report.html")
    parser.add_argument("picture", type=Path, help="PNG to write, e.g. docs/images/report.png")
    parser.add_argument("--width", type=int, default=1280, help="CSS pixels")
    parser.add_argument("--height", type=int, default=1560, help="CSS pixels")
    parser.add_argument("--scale", type=float, default=1.0, help="picture pixels for each CSS pixel")
    parser.add_argument("--dark", action="store_true", help="as on a dark screen")
    take(**vars(parser.parse_args()))


if __name__ == "__main__":
    main()
