"""What the help of a command says is shown whole: units stand in brackets, which markup would swallow."""

from __future__ import annotations

import re

import pytest

from lagnet.cli import main as entry
from lagnet.cli.main import COMMANDS, load_command

IN_BRACKETS = re.compile(r"\[+[^\[\]]+\]+")


def bracketed(text: str) -> list[str]:
    """Everything in brackets, with what a table draws between its columns taken out."""
    return IN_BRACKETS.findall(" ".join(re.sub("[│╭╰─╮╯]", " ", text).split()))


@pytest.mark.parametrize("name", [n for n in COMMANDS if n != "data"])
def test_units_and_tables_are_shown(name: str, capsys: pytest.CaptureFixture[str], monkeypatch) -> None:
    monkeypatch.setenv("COLUMNS", "250")
    wanted = [mark for option in load_command(name).params for mark in bracketed(getattr(option, "help", None) or "")]
    assert entry.main([name, "--help"]) == 0
    shown = bracketed(capsys.readouterr().out)
    assert not [mark for mark in wanted if mark not in shown]


def test_a_unit_is_among_what_is_asked() -> None:
    helps = " ".join(getattr(option, "help", None) or "" for option in load_command("simulate").params)
    assert {"[s]", "[Hz]", "[[effect]]"} <= set(bracketed(helps))
