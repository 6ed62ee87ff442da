"""One number in which parameter sets differ: what each says, what recordings say, and what would decide where not."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite

RESOLVED = 3.0  # standard errors between two sets
NORMAL_95 = 1.96
LONG = 3  # terms of a combination that are written out


@dataclass(frozen=True)
class Difference:
    """One number.

    Args:
        parameter: its name, in full.
        unit: its unit.
        values: of each set.
        estimate: what the recordings say; nan where they do not show it.
        error: its standard error; inf where they do not show it.
    """

    parameter: str
    unit: str
    values: tuple[float, ...]
    estimate: float
    error: float

    @property
    def spread(self) -> float:
        """Largest difference between two sets."""
        return max(self.values) - min(self.values)

    @property
    def resolved(self) -> bool:
        """Whether the recordings tell two sets apart."""
        return self.spread > RESOLVED * self.error

    @property
    def errors_apart(self) -> float:
        """Largest difference between two sets in standard errors."""
        return self.spread / self.error if self.error > 0.0 else inf

    @property
    def nearest(self) -> int | None:
        """The set that the recordings agree with best, None where none is within the error or near beside the spread.

        Within 3 standard errors, or at a tenth of the difference between the sets.
        """
        away = [abs(v - self.estimate) for v in self.values]
        at = min(range(len(away)), key=away.__getitem__)
        return at if away[at] <= max(RESOLVED * self.error, 0.1 * self.spread) else None

    def words(self, names: tuple[str, ...]) -> str:
        """One line."""
        said = ", ".join(f"{n} {v:.4g}" for n, v in zip(names, self.values, strict=True))
        text = f"{short(self.parameter)}: {said} {self.unit}".rstrip()
        if not isfinite(self.error):
            return f"{text}; these recordings do not show it"
        half = NORMAL_95 * self.error
        text += f"; the recordings say {self.estimate:.4g} [{self.estimate - half:.3g}, {self.estimate + half:.3g}]"
        if not self.resolved:
            return f"{text}: not resolved"
        return f"{text}: {'none of them' if self.nearest is None else names[self.nearest]}"


def short(parameter: str) -> str:
    """A combination of many inertial parameters by its first and the number of the others."""
    terms = parameter.replace(" - ", " + ").split(" + ")
    return parameter if len(terms) <= LONG else f"{terms[0]} with {len(terms) - 1} others"
