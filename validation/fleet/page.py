"""How soon the page of a large fleet is seen, and how soon its filter answers, in headless Chromium.

python -m validation.fleet.page [--robots 500] [--recordings 100]
"""

from __future__ import annotations

import argparse
import json
import re
import shutil
import subprocess
import tempfile
import time
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from typing import Any

from tests.reports.fleet_report.fleets import synthetic_fleet

from lagnet.reports.fleet_report import write_fleet_report

HERE = Path(__file__).resolve().parent
SEEN, ANSWERED = (
    2000.0,
    200.0,
)  # [ms] pass lines: to first paint, and from a change of the filter to the page painted anew
WORDS = ("arm_04", "elbow", "arm_499", "B", "")  # typed one after the other
PATIENCE = 60  # [s]
ASK = """<script>
addEventListener("load", async () => {
  const painted = () => new Promise((done) => requestAnimationFrame(() => setTimeout(() => done(performance.now()))));
  const seen = () => performance.getEntriesByName("first-contentful-paint")[0];
  while (!seen()) await painted();
  const paint = seen().startTime, answers = [];
  const filter = document.getElementById("fleet-filter");
  for (const word of %s) {
    await painted();
    const begun = performance.now();
    filter.value = word;
    filter.dispatchEvent(new Event("input"));
    answers.push((await painted()) - begun);
  }
  const shown = document.body.innerText.match(/\\d+ of \\d+ robots/)[0];
  fetch("/told", { method: "POST", body: JSON.stringify({ paint, answers, shown }) });
});
</script>"""


def measured(page: str) -> dict[str, Any]:
    """What a browser tells of a page that it loads from this machine and that asks for its own times."""
    told: dict[str, Any] = {}

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(200)
            self.send_header("Content-Type", "text/html; charset=utf-8")
            self.end_headers()
            self.wfile.write(page.encode() if self.path == "/" else b"")

        def do_POST(self) -> None:
            told.update(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
            self.send_response(204)
            self.end_headers()

        def log_message(self, format: str, *args: object) -> None:
            """Nothing on the terminal."""

    folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)  # Chromium's children write a moment longer
    with HTTPServer(("127.0.0.1", 0), Handler) as server, folder as profile:
        server.timeout = 1.0
        words = ["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", f"--user-data-dir={profile}"]
        browser = subprocess.Popen(
            [_chromium(), *words, "--remote-debugging-port=0", f"http://127.0.0.1:{server.server_port}/"],
            stderr=subprocess.DEVNULL,
        )
        try:
            limit = time.monotonic() + PATIENCE
            while not told and time.monotonic() < limit:
                server.handle_request()
        finally:
            browser.terminate()
            browser.wait(PATIENCE)
    if not told:
        raise RuntimeError(f"Chromium told nothing of the page in {PATIENCE} s")
    return told


def _chromium() -> str:
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if found is None:
        raise RuntimeError("no Chromium on this machine")
    return found


def told_of(robots: int, recordings: int) -> dict[str, Any]:
    """Times of the page of a drawn fleet, and whether they keep the lines."""
    with tempfile.TemporaryDirectory() as folder:
        written = write_fleet_report(synthetic_fleet(robots, recordings), Path(folder) / "report.html")
        page, size = written.read_text(encoding="utf-8"), written.stat().st_size
    page = re.sub(r'<meta http-equiv="Content-Security-Policy"[^>]*>', "", page)  # so that it may tell its times
    told = measured(page.replace("</body>", ASK % json.dumps(WORDS) + "</body>"))
    return {
        "robots": robots,
        "recordings": recordings,
        "megabytes": round(size / 1e6, 1),
        "first_paint_ms": round(told["paint"], 1),
        "filter_ms": [round(x, 1) for x in told["answers"]],
        "shown": told["shown"],
        "lines": {"first paint ≤ 2 s": told["paint"] <= SEEN, "filter ≤ 200 ms": max(told["answers"]) <= ANSWERED},
    }


def main() -> int:
    """0 if both lines are met."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robots", type=int, default=500)
    parser.add_argument("--recordings", type=int, default=100)
    options = parser.parse_args()
    result = told_of(options.robots, options.recordings)
    print(json.dumps(result, ensure_ascii=False))
    if (options.robots, options.recordings) == (500, 100):
        (HERE / "page.json").write_text(json.dumps(result, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    return 0 if all(result["lines"].values()) else 1


if __name__ == "__main__":
    raise SystemExit(main())
