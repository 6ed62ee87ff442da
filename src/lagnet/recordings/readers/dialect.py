"""How a text table is written: separator, decimal sign, header; found from its first lines."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass

from lagnet.errors import RecordingError

NUMBER = re.compile(r"\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\s*")
LONGEST_HEADER = 64 * 1024  # bytes; a header line beyond it is not a table of joint signals


@dataclass(frozen=True)
class Dialect:
    """How the cells of a text table are told apart.

    Args:
        names: header cells, stripped.
        separator: between cells.
        decimal: decimal sign of the numbers.
        header_lines: lines before the first sample.
    """

    names: tuple[str, ...]
    separator: str
    decimal: str
    header_lines: int


def sniff(data: bytes, where: str) -> tuple[Dialect, bytes]:
    """Dialect of a text table, and its text without byte-order mark.

    Raises:
        RecordingError: empty file, no samples below the header, binary content or an encoding other than UTF-8.
    """
    text = data.removeprefix(b"\xef\xbb\xbf")
    _refuse_other_content(text, where)
    text = _valid_utf8(text)
    skipped, header = _header_line(text)
    if not header:
        raise RecordingError("the file is empty", where=where, next_step="record again or give another file")
    body_start = _line_end(text, skipped)
    if len(header) >= LONGEST_HEADER:
        raise RecordingError("is not a table: its first line does not end", where=where, next_step="save it as CSV")
    separator = _separator(header)
    cells = tuple(cell.strip() for cell in next(csv.reader([header], delimiter=separator, skipinitialspace=True)))
    has_header = not all(NUMBER.fullmatch(cell) or not cell for cell in cells)
    names = cells if has_header else tuple(f"column_{i}" for i in range(len(cells)))
    decimal = "," if separator == ";" and b"," in text[body_start : body_start + 4096] else "."
    if has_header and not text[body_start:].strip():
        raise RecordingError(
            "holds a header but no samples", where=where, next_step="record again or give another file"
        )
    return Dialect(names, separator, decimal, skipped + has_header), text


def _refuse_other_content(text: bytes, where: str) -> None:
    start = text[:4096]
    if start[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise RecordingError("is encoded as UTF-16", where=where, next_step="save it as UTF-8")
    if b"\x00" in start:
        raise RecordingError(
            "holds binary data, not text", where=where, next_step="give the suffix its format has: .parquet, .npz, .mat"
        )


def _valid_utf8(text: bytes) -> bytes:
    """Letters of another encoding stand in comments at most; numbers and names are ASCII in all of them."""
    if text.isascii():
        return text
    try:
        text.decode()
    except UnicodeDecodeError:
        return text.decode(errors="replace").encode()
    return text


def _header_line(text: bytes) -> tuple[int, str]:
    """The number of lines before the header line (blank ones), and the header without a leading comment sign."""
    start, skipped = 0, 0
    while start < len(text):
        stop = _next_line(text, start)
        line = text[start : min(stop, start + LONGEST_HEADER)].decode("utf-8", errors="replace").strip()
        if line:
            return skipped, line.lstrip("# ") if line.startswith("#") else line
        start, skipped = stop, skipped + 1
    return skipped, ""


def _line_end(text: bytes, skipped: int) -> int:
    """Position of the first byte after the header line."""
    position = 0
    for _ in range(skipped + 1):
        position = _next_line(text, position)
    return position


def _next_line(text: bytes, start: int) -> int:
    newline, carriage = text.find(b"\n", start), text.find(b"\r", start)
    if carriage != -1 and (newline == -1 or carriage < newline - 1):
        return carriage + 1
    return newline + 1 if newline != -1 else len(text)


def _separator(header: str) -> str:
    counts = {sign: header.count(sign) for sign in ",;\t"}
    if not any(counts.values()) and " " in header.strip():
        return " "
    best = max(counts, key=lambda sign: counts[sign])
    # Decimal commas in a headerless semicolon file can outnumber the semicolons.
    return ";" if counts[";"] and best == "," and counts[","] <= counts[";"] + 1 else best
