"""When a recording was made: stated, or part of its file's name."""

from __future__ import annotations

import re
from collections.abc import Mapping
from datetime import UTC, date, datetime
from typing import Any

from lagnet.errors import LagnetError

WIDTHS = {"Y": r"\d{4}", "m": r"\d{1,2}", "d": r"\d{1,2}", "H": r"\d{1,2}", "M": r"\d{2}", "S": r"\d{2}", "j": r"\d{3}"}


def parsed(value: Any, where: str) -> datetime:
    """A date as a moment without a zone: UTC where a zone was given.

    Raises:
        LagnetError: it is no date.
    """
    if isinstance(value, str):
        try:
            value = datetime.fromisoformat(value.strip())
        except ValueError:
            value = None
    if isinstance(value, datetime):
        return value.astimezone(UTC).replace(tzinfo=None) if value.tzinfo else value
    if isinstance(value, date):
        return datetime(value.year, value.month, value.day)
    raise LagnetError("the date cannot be read", where=where, next_step="write it like 2026-01-31 or 2026-01-31T08:00")


def as_date(entry: Mapping[str, Any], file: str, where: str) -> datetime:
    """The date of a file by what its entry states: `date`, or `date_in_name` with the codes of strftime.

    Raises:
        LagnetError: nothing is stated, or the name does not hold such a date.
    """
    if "date" in entry:
        return parsed(entry["date"], f"{where}, {file}")
    form = entry.get("date_in_name")
    if not isinstance(form, str):
        raise LagnetError(
            "the recording has no date",
            where=f"{where}, {file}",
            next_step='state date = 2026-01-31, or date_in_name = "%Y-%m-%d" for names that hold it',
        )
    return _in_name(file, form, where)


def _in_name(file: str, form: str, where: str) -> datetime:
    parts = re.split(r"%(.)", form)
    if unknown := [code for code in parts[1::2] if code not in WIDTHS]:
        raise LagnetError(f"date_in_name: %{unknown[0]} is not known", where=where, choices=[f"%{c}" for c in WIDTHS])
    pattern = "".join(WIDTHS[p] if i % 2 else re.escape(p) for i, p in enumerate(parts))
    found = re.search(pattern, file.rsplit("/", 1)[-1])
    try:
        return datetime.strptime(found.group() if found else "", form)
    except ValueError:
        raise LagnetError(f"its name holds no date like {form}", where=f"{where}, {file}") from None
