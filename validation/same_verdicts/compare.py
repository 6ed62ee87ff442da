"""Where two verdicts of one case differ: by key, what was added, is gone, or is another value."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

BESIDE = ("versions",)  # keys that may differ


def differences(old: Any, new: Any, key: str = "") -> Iterator[tuple[str, str]]:
    """Keys with what became of them; entries of lists share a key."""
    if isinstance(old, dict) and isinstance(new, dict):
        for name in sorted({*old, *new} - {*BESIDE}):
            at = f"{key}.{name}".lstrip(".")
            if name not in old or name not in new:
                yield at, "added" if name in new else "gone"
            else:
                yield from differences(old[name], new[name], at)
    elif isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        for pair in zip(old, new, strict=True):
            yield from differences(*pair, f"{key}[]")
    elif old != new:
        yield key, _change(old, new)


def _change(old: Any, new: Any) -> str:
    if isinstance(old, list) and isinstance(new, list):
        return f"{len(old)} → {len(new)} entries"
    if isinstance(old, bool) or not (isinstance(old, int | float) and isinstance(new, int | float)):
        return f"{str(old)[:60]} → {str(new)[:60]}"
    return f"relative change {abs(new - old) / max(abs(old), 1e-300):.1e}"


def names_of(verdict: dict[str, Any]) -> list[tuple[str, str | None]]:
    """Effects and joints in their order."""
    return [(e["effect"], e["joint"]) for e in verdict["effects"]]


def largest_change(old: dict[str, Any], new: dict[str, Any]) -> float | None:
    """max |p' − p| / |p| over all parameters; None where the names are others."""
    if names_of(old) != names_of(new):
        return None
    pairs = zip(*([p["value"] for e in v["effects"] for p in e["parameters"]] for v in (old, new)), strict=True)
    return max((abs(b - a) / max(abs(a), 1e-300) for a, b in pairs), default=0.0)
