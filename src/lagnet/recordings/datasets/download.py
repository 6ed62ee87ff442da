"""Fetches one file over HTTP: bounded in size, checked by sha256, in place whole or not at all."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

from lagnet.errors import DataError

TIMEOUT = (10.0, 60.0)  # [s] to connect, and between two pieces
PIECE = 256 * 1024  # bytes
MAX_UNKNOWN = 64 * 1024**2  # bytes accepted where the size of the file is not known beforehand
Progress = Callable[[str, int, int | None], None]  # file name, bytes so far, bytes in all where known


@dataclass(frozen=True)
class BoundedDownloader:
    """Streams a file to disk, and stops a server that sends more than it should.

    Args:
        expected: size in bytes, or None.
        progress: told after every piece.
    """

    expected: int | None
    progress: Progress | None = None

    def __call__(self, url: str, output_file: str | IO[bytes], _pooch: Any) -> None:
        import requests

        with requests.get(url, stream=True, timeout=TIMEOUT) as response:
            response.raise_for_status()
            with Path(str(output_file)).open("wb") as stream:
                self._copy(response.iter_content(PIECE), stream, url)

    def _copy(self, pieces: Any, stream: IO[bytes], url: str) -> None:
        done, most = 0, self.expected if self.expected is not None else MAX_UNKNOWN
        for piece in pieces:
            done += len(piece)
            if done > most:
                raise DataError(f"sends more than {most} bytes, which is not the file that was asked for", where=url)
            stream.write(piece)
            if self.progress is not None:
                self.progress(url.rsplit("/", 1)[-1], done, self.expected)


def download(
    url: str, target: Path, sha256: str | None, expected: int | None = None, progress: Progress | None = None
) -> Path:
    """Fetch `url` to `target`; a file that is there and right is kept.

    Args:
        url: address of the file.
        target: where it shall lie; its folder is made.
        sha256: checksum that the file must have, or None where nobody stated one.
        expected: size in bytes, or None.
        progress: told after every piece.

    Returns:
        `target`.

    Raises:
        DataError: no connection, an error of the server, a broken transfer or a wrong checksum. Nothing is left behind.
    """
    import pooch

    pooch.get_logger().setLevel("ERROR")  # its messages repeat ours
    known = None if sha256 is None else f"sha256:{sha256}"
    downloader: Any = BoundedDownloader(expected, progress)
    with _no_empty_folder(target.parent):
        _retrieve(url, known, target, downloader)
    return target


def _retrieve(url: str, known: str | None, target: Path, downloader: Any) -> None:
    import pooch
    import requests

    try:
        pooch.retrieve(url, known, fname=target.name, path=target.parent, downloader=downloader)
    except requests.RequestException as error:
        raise DataError(_told(error), where=url, next_step="try again later, or " + _local_copy(target)) from None
    except ValueError:
        raise DataError(
            f"{target.name} does not have the {known}: the transfer broke, or its source has changed",
            where=url,
            next_step="try again, or " + _local_copy(target),
        ) from None


@contextmanager
def _no_empty_folder(folder: Path) -> Iterator[None]:
    """Take away the folder that was made for a file that did not come."""
    try:
        yield
    except Exception:
        with suppress(OSError):
            folder.rmdir()
        raise


def _told(error: Exception) -> str:
    import requests

    if isinstance(error, requests.HTTPError) and error.response is not None:
        return f"the server answered {error.response.status_code} {error.response.reason}"
    if isinstance(error, requests.Timeout):
        return "the server did not answer in time"
    if isinstance(error, requests.exceptions.ChunkedEncodingError):
        return "the connection broke in the middle of the file"
    return "no connection to the server"


def _local_copy(target: Path) -> str:
    parts = target.parts[-3:] if target.parent.name == "raw" else target.parts[-2:]
    return f"put {'/'.join(parts)} in a folder and name it in LAGNET_DATA_DIR"
