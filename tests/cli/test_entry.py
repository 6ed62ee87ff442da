"""The command from its first moment: Ctrl-C while modules are loaded is one line too."""

from __future__ import annotations

import signal
import sys

import pytest

from lagnet import __main__ as entry


class PressedWhileLoading:
    """Finds a module by pressing Ctrl-C."""

    def find_spec(self, name: str, *_: object) -> None:
        if name == "lagnet.cli.main":
            raise KeyboardInterrupt


def test_control_c_while_modules_are_loaded(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delitem(sys.modules, "lagnet.cli.main", raising=False)
    monkeypatch.setattr(sys, "meta_path", [PressedWhileLoading(), *sys.meta_path])
    assert entry.run() == 3
    assert capsys.readouterr().err == "lagnet: interrupted\n"


def test_it_runs_the_command_line(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(sys, "argv", ["lagnet", "--version"])
    handler = signal.getsignal(signal.SIGINT)
    try:
        assert entry.run() == 0
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN  # while the interpreter ends
    finally:
        signal.signal(signal.SIGINT, handler)
    assert capsys.readouterr().out.startswith("lagnet ")
