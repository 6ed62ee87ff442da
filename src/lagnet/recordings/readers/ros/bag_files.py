"""The messages of a ROS bag one by one: rosbag2 (.db3, .mcap, their folder) and ROS 1 (.bag)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lagnet.errors import MissingExtraError, RecordingError
from lagnet.recordings.readers.ros.definitions import DEFINITIONS

SQLITE, MCAP, ROS1 = b"SQLite format 3\x00", b"\x89MCAP0\r\n", b"#ROSBAG V2.0\n"
Progress = Callable[[str, int, int | None], None]
EVERY = 20_000  # messages between two signs of life
DAMAGED = "copy it again, or repair it with `ros2 bag reindex` or `mcap recover`"


@dataclass(frozen=True, eq=False)
class Message:
    """One message that was decoded.

    Args:
        topic: its topic; type: its message type, e.g. sensor_msgs/msg/JointState.
        received: when the recorder got it [ns].
        content: its fields.
    """

    topic: str
    type: str
    received: int
    content: Any


class Bag:
    """An opened bag; messages are read one by one and never held together."""

    def __init__(self, path: Path):
        self._where, self._stack = str(path), ExitStack()
        library()
        try:
            self._storages = self._open(path)
        except RecordingError:
            raise
        except Exception as error:  # the library raises whatever its parsers raise on damaged files
            self._stack.close()
            raise self._damaged(error) from None
        self.ros1 = head_of(path) == ROS1 if path.is_file() else False
        self._stores = self._layouts()

    @property
    def topics(self) -> dict[str, str]:
        """Topic to message type."""
        return {c.topic: c.msgtype for s in self._storages for c in s.connections}

    def messages(self, types: tuple[str, ...], progress: Progress | None = None) -> Iterator[Message]:
        """Messages of these types in the order in which they were recorded, storage by storage.

        Raises:
            RecordingError: a damaged bag, or a message that does not fit its type.
        """
        told = [c.msgcount for s in self._storages for c in s.connections if c.msgtype in types]
        count, total = 0, sum(n for n in told if isinstance(n, int))  # a damaged bag tells words
        for storage in self._storages:
            wanted = [c for c in storage.connections if c.msgtype in types]
            if not wanted:
                continue
            try:
                for connection, stamp, data in storage.messages(wanted):
                    yield Message(connection.topic, connection.msgtype, stamp, self._decode(connection, data))
                    count += 1
                    if progress and count % EVERY == 0:
                        progress(self._where, count, max(total, count))
            except RecordingError:
                raise
            except Exception as error:
                raise self._damaged(error) from None
        if progress:
            progress(self._where, count, count)

    def close(self) -> None:
        """Release the files."""
        self._stack.close()

    def _decode(self, connection: Any, data: bytes) -> Any:
        stores = self._stores[connection.msgtype]
        for store in list(stores):
            try:
                decode = store.deserialize_ros1 if self.ros1 else store.deserialize_cdr
                return decode(data, connection.msgtype)
            except Exception as error:  # whatever the decoder meets in bytes that are of another layout, or damaged
                if store is stores[-1]:
                    raise self._undecodable(connection, error) from None
                stores.remove(store)
        raise self._undecodable(connection, ValueError("no layout"))

    def _undecodable(self, connection: Any, error: Exception) -> RecordingError:
        return RecordingError(
            f"a message on {connection.topic} cannot be decoded as {connection.msgtype} ({first_line(error)})",
            where=self._where,
            next_step=DAMAGED,
        )

    def _open(self, path: Path) -> list[Any]:
        from rosbags import rosbag1
        from rosbags.rosbag2 import reader
        from rosbags.rosbag2.storage_mcap import McapReader
        from rosbags.rosbag2.storage_sqlite3 import Sqlite3Reader

        if path.is_dir() and (path / "metadata.yaml").is_file():
            folder = reader.Reader(path)
            folder.open()
            self._stack.callback(folder.close)
            return [folder]
        kinds = {SQLITE: Sqlite3Reader, MCAP: McapReader, ROS1: rosbag1.Reader}
        files = sorted(f for f in path.iterdir() if head_of(f) in (SQLITE, MCAP)) if path.is_dir() else [path]
        storages = []
        for file in files:
            storage = kinds[head_of(file) or b""](file)
            storage.open()
            self._stack.callback(storage.close)
            storages.append(storage)
        return storages

    def _layouts(self) -> dict[str, list[Any]]:
        """Per message type the stores to decode it with: the layout that the bag states, else the published ones."""
        from rosbags.interfaces import MessageDefinitionFormat

        found: dict[str, list[Any]] = {}
        for connection in (c for s in self._storages for c in s.connections if c.msgtype in DEFINITIONS):
            name, definition = connection.msgtype, connection.msgdef
            stated = definition.format != MessageDefinitionFormat.NONE and bool(definition.data)
            idl = definition.format == MessageDefinitionFormat.IDL
            texts = [(definition.data, idl)] if stated else []
            texts += [(text, False) for text in DEFINITIONS[name]]
            stores = [store for text, is_idl in texts if (store := _store(name, text, is_idl, self.ros1)) is not None]
            found.setdefault(name, stores[:1] if stated else stores)
        return found

    def _damaged(self, error: Exception) -> RecordingError:
        return RecordingError(f"is a damaged bag ({first_line(error)})", where=self._where, next_step=DAMAGED)


def _store(name: str, text: str, idl: bool, ros1: bool) -> Any:
    """The published messages with one of them laid out as a text says; None where the text cannot be parsed."""
    from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.LATEST)
    try:
        types = get_types_from_idl(text) if idl else get_types_from_msg(text, name)
        store.register({key: fields for key, fields in types.items() if key not in store.types})
    except Exception:  # the library raises what its parsers raise; another layout is tried
        return None
    return store if name in store.types else None


def head_of(path: Path) -> bytes | None:
    """Which kind of bag file this is, by its first bytes; None for another file."""
    try:
        with path.open("rb") as stream:
            head = stream.read(16)
    except OSError:
        return None
    return next((magic for magic in (SQLITE, MCAP, ROS1) if head.startswith(magic)), None)


def library() -> None:
    """Make sure that bags can be read at all.

    Raises:
        MissingExtraError: the optional extra is not installed.
    """
    try:
        import rosbags  # noqa: F401
    except ModuleNotFoundError:
        raise MissingExtraError(
            "reading ROS bags needs the package rosbags", next_step="pip install 'lagnet[ros]'"
        ) from None


def first_line(error: BaseException) -> str:
    """What an exception says, shortened."""
    return (str(error).splitlines() or [""])[0][:100] or type(error).__name__
