"""Errors that say what was wrong, where, what would have been valid, and what to do next."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

LONGEST, WORD, MOST_CHOICES = 1500, 80, 60  # characters of a message and of a choice; choices that are listed


def _shortened(text: str, most: int) -> str:
    """A text of at most so many characters: files from elsewhere hold names of any length."""
    return text if len(text) <= most else text[: most // 2] + " … " + text[-most // 3 :]


class LagnetError(Exception):
    """What the user gave cannot be used; the message is one clear sentence for a terminal.

    Args:
        what: what is wrong, e.g. "column tau_2 is missing".
        where: the file, row, column, joint or option it was found in.
        choices: the valid values, where there is a list of them.
        next_step: what would mend it.
    """

    def __init__(
        self, what: str, *, where: str | None = None, choices: Iterable[str] | None = None, next_step: str | None = None
    ):
        self.what, self.where, self.next_step = what, where, next_step
        self.choices = tuple(choices) if choices is not None else None
        super().__init__(self._message())

    def _message(self) -> str:
        what = _shortened(self.what, LONGEST)
        text = f"{self.where}: {what}" if self.where else what
        if self.choices:
            more = f", … ({len(self.choices)} in all)" if len(self.choices) > MOST_CHOICES else ""
            text += f" (valid: {', '.join(_shortened(c, WORD) for c in self.choices[:MOST_CHOICES])}{more})"
        if self.next_step:
            text += f"; {self.next_step}"
        return text


class RecordingError(LagnetError):
    """A recording file breaks the recording contract."""


class RobotError(LagnetError):
    """A robot description cannot be read or is not a fixed-base arm of one-degree-of-freedom joints."""


class EffectError(LagnetError):
    """An effect is unknown, or its parameters are out of bounds."""


class ModelError(LagnetError):
    """A saved model is damaged, from a newer format, or does not match the joints at hand."""


class DataError(LagnetError):
    """A data set could not be fetched or failed its checksum."""


class DiagnosisError(LagnetError):
    """The recordings at hand do not allow a diagnosis."""


class MissingExtraError(LagnetError):
    """An optional dependency is needed for what was asked."""


def closest(name: str, valid: Iterable[str]) -> str | None:
    """The valid name most like `name`, for "did you mean" hints; None if nothing is near."""
    found = get_close_matches(name, list(valid), n=1, cutoff=0.5)
    return found[0] if found else None
