"""How numbers and names of the catalogue are put into words and digits."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any

from markupsafe import Markup, escape

LONGEST_WHOLE_NAME = 24
NOT_SAID = 1e6  # half an interval, in any unit: verdicts give wider ones to parameters that recordings leave open
PROPER = {"coriolis": "Coriolis", "coulomb": "Coulomb", "stribeck": "Stribeck", "lugre": "LuGre", "dahl": "Dahl"}


def effect_words(name: str) -> str:
    """A name of the catalogue or of a term in words: stribeck_friction becomes Stribeck friction."""
    return " ".join(PROPER.get(word, word) for word in name.split("_"))


def number(value: float | None, digits: int = 3) -> str:
    """A value in so many significant digits, e.g. 14.2, 0.00345, 1.20·10⁻⁶; a dash where there is none."""
    if value is None or not math.isfinite(value):
        return "–"
    if value == 0:
        return "0"
    exponent = math.floor(math.log10(abs(float(f"{value:.{digits - 1}e}"))))
    if -4 <= exponent < 6:
        return _signed(f"{value:.{max(digits - 1 - exponent, 0)}f}")
    return _signed(f"{value / 10.0**exponent:.{digits - 1}f}·10{_superscript(exponent)}")


def percent(share: float | None) -> str:
    """A share as percent in two digits: 96 %, 0.69 %, below 0.01 %."""
    if share is None or not math.isfinite(share):
        return "–"
    if 0 < share < 1e-4:
        return "< 0.01 %"
    return f"{number(100 * share, 2) if share < 0.995 else f'{100 * share:.0f}'} %"


def with_interval(value: float, low: float, high: float) -> str:
    """A value and its 95 % interval, to two digits of the interval: 14.20 ± 0.31, or 3.1 (2.0 … 5.5) if lopsided."""
    half = (high - low) / 2
    if half > NOT_SAID:
        return f"not determined, taken as {number(value)}"
    if not math.isfinite(half) or half <= 0:
        return number(value)
    digits = _digits(value, half)
    if abs((high + low) / 2 - value) > 0.2 * half:
        return f"{number(value, digits)} ({number(low, digits)} … {number(high, digits)})"
    places = max(1 - math.floor(math.log10(half)), 0)
    if places > 6:
        return f"{number(value, digits)} ± {number(half, 2)}"
    return f"{_signed(f'{value:.{places}f}')} ± {half:.{places}f}"


def interval(ends: tuple[float, float] | list[float]) -> str:
    """Both ends of a 95 % interval, or that there is none: 1.20 … 1.40, or not determined."""
    low, high = ends
    return "not determined" if (high - low) / 2 > NOT_SAID else f"{number(low, 4)} … {number(high, 4)}"


def listed(words: list[str] | tuple[str, ...]) -> str:
    """Words as a list in a sentence: a, b and c."""
    words = list(words)
    if len(words) < 2:
        return "".join(words)
    return f"{', '.join(words[:-1])} and {words[-1]}"


def counted(count: int, noun: str, plural: str | None = None) -> str:
    """A number with its noun: 1 joint, 4 joints."""
    return f"{count} {noun if count == 1 else plural or noun + 's'}"


def file_name(path: str) -> str:
    """The last part of a path, of either kind of slash."""
    return re.split(r"[\\/]", path.rstrip("\\/"))[-1] or path


def compared(verdict: Mapping[str, Any]) -> str:
    """What a verdict compares: the file of the nominal model, and how many recordings of how long."""
    recordings = verdict["recordings"]
    held_out = [recording for recording in recordings if recording["role"] == "holdout"]
    seconds = sum(recording["duration_s"] for recording in recordings)
    return (
        f"{file_name(verdict['nominal']['source'])} against {counted(len(recordings), 'recording')} "
        f"({seconds:.0f} s, {len(held_out)} held out)"
    )


def shortened(name: str, width: int) -> str:
    """A name of at most so many characters, a long one without its middle."""
    return name if len(name) <= width else f"{name[: width // 2 - 1]}…{name[-(width // 2) :]}"


def breakable(name: str) -> Markup:
    """A long name that may break behind its underscores; short ones stay whole, so that they can be searched for."""
    if len(name) <= LONGEST_WHOLE_NAME:
        return escape(name)
    return Markup("<wbr>").join(re.findall(r"[^_]*_|[^_]+", name))


def unit_words(unit: str) -> str:
    """A unit as printed behind a value; nothing for pure numbers."""
    return "" if unit in ("", "-", "–", "1") else unit


def wrapped(name: str, width: int) -> list[str]:
    """A long name in lines of at most so many characters, broken behind _ - / or a space where it can be."""
    lines = [""]
    for piece in re.findall(r"[^_\-/ ]*[_\-/ ]|[^_\-/ ]+", name):
        if lines[-1] and len(lines[-1]) + len(piece.rstrip()) > width:
            lines.append("")
        lines[-1] += piece
        while len(lines[-1].rstrip()) > width:
            lines[-1:] = [lines[-1][:width], lines[-1][width:]]
    return [line.rstrip(" ") for line in lines]


def _digits(value: float, half: float) -> int:
    size = max(abs(value), half)
    return min(max(2 + math.floor(math.log10(size)) - math.floor(math.log10(half)), 2), 6)


def _signed(text: str) -> str:
    return text.replace("-", "−")


def _superscript(exponent: int) -> str:
    return str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


FILTERS = {
    "effect_words": effect_words,
    "number": number,
    "percent": percent,
    "interval": interval,
    "listed": listed,
    "counted": counted,
    "unit_words": unit_words,
    "breakable": breakable,
}
