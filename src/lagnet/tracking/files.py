"""Where recordings lie: folders of this machine, or object stores through fsspec where it is installed."""

from __future__ import annotations

import glob
import os
import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from lagnet.errors import LagnetError, MissingExtraError
from lagnet.recordings.loading.opening import is_recording, recordings_in

ADDRESS = re.compile(r"^[a-z][a-z0-9+]*://")
EXTRA = "install lagnet[tracking], and s3fs for s3:// or gcsfs for gs://"
MAX_BYTES = 2 * 1024**3


def is_address(path: str) -> bool:
    """Whether a path is an address such as s3://bucket/key."""
    return ADDRESS.match(path) is not None


def join(base: Path, path: str) -> str:
    """The path seen from a folder; addresses stay as they are."""
    return path if is_address(path) else str(base / path)


def exists(path: str) -> bool:
    """Whether a file of this machine is there."""
    return not is_address(path) and os.path.exists(path)  # False for names that no file can have


def matching(base: Path, pattern: str, where: str) -> list[str]:
    """Files, and folders that are one recording, that a path or glob names, sorted.

    Raises:
        LagnetError: there is none.
    """
    full = join(base, pattern)
    if is_address(full):
        store, inner = _store(full)
        found = [store.unstrip_protocol(p) for p in store.glob(inner)]
    else:
        found = [full] if Path(full).exists() else glob.glob(full, recursive=True)
        found = [str(one) for path in found for one in _recordings(Path(path))]
    if not found:
        raise LagnetError(
            f"no file matches {pattern}", where=where, next_step="check the path; it starts at the manifest"
        )
    return sorted(found)


def _recordings(path: Path) -> tuple[Path, ...]:
    """A file; a folder where it is a recording, or those in it; of anything else nothing."""
    return tuple(one for one in recordings_in(path) if is_recording(one))


def stamp(path: str) -> str:
    """Size and time of change of a file, by which a later change of it is noticed; "" where neither is known."""
    if is_address(path):
        try:
            store, inner = _store(path)
            told = store.info(inner)
        except LagnetError:
            raise
        except Exception:  # every store has errors of its own; reading the file will tell this one
            return ""
        changed = next((str(told[k]) for k in ("ETag", "etag", "mtime", "LastModified", "updated") if k in told), "")
        return f"{told.get('size')} {changed}"
    try:
        one = Path(path)
        files = sorted(p for p in one.rglob("*") if p.is_file()) if one.is_dir() else [one]
        told = [file.stat() for file in files]
    except OSError:
        return ""
    return f"{sum(t.st_size for t in told)} {max((t.st_mtime_ns for t in told), default=0)}"


@contextmanager
def local_copy(path: str) -> Iterator[Path]:
    """The file on this machine: itself, or a copy that is removed afterwards.

    Raises:
        LagnetError: the store does not give it, or it is too large.
    """
    if not is_address(path):
        yield Path(path)
        return
    with tempfile.TemporaryDirectory(prefix="lagnet-") as folder:
        target = Path(folder) / (path.rsplit("/", 1)[-1] or "recording")
        try:
            store, inner = _store(path)
            size = store.info(inner).get("size") or 0
            if size > MAX_BYTES:
                raise LagnetError(f"holds more than {MAX_BYTES / 1024**3:g} GiB", where=path)
            store.get_file(inner, str(target))
        except LagnetError:
            raise
        except Exception as error:
            raise LagnetError(f"cannot be fetched ({type(error).__name__}: {error})", where=path) from None
        yield target


def _store(path: str) -> tuple[Any, str]:
    try:
        from fsspec.core import url_to_fs
    except ImportError:
        raise MissingExtraError("reading from a store needs fsspec", where=path, next_step=EXTRA) from None
    try:
        return url_to_fs(path)
    except (ImportError, ValueError) as error:
        raise MissingExtraError(f"cannot be reached ({error})", where=path, next_step=EXTRA) from None
