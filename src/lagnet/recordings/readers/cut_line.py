"""Whether writing stopped in the middle of the last line: a power cut, a full disk, a copy taken too early."""

from __future__ import annotations

import csv

from lagnet.recordings.readers.dialect import NUMBER, Dialect

LOOK_BACK = 50  # lines that show how the last cell is usually written
MISSING = frozenset({"nan", "na", "null", "inf", "-inf"})


def whole_length(text: bytes, dialect: Dialect) -> int:
    """Length of the text without a last line that was cut short; all of it where the last line is whole.

    A last line without line end is taken for cut when it lacks cells, when its last cell is empty or no number though
    those before are, when it has fewer decimals than any of those before, or is the beginning of their label.
    """
    if text[-1:] in (b"\n", b"\r"):
        return len(text)
    start = max(text.rfind(b"\n"), text.rfind(b"\r")) + 1
    before = text[max(0, start - LOOK_BACK * 4096) : start].splitlines()[-LOOK_BACK - 1 :]
    # The first of these may be the rest of a line or the header.
    usual = [cells for line in before[1:] if len(cells := _cells(line, dialect)) == len(dialect.names)]
    last = _cells(text[start:], dialect)
    if len(last) < len(dialect.names):
        return start if usual else len(text)
    cut = len(last) == len(dialect.names) and bool(usual) and _is_cut(last[-1], [cells[-1] for cells in usual], dialect)
    return start if cut else len(text)


def _is_cut(cell: str, usual: list[str], dialect: Dialect) -> bool:
    if not cell:
        return all(usual)
    if not all(NUMBER.fullmatch(_plain(other, dialect)) for other in usual):
        return usual[-1].startswith(cell) and cell not in usual
    if not NUMBER.fullmatch(_plain(cell, dialect)):
        return cell.lower() not in MISSING
    return _decimals(_plain(cell, dialect)) < min(_decimals(_plain(other, dialect)) for other in usual)


def _cells(line: bytes, dialect: Dialect) -> list[str]:
    text = line.decode(errors="replace")
    try:
        cells = next(csv.reader([text], delimiter=dialect.separator), [])
    except csv.Error:
        return []
    return [cell.strip() for cell in cells]


def _plain(cell: str, dialect: Dialect) -> str:
    return cell.replace(",", ".") if dialect.decimal == "," else cell


def _decimals(number: str) -> int:
    """Digits after the decimal point, those of an exponent included: a cut loses the last first."""
    return len(number.partition(".")[2])
