"""The entry point: help at once, one line of error, and the promised exit codes."""

from __future__ import annotations

import signal
import subprocess
import sys
import types

import pytest
import typer

from lagnet.cli import main as entry
from lagnet.errors import RecordingError


def install(monkeypatch: pytest.MonkeyPatch, action) -> None:
    """Make `lagnet demo` do something."""

    def command(out: str = typer.Option("x", help="Where to write."), times: int = typer.Option(1, min=1)) -> None:
        """Do something."""
        action(out)

    module = types.ModuleType("lagnet.cli.demo")
    module.command = command  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "lagnet.cli.demo", module)


@pytest.mark.parametrize("words", [["--help"], []])
def test_help_names_every_command_and_imports_none(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    before = {name for name in sys.modules if name.startswith("lagnet.cli.")}
    assert entry.main(words) == 0
    shown = capsys.readouterr().out
    assert all(name in shown for name in ("demo", "simulate", "train", "decompose", "check", "diagnose", "data"))
    assert {name for name in sys.modules if name.startswith("lagnet.cli.")} == before


def test_help_loads_nothing_heavy() -> None:
    code = (
        "import sys; from lagnet.cli.main import main; main(['--help']);"
        "heavy = {'numpy', 'jax', 'pinocchio', 'scipy', 'plotly', 'sklearn', 'pyarrow', 'pybullet'} & set(sys.modules);"
        "sys.exit(str(heavy) if heavy else 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert entry.main(["--version"]) == 0
    assert capsys.readouterr().out.startswith("lagnet ")


def test_a_command_that_succeeds(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[str] = []
    install(monkeypatch, seen.append)
    assert entry.main(["demo", "--out", "here"]) == 0
    assert seen == ["here"]


def test_its_own_help(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    install(monkeypatch, print)
    assert entry.main(["demo", "--help"]) == 0
    shown = capsys.readouterr().out
    assert "lagnet demo" in shown
    assert "Where to write." in shown


def fail(error: BaseException):
    def action(_: str) -> None:
        raise error

    return action


OUTCOMES = {
    "bad input": (RecordingError("column q_0\nis missing", where="a.csv"), 2, "lagnet: a.csv: column q_0 is missing"),
    "failed check": (typer.Exit(1), 1, ""),
    "interrupted": (KeyboardInterrupt(), 3, "lagnet: interrupted"),
    "aborted": (typer.Abort(), 3, "lagnet: interrupted"),
    "no space": (OSError(28, "No space left on device", "out/x"), 2, "lagnet: out/x: No space left on device"),
    "forbidden": (PermissionError(13, "Permission denied", "out"), 2, "lagnet: out: Permission denied"),
    "no memory": (MemoryError(), 2, "lagnet: not enough memory"),
    "bad option": (typer.BadParameter("too small"), 2, "too small"),
}


@pytest.mark.parametrize("case", OUTCOMES)
def test_outcomes_become_exit_codes_and_one_line(
    case: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    error, code, line = OUTCOMES[case]
    install(monkeypatch, fail(error))
    assert entry.main(["demo"]) == code
    told = capsys.readouterr()
    assert told.out == ""
    assert line in told.err
    assert told.err.count("\n") == (1 if line else 0)


def test_a_programming_error_keeps_its_trace_and_is_no_failed_check(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    install(monkeypatch, fail(ZeroDivisionError("a bug")))
    assert entry.main(["demo"]) == 70
    told = capsys.readouterr().err
    assert "Traceback" in told
    assert "ZeroDivisionError: a bug" in told


def test_control_c_ends_a_running_command_with_code_3() -> None:
    code = (
        "import signal, sys, time, types; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "def command():\n    print('ready', flush=True)\n    time.sleep(60)\n"
        "module = types.ModuleType('lagnet.cli.demo'); module.command = command\n"
        "sys.modules['lagnet.cli.demo'] = module\n"
        "from lagnet.cli.main import main\nsys.exit(main(['demo']))"
    )
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"ready\n"
        process.send_signal(signal.SIGINT)
        _, told = process.communicate(timeout=30)
    assert process.returncode == 3
    assert told == b"lagnet: interrupted\n"


USAGE = {
    "unknown command": (["dmo"], "No such command 'dmo'. Did you mean 'demo'?; see lagnet --help"),
    "unknown option": (["demo", "--outt", "x"], "No such option"),
    "bad value": (["demo", "--times", "many"], "Invalid value for '--times'"),
    "out of range": (["demo", "--times", "0"], "see lagnet demo --help"),
    "unknown top option": (["--nonsense"], "No such option"),
}


@pytest.mark.parametrize("case", USAGE)
def test_usage_errors_are_one_line_and_code_2(
    case: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    words, line = USAGE[case]
    install(monkeypatch, print)
    assert entry.main(words) == 2
    told = capsys.readouterr().err
    assert told.startswith("lagnet: ")
    assert line in told
    assert told.count("\n") == 1


def test_a_command_that_is_not_installed_says_so(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(entry.COMMANDS, "fly", "Not there.")
    assert entry.main(["fly"]) == 2
    assert "the command fly is not part of this installation" in capsys.readouterr().err


def test_a_missing_library_inside_a_command_is_not_mistaken_for_a_missing_command(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def missing(name: str):
        raise ModuleNotFoundError("No module named 'x'", name="x")

    monkeypatch.setattr(entry.importlib, "import_module", missing)
    with pytest.raises(ModuleNotFoundError):
        entry.load_command("demo")
