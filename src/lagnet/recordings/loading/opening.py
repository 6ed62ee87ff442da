"""Opens a recording of any supported format: by what is in it, its suffix only where the content leaves it open."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable
from dataclasses import replace
from importlib import import_module
from pathlib import Path

from lagnet.errors import RecordingError
from lagnet.recordings.readers.logs.lerobot import INFO, data_files, is_lerobot_folder, open_lerobot
from lagnet.recordings.readers.logs.libfranka import LIBFRANKA
from lagnet.recordings.readers.logs.log_source import Origin
from lagnet.recordings.readers.logs.motion_folder import CONTROL, STATE, is_motion_folder, open_motion_folder
from lagnet.recordings.readers.logs.servo_bench import open_servo_bench
from lagnet.recordings.readers.logs.ur_rtde import UR_RTDE
from lagnet.recordings.readers.logs.vocabulary import KnownTable
from lagnet.recordings.readers.source import MAX_BYTES, TableSource, refuse_if_huge

Progress = Callable[[str, int, int | None], None]
READERS = {
    ".csv": ("lagnet.recordings.readers.csv_file", "CsvSource"),
    ".csv.gz": ("lagnet.recordings.readers.csv_file", "CsvSource"),
    ".parquet": ("lagnet.recordings.readers.parquet_file", "ParquetSource"),
    ".npz": ("lagnet.recordings.readers.npz_file", "NpzSource"),
    ".mat": ("lagnet.recordings.readers.mat_file", "MatSource"),
}
LOGS = (".db3", ".mcap", ".bag", ".json", "folders of ROS 2 bags, LeRobot data sets or motions")
MAGIC = {b"PAR1": ".parquet", b"MATLAB 5.0": ".mat", b"\x1f\x8b": ".csv.gz"}
BAGS = (b"SQLite format 3\x00", b"\x89MCAP0\r\n", b"#ROSBAG V2.0\n")
VOCABULARIES = (UR_RTDE, LIBFRANKA)
TEXT = (".txt", ".dat", ".log", ".tsv", "")  # suffixes of text tables that other programs write
PICKLES = (".pt", ".pth", ".pkl", ".pickle", ".joblib")
BLOCK = 1024**2
CONVERT = "a pickle can run code when it is loaded: where you trust it, load it yourself and save q, tau and time with"


def open_source(path: str | Path, progress: Progress | None = None) -> tuple[TableSource, str]:
    """The opened file or folder and the sha256 of its bytes.

    Args:
        path: file or folder.
        progress: told (name, done, expected or None) while a long log is read.

    Raises:
        RecordingError: no such file, an unknown kind, a pickle, empty, or too big.
        MissingExtraError: a format whose library is an optional extra.
    """
    path, where = Path(path), str(path)
    if path.is_dir():
        return _open_folder(path, where, progress)
    suffix = _suffix_of(path)
    if path.exists() and not path.is_file():
        raise RecordingError("is a pipe, a socket or a device", where=where, next_step="give a plain file")
    if not path.is_file():
        known = suffix in READERS or suffix in LOGS or path.suffix == ""
        if not known:
            raise _unknown(path)
        raise RecordingError("does not exist", where=where, next_step="check the path")
    head = _head(path, where)
    _refuse_pickle(path, head, where)
    if any(head.startswith(magic) for magic in BAGS):
        from lagnet.recordings.readers.ros.bag_source import open_bag

        return open_bag(path, where, progress), checksum([path])
    return _open_table(path, suffix, head, where)


def recordings_in(path: str | Path) -> tuple[Path, ...]:
    """The recordings that a path holds: itself, or the motion folders below it."""
    path = Path(path)
    if not path.is_dir() or is_recording(path):
        return (path,)
    return tuple(sorted(folder for folder in path.iterdir() if folder.is_dir() and is_motion_folder(folder))) or (path,)


def is_recording(path: str | Path) -> bool:
    """Whether a path is a file, or a folder of a format that is one recording."""
    path = Path(path)
    if not path.is_dir():
        return path.is_file()
    return is_motion_folder(path) or is_lerobot_folder(path) or bool(_bag_files(path))


def checksum(files: Iterable[Path]) -> str:
    """The sha256 of files, one after the other, read block by block."""
    digest = hashlib.sha256()
    for file in files:
        with file.open("rb") as stream:
            while block := stream.read(BLOCK):
                digest.update(block)
    return digest.hexdigest()


def _open_folder(path: Path, where: str, progress: Progress | None) -> tuple[TableSource, str]:
    if is_lerobot_folder(path):
        return open_lerobot(path, where), checksum([path / INFO, *data_files(path)])
    if is_motion_folder(path):
        return open_motion_folder(path, where), checksum([path / CONTROL, path / STATE])
    bags = _bag_files(path)
    if bags:
        from lagnet.recordings.readers.ros.bag_source import open_bag

        return open_bag(path, where, progress), checksum(bags)
    inside = recordings_in(path)
    if inside != (path,):
        raise RecordingError(
            f"holds {len(inside)} recordings, a folder each", where=where, next_step=f"give them, e.g. {inside[0]}"
        )
    raise RecordingError(
        "is a folder, not a recording",
        where=where,
        next_step="a folder must be a ROS 2 bag, a LeRobot data set, or hold control.csv and state_motor.csv",
    )


def _bag_files(path: Path) -> list[Path]:
    return sorted(f for f in path.iterdir() if f.is_file() and _starts_like_bag(f))


def _starts_like_bag(file: Path) -> bool:
    try:
        with file.open("rb") as stream:
            head = stream.read(16)
    except OSError:
        return False
    return any(head.startswith(magic) for magic in BAGS)


def _head(path: Path, where: str) -> bytes:
    try:
        with path.open("rb") as stream:
            head = stream.read(4096)
    except OSError as error:
        raise RecordingError(f"cannot be read ({error.strerror})", where=where) from None
    return head


def _refuse_pickle(path: Path, head: bytes, where: str) -> None:
    pickled = head[:1] == b"\x80" and head[1:2] in (b"\x02", b"\x03", b"\x04", b"\x05")
    torch = head.startswith(b"PK\x03\x04") and b"data.pkl" in head
    if pickled or torch or path.suffix.lower() in PICKLES:
        raise RecordingError(
            "is a pickle, which is never loaded", where=where, next_step=f"{CONVERT} numpy.savez (.npz)"
        )


def _suffix_of(path: Path) -> str:
    name = path.name.lower()
    return next((s for s in sorted(READERS, key=len, reverse=True) if name.endswith(s)), path.suffix.lower())


def _unknown(path: Path) -> RecordingError:
    return RecordingError(f"unknown kind of file {path.suffix!r}", where=str(path), choices=(*READERS, *LOGS))


def _open_table(path: Path, suffix: str, head: bytes, where: str) -> tuple[TableSource, str]:
    by_content = next((s for magic, s in MAGIC.items() if head.startswith(magic)), None)
    if by_content is None and head.startswith(b"PK\x03\x04"):
        by_content = ".npz" if b".npy" in head or suffix == ".npz" else None
    is_json = head.lstrip()[:1] == b"{" and suffix not in READERS
    kind = by_content or (suffix if suffix in READERS else ".csv" if suffix in TEXT and b"\x00" not in head else None)
    if kind is None and not is_json:
        raise _unknown(path)
    data = _bytes(path, where)
    sha256 = hashlib.sha256(data).hexdigest()
    if is_json:
        return open_servo_bench(data, where), sha256
    module, name = READERS[str(kind)]
    reader: Callable[[bytes, str], TableSource] = getattr(import_module(module), name)
    source = reader(data, where)
    fitting = next((v for v in VOCABULARIES if v.fits(source.names)), None)
    return (source if fitting is None else KnownTable(source, fitting)), sha256


def _bytes(path: Path, where: str) -> bytes:
    refuse_if_huge(path.stat().st_size, where)
    try:
        with path.open("rb") as stream:
            data = stream.read(MAX_BYTES + 1)
    except OSError as error:
        raise RecordingError(f"cannot be read ({error.strerror})", where=where) from None
    if not data:
        raise RecordingError("the file is empty", where=where, next_step="record again or give another file")
    return data


def origin_of(source: TableSource, path: str | Path) -> Origin:
    """What an opened file was recognised as."""
    found = getattr(source, "origin", None)
    if isinstance(found, Origin):
        return replace(found, effort=_effort(source) or found.effort)
    kind = type(source).__name__.removesuffix("Source")
    text = {"Csv": "text table", "Parquet": "Parquet table", "Npz": "NumPy archive", "Mat": "MATLAB file"}
    return Origin(text.get(kind, kind), f"its content and the suffix {Path(path).suffix!r}", effort=_effort(source))


def _effort(source: TableSource) -> str:
    named = [name for name in source.names if name.startswith("tau_")]
    return "" if not named or hasattr(source, "origin") else f"the columns {named[0]} …"
