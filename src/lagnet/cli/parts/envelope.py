"""The demo's envelope: the truth, sealed by its checksum before the diagnosis, compared with the verdict after it."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from lagnet.cli.shared.console import say
from lagnet.files import write_whole

FILE = "envelope.json"
SHOWN = 4  # parameters of an effect that are compared


def seal(truth: Mapping[str, Any], folder: Path) -> str:
    """Writes the truth and gives its sha256."""
    text = json.dumps(truth, indent=1) + "\n"
    write_whole(folder / FILE, text)
    return hashlib.sha256(text.encode()).hexdigest()


def compare(folder: Path, verdict: Mapping[str, Any]) -> Iterator[str]:
    """What was hidden against what was found, a line each."""
    hidden = json.loads((folder / FILE).read_text(encoding="utf-8"))["effects"]
    named = {(e["effect"], e["joint"]): e for e in verdict["effects"]}
    for effect in hidden:
        place = effect["joint"] or "the whole arm"
        found = named.pop((effect["effect"], effect["joint"]), None)
        if found is None:
            yield f"hidden {effect['effect']} at {place}: not found under this name"
            continue
        values = {p["name"]: p for p in found["parameters"]}
        pairs = [(k, v, values[k]) for k, v in effect["parameters"].items() if k in values][:SHOWN]
        told = ", ".join(f"{k} {v:.4g} hidden, {p['value']:.4g} found {p['unit']}".rstrip(" –") for k, v, p in pairs)
        yield f"hidden {effect['effect']} at {place}: found; {told}"
    for name, joint in named:
        yield f"also named, though not hidden: {name} at {joint or 'the whole arm'}"


def say_opened(folder: Path, verdict: Mapping[str, Any], page: Path) -> None:
    """Says what was found, opens the envelope and says what was hidden; `page` is the report."""
    for effect in verdict["effects"]:
        say(f"   {effect['explanation']}")
    say("3. The envelope is opened")
    for line in compare(folder, verdict):
        say(f"   {line}")
    say(f"report: {page.resolve()}")
