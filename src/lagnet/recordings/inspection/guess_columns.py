"""Which foreign column is which signal, guessed from words and numbers; a person confirms it in the mapping file."""

from __future__ import annotations

import re
from collections.abc import Sequence

from lagnet.recordings.signals import kind_of

WORDS = (  # tried in this order: a commanded position is no position
    ("command_velocity", r"(cmd|command|target|desired|goal|ref|setpoint|des)\w*(vel|speed|qd|dq)"),
    ("command_torque", r"(cmd|command|target|desired|ref|des)\w*(tau|torque|effort|moment)|feed_?forward"),
    ("command", r"cmd|command|target|desired|goal|setpoint|reference|(^|_)(des|ref)(_|$)|(^|_)q_?d(es)?(_|$)"),
    ("temperature", r"temp"),
    ("voltage", r"volt"),
    ("duty", r"pwm|duty"),
    ("current", r"current|amp|(^|_)i(_|$)"),
    ("tau", r"tau|torque|effort|moment|load|force"),
    ("a", r"acc|qdd|ddq"),
    ("v", r"vel|speed|(^|_)(qd|dq|qdot|omega)(_|$)"),
    ("q", r"pos|angle|joint|encoder|(^|_)q(_|$)"),
)
CLOCKS = ("time", "t", "timestamp", "time_s", "stamp", "sec", "seconds", "time_ms", "time_us", "clock")


def guess_columns(names: Sequence[str]) -> dict[str, str]:
    """Our columns to the file's, for files whose names are not ours; {} where positions are named as ours already.

    Args:
        names: the file's columns.
    """
    if any(kind_of(name) == "q" for name in names):
        return {}
    found: dict[str, str] = {}
    clock = next((name for name in names if name.lower() in CLOCKS), None)
    if clock is not None:
        found["time"] = clock
    for stem, columns in _families(names, clock).items():
        kind = next((kind for kind, words in WORDS if re.search(words, stem.lower())), None)
        if kind is not None and f"{kind}_0" not in found:
            found |= {f"{kind}_{i}": name for i, name in enumerate(columns)}
    return found if "q_0" in found else {}


def _families(names: Sequence[str], clock: str | None) -> dict[str, list[str]]:
    """Columns that differ by one number, in its order: `motor_3_pos` and `motor_4_pos` are of `motor__pos`."""
    found: dict[str, list[tuple[int, str]]] = {}
    for name in names:
        digits = list(re.finditer(r"\d+", name))
        if name == clock or not digits:
            continue
        last = digits[-1]
        found.setdefault(name[: last.start()] + name[last.end() :], []).append((int(last[0]), name))
    return {stem: [name for _, name in sorted(columns)] for stem, columns in found.items()}
