"""The elements of a MATLAB 5 file, held against its format before SciPy reads them.

SciPy's compiled reader looks up the type of an array's numbers in a table without a check of its bounds: one wrong byte
there ends the process. Each element has a tag of two 32-bit numbers, its type and its length in bytes (MATLAB, MAT-File
Format, 2023).
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable
from math import prod

from lagnet.recordings.readers.source import refuse_if_huge

HEADER = 128  # bytes of text, version and byte order before the first element
MATRIX, COMPRESSED = 14, 15
WHOLE, NAMES, UINT32 = (5, 6), (1, 16), 6  # types of a shape, of a name, of flags
NUMERIC_CLASSES = range(6, 16)
COMPLEX = 0x0800
SIZES = {1: 1, 2: 1, 3: 2, 4: 2, 5: 4, 6: 4, 7: 4, 9: 8, 12: 8, 13: 8}  # bytes of a number, by type

Take = Callable[[int, int], bytes]  # (first, length) of an element's content


def check_layout(data: bytes, where: str) -> None:
    """Walks through the numeric arrays of a file; one of version 4, whose reader is safe, is let through.

    Raises:
        ValueError: an array whose type, length or shape contradicts the format.
        RecordingError: an array too large to be a recording.
    """
    if 0 in data[:4]:
        return
    order = {b"IM": "<", b"MI": ">"}.get(data[126:128])
    if order is None:
        raise ValueError("no byte order")
    at = HEADER
    while at + 8 <= len(data):
        kind, length = struct.unpack(order + "II", data[at : at + 8])
        if kind == MATRIX:
            _check_matrix(lambda a, n, at=at: data[at + 8 + a : at + 8 + a + n], order, where)
        elif kind == COMPRESSED:
            _check_matrix(_Inflated(data[at + 8 : at + 8 + length]).take, order, where, tag=8)
        at += 8 + length


class _Inflated:
    """The beginning of compressed bytes, as far as it was asked for."""

    def __init__(self, data: bytes):
        self._stream, self._rest, self._known = zlib.decompressobj(), data, bytearray()

    def take(self, first: int, length: int) -> bytes:
        """Content from a place on.

        Raises:
            zlib.error: damaged.
        """
        while len(self._known) < first + length and self._rest:
            more = self._stream.decompress(self._rest, first + length - len(self._known))
            self._rest = self._stream.unconsumed_tail
            self._known += more
            if not more:
                break
        return bytes(self._known[first : first + length])


def _check_matrix(take: Take, order: str, where: str, tag: int = 0) -> None:
    """One array: flags, shape, name, real and imaginary part; a compressed one has its own tag before them."""
    kind, length, at, flags_at = _element(take, order, tag)
    if kind != UINT32 or length != 8:
        raise ValueError("flags")
    (flags,) = struct.unpack(order + "I", take(flags_at, 4))
    if flags & 0xFF not in NUMERIC_CLASSES:
        return
    kind, length, at, shape_at = _element(take, order, at)
    if kind not in WHOLE or not 8 <= length <= 128:
        raise ValueError("shape")
    shape = struct.unpack(f"{order}{length // 4}i", take(shape_at, length // 4 * 4))
    kind, _, at, _ = _element(take, order, at)
    if kind not in NAMES or min(shape) < 0:
        raise ValueError("name")
    refuse_if_huge(prod(shape) * 8, where)
    for _ in range(2 if flags & COMPLEX else 1):
        kind, length, at, _ = _element(take, order, at)
        if kind not in SIZES or length != prod(shape) * SIZES[kind]:
            raise ValueError("numbers")


def _element(take: Take, order: str, at: int) -> tuple[int, int, int, int]:
    """Type and length of an element, where the next one begins, and where this one's content does."""
    kind, length = struct.unpack(order + "II", take(at, 8))
    if kind >> 16:  # at most four bytes, in the tag itself
        return kind & 0xFFFF, kind >> 16, at + 8, at + 4
    return kind, length, at + 8 + (length + 7) // 8 * 8, at + 8
