"""Reads a robot description that nobody vouches for: bounded size and depth, no entities, no other file opened."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree
from xml.parsers import expat

from lagnet.errors import RobotError
from lagnet.files import read_bounded

MAX_BYTES = 20_000_000  # the largest humanoid of example-robot-data takes 0.3 MB
MAX_DEPTH = 400  # MJCF nests a body in a body; no robot has a chain this long
MAX_ELEMENTS = 200_000


@dataclass(frozen=True)
class XmlFile:
    """The bytes of a description, their checksum, and where they came from."""

    source: str
    text: bytes
    sha256: str

    def root(self) -> ElementTree.Element:
        """A fresh element tree of the file."""
        return ElementTree.fromstring(self.text)


def read_xml(path: Path) -> XmlFile:
    """Reads the file and refuses what no robot description needs.

    Raises:
        RobotError: unreadable, too large, not XML, or with a document type (entities, other files).
    """
    try:
        if path.is_dir():
            raise RobotError("is a folder, not a URDF or MJCF file", where=str(path))
        if path.stat().st_size > MAX_BYTES:
            raise RobotError(f"larger than {MAX_BYTES // 1_000_000} MB: no robot description", where=str(path))
        text = read_bounded(path, MAX_BYTES)
    except OSError as error:
        raise RobotError(f"cannot be read ({error.strerror})", where=str(path)) from error
    return checked_xml(text, str(path))


def checked_xml(text: bytes, source: str) -> XmlFile:
    """The same checks for a text that is already in memory."""
    _scan(text, source)
    return XmlFile(source, text, hashlib.sha256(text).hexdigest())


def _scan(text: bytes, source: str) -> None:
    """One pass of the parser itself, so that no encoding hides a document type from the check."""
    parser = expat.ParserCreate(namespace_separator=" ")  # as the tree builder does, to find the same faults
    depth = elements = 0

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal depth, elements
        depth, elements = depth + 1, elements + 1
        if depth > MAX_DEPTH or elements > MAX_ELEMENTS:
            raise RobotError(f"nested deeper than {MAX_DEPTH} or more than {MAX_ELEMENTS} elements", where=source)

    def end(name: str) -> None:
        nonlocal depth
        depth -= 1

    def doctype(*_: object) -> None:
        raise RobotError(
            f"line {parser.CurrentLineNumber} declares a document type, which is refused",
            where=source,
            next_step="delete the DOCTYPE and ENTITY lines",
        )

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = doctype
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        what = f"broken XML in line {error.lineno}, column {error.offset}: {expat.ErrorString(error.code)}"
        raise RobotError(what, where=source) from error
    except (ValueError, LookupError) as error:  # an encoding that Python does not know
        raise RobotError(f"cannot be read as XML ({error})", where=source) from error
