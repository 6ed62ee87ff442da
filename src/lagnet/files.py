"""Files that appear whole or not at all, and JSON that holds finite numbers alone.

A file is written beside its name and then put in its place in one step, so that a kill, an interruption or a full disk
leaves either the old file or the new one, never half of one.
"""

from __future__ import annotations

import ctypes
import errno
import json
import math
import os
import shutil
import signal
import stat
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

PART = ".part"  # suffix of what is not finished


def read_bounded(path: str | Path, most: int) -> bytes:
    """The bytes of a plain file that is not larger than it may be; pipes and devices are not opened.

    Raises:
        OSError: not there, no plain file, or too large; `strerror` says which.
    """
    path = Path(path)
    kind = path.stat()
    if not stat.S_ISREG(kind.st_mode):
        what = "is a folder" if stat.S_ISDIR(kind.st_mode) else "is a pipe, a socket or a device, not a file"
        raise OSError(errno.EINVAL, what, str(path))
    if kind.st_size > most:
        raise OSError(errno.EFBIG, f"is larger than {most} bytes", str(path))
    with path.open("rb") as stream:
        return stream.read(most)


def write_whole(path: str | Path, content: bytes | str) -> Path:
    """Writes a file in one step; text is written as UTF-8.

    Returns:
        The path.

    Raises:
        OSError: it cannot be written; `filename` is the path, not that of the draft.
    """
    path = Path(path)
    data = content.encode("utf-8") if isinstance(content, str) else content
    path.parent.mkdir(parents=True, exist_ok=True)
    with _named(path):
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name[:100]}.", suffix=PART)
        try:
            with os.fdopen(handle, "wb") as stream:
                stream.write(data)
                stream.flush()
                os.fsync(stream.fileno())
            os.chmod(name, 0o644)
            os.replace(name, path)
        except BaseException:
            Path(name).unlink(missing_ok=True)
            raise
    return path


@contextmanager
def _named(path: Path) -> Iterator[None]:
    """Errors of the system that say where: a write to a full disk names no file, and a draft's name helps nobody."""
    try:
        yield
    except OSError as error:
        raise OSError(error.errno, error.strerror or str(error), str(path)) from error


def write_folder_whole(folder: str | Path, fill: Callable[[Path], Any]) -> Path:
    """Fills a new folder and puts it in the place of an old one of that name, whole or not at all.

    Args:
        folder: where it shall stand.
        fill: writes into the folder that it is given.

    Returns:
        The folder.
    """
    folder = Path(folder)
    folder.parent.mkdir(parents=True, exist_ok=True)
    made = Path(tempfile.mkdtemp(dir=folder.parent, prefix=f".{folder.name}.", suffix=PART))
    try:
        with _named_in(made, folder):
            fill(made)
        os.chmod(made, 0o755)
        _exchange(made, folder)
    finally:
        shutil.rmtree(made, ignore_errors=True)
    return folder


def write_together(folder: str | Path, fill: Callable[[Path], Any], last: str = "") -> Path:
    """Writes several files and folders that belong together; all are complete before the first takes its place.

    What else stands in the folder is left alone. Ctrl-C while they take their places waits until all have.

    Args:
        folder: where they shall stand.
        fill: writes into the draft that it is given.
        last: the one that takes its place last: where it stands, all others do.

    Returns:
        The folder.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    made = Path(tempfile.mkdtemp(dir=folder, prefix=".", suffix=PART))
    try:
        with _named_in(made, folder):
            fill(made)
        with _named_in(made, folder), _control_c_waits():
            for part in sorted(made.iterdir(), key=lambda part: part.name == last):
                _exchange(part, folder / part.name)
    finally:
        shutil.rmtree(made, ignore_errors=True)
    return folder


@contextmanager
def _named_in(made: Path, folder: Path) -> Iterator[None]:
    """Errors of the system name the place where a file shall stand, not the draft in which it is written."""
    try:
        yield
    except OSError as error:
        if error.filename is None or not Path(error.filename).is_relative_to(made):
            raise
        with _named(folder / Path(error.filename).relative_to(made)):
            raise


@contextmanager
def _control_c_waits() -> Iterator[None]:
    """Ctrl-C takes effect at the end of the block, if it has any; only the main thread can have it wait."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, _: came.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
    if came:
        signal.raise_signal(signal.SIGINT)  # to whom it was meant for: nobody, where it is ignored


def _exchange(made: Path, folder: Path) -> None:
    """Puts a file or a folder in the place of another; a folder that stood there is removed last, or comes back."""
    if not (made.is_dir() and folder.is_dir()):
        os.replace(made, folder)
        return
    if _swapped(made, folder):  # what stood there is now the draft, which is removed
        return
    old = made.with_name(made.name + ".old")
    os.replace(folder, old)
    try:
        os.replace(made, folder)
    except OSError:
        os.replace(old, folder)
        raise
    shutil.rmtree(old, ignore_errors=True)


def _swapped(one: Path, other: Path) -> bool:
    """Exchanges two folders in one step, where the system can (Linux: renameat2 with RENAME_EXCHANGE)."""
    try:
        exchange = ctypes.CDLL(None, use_errno=True).renameat2
    except (AttributeError, OSError):
        return False
    here = -100  # AT_FDCWD: paths are relative to the working directory
    return exchange(here, os.fsencode(one), here, os.fsencode(other), 2) == 0


def finite_json(content: Any, **options: Any) -> str:
    """JSON text of plain values, with a line break at the end.

    Raises:
        ValueError: a number in it is not finite; where it stands.
    """
    _refuse_not_finite(content, "")
    return json.dumps(content, allow_nan=False, ensure_ascii=False, **{"indent": 1, **options}) + "\n"


def _refuse_not_finite(node: Any, where: str) -> None:
    if isinstance(node, dict):
        for name, value in node.items():
            _refuse_not_finite(value, f"{where}.{name}")
    elif isinstance(node, (list, tuple)):
        for index, value in enumerate(node):
            _refuse_not_finite(value, f"{where}[{index}]")
    elif isinstance(node, float) and not math.isfinite(node):
        raise ValueError(f"{where.lstrip('.') or 'the value'} is {node}, not a finite number")
