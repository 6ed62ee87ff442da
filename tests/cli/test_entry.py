"""The command from its first moment to its last: Ctrl-C is one line, waits for modules, and hides no exit code."""

from __future__ import annotations

import importlib
import os
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from lagnet import __main__ as entry

LOADED = """import signal, time
signal.raise_signal(signal.SIGINT)
time.sleep(0.1)
print("loaded", flush=True)
"""


@pytest.fixture(autouse=True)
def handlers():
    """Handlers of signals as they were before."""
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGALRM)}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


def test_control_c_waits_while_a_module_is_loaded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "pressed_while_loading.py").write_text(LOADED)
    monkeypatch.syspath_prepend(tmp_path)
    signal.signal(signal.SIGINT, entry.control_c)
    signal.signal(signal.SIGALRM, entry.control_c)
    with pytest.raises(KeyboardInterrupt):
        import_and_wait()
    assert sys.modules.pop("pressed_while_loading")


def import_and_wait() -> None:
    importlib.import_module("pressed_while_loading")
    signal.pause()  # the question is put again here


@pytest.mark.parametrize("pressed", ["raise KeyboardInterrupt", "exec('raise KeyboardInterrupt')"])
def test_control_c_is_one_line_and_code_3(pressed: str) -> None:
    code = f"import lagnet.cli.main as m\ndef pressed():\n    {pressed}\nm.main = pressed\n"
    code += "import sys, lagnet.__main__ as entry\nsys.exit(entry.run())"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (3, "lagnet: interrupted\n")


def test_it_runs_the_command_line_and_ends_undisturbed() -> None:
    code = "import signal, sys; sys.argv = ['lagnet', '--version']; from lagnet.__main__ import run; code = run();"
    code += "signal.raise_signal(signal.SIGINT); sys.exit(code)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("lagnet ")


def test_control_c_on_the_way_out_keeps_the_exit_code() -> None:
    code = "import signal, sys, lagnet.__main__ as entry, lagnet.cli.main as m\nm.main = lambda: 2\n"
    code += "def seen(frame, *_):\n    if frame.f_code.co_name == 'leave':\n"
    code += "        signal.raise_signal(signal.SIGINT)\n"
    code += "sys.settrace(seen)\nsys.exit(entry.run())"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (2, "")


def test_compiled_modules_that_abort_at_the_end_do_not_hide_the_exit_code() -> None:
    code = "import atexit, ctypes, lagnet.__main__ as entry, lagnet.cli.main as m\nm.main = lambda: 2\n"
    code += "library = ctypes.CDLL(None)\nlibrary['__cxa_atexit'](library.abort, None, None)\n"
    code += "atexit.register(print, 'the end')\nentry.run()"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (2, "the end\n", "")


def test_control_c_between_the_command_and_its_end_is_asked_again() -> None:
    after = SimpleNamespace(f_code=entry.run.__code__, f_back=None)
    signal.signal(signal.SIGALRM, lambda *_: asked.append(True))
    asked: list[bool] = []
    entry.control_c(signal.SIGINT, after)  # does not raise
    signal.pause()
    assert asked


def test_control_c_while_garbage_is_collected_is_not_lost() -> None:
    class Pressed:
        def __del__(self) -> None:
            signal.raise_signal(signal.SIGINT)

    signal.signal(signal.SIGALRM, entry.control_c)
    signal.signal(signal.SIGINT, entry.control_c)
    with pytest.raises(KeyboardInterrupt):
        _dropped([Pressed()])


def _dropped(things: list) -> None:
    things.clear()
    signal.pause()  # the question is put again here


@pytest.mark.parametrize(("given", "expected"), [({}, "0"), ({"NUMPY_MADVISE_HUGEPAGE": "1"}, "1")])
def test_huge_pages_are_off_unless_the_user_asks_for_them(given: dict[str, str], expected: str) -> None:
    code = "import os, sys, lagnet.cli.main as m\nassert 'numpy' not in sys.modules\n"
    code += "m.main = lambda: print(os.environ['NUMPY_MADVISE_HUGEPAGE']) or 0\n"
    code += "import lagnet.__main__ as entry\nentry.run()"
    environment = {k: v for k, v in os.environ.items() if k != "NUMPY_MADVISE_HUGEPAGE"} | given
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, env=environment)
    assert (done.stdout, done.stderr) == (expected + "\n", "")
