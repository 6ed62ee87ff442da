"""How far long work has come: a bar on a terminal, plain lines now and then elsewhere."""

from __future__ import annotations

from types import TracebackType
from typing import Any, TextIO

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

LINES = 10  # for each step, where there is no terminal


class Bar:
    """A bar for each step of the work.

    Args:
        stream: where it is drawn.
    """

    def __init__(self, stream: TextIO):
        self.stream, self.is_terminal = stream, stream.isatty()
        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
        self.bars = Progress(*columns, console=Console(file=stream)) if self.is_terminal else None
        self.steps: dict[str, Any] = {}

    def __enter__(self) -> Bar:
        if self.bars:
            self.bars.start()
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if self.bars:
            self.bars.stop()

    def show(self, title: str, done: int, total: int) -> None:
        """Tells that so much of a step is done."""
        if self.bars:
            if title not in self.steps:
                self.steps[title] = self.bars.add_task(title, total=total)
            self.bars.update(self.steps[title], completed=done)
            return
        tenth = done * LINES // max(1, total)
        if self.steps.get(title) != tenth and total:
            self.steps[title] = tenth
            print(f"{title}: {done} of {total}", file=self.stream, flush=True)
