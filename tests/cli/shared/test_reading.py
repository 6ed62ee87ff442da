"""A long log tells on a terminal how much of it is read, in messages, and says nothing into a pipe."""

from __future__ import annotations

import io

from lagnet.cli.shared.reading import while_reading


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_share_and_number_of_messages_are_shown_on_a_terminal() -> None:
    terminal = Terminal()
    show = while_reading(terminal)
    assert show is not None
    show("arm.mcap", 50_000, 200_000)
    show("arm.mcap", 200_000, 200_000)
    show("other.db3", 1_000, None)
    first, second, third = terminal.getvalue().split("\r")[1:]
    assert first == "arm.mcap:  25% of 200,000 messages read"
    assert second == "arm.mcap: 100% of 200,000 messages read\n"
    assert third == "other.db3: 1,000 messages read"


def test_nothing_is_shown_elsewhere() -> None:
    assert while_reading(io.StringIO()) is None
