"""Options that take several values at once, as in `--holdout a.csv b.csv`: click knows options with one value only."""

from __future__ import annotations

from collections.abc import Sequence

MANY = frozenset({"--holdout", "--simulated", "--recording"})


def repeat_options(words: Sequence[str]) -> list[str]:
    """The words with `--holdout a b` written as `--holdout a --holdout b`.

    Only where an argument of the command stands before the options, as the usage lines have it: otherwise nothing
    tells the last value of an option from the first argument.
    """
    out: list[str] = []
    option, arguments, takes_one = None, 0, False
    for place, word in enumerate(words):
        if word.startswith("-") and len(word) > 1:
            option = word if word in MANY else None
            takes_one = True
            out.append(word)
        elif takes_one:
            takes_one = False
            out.append(word)
        elif option is not None and arguments > 0:
            out.extend((option, word))
        else:
            arguments += place > 0  # the first word is the command
            out.append(word)
    return out
