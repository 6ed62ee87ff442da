"""A damaged MATLAB file is refused before SciPy's compiled reader sees it, which a wrong type ends with the process."""

from __future__ import annotations

import io
import struct
import zlib

import numpy as np
import pytest
import scipy.io

from lagnet.errors import RecordingError
from lagnet.recordings.readers.mat_file import MatArrays
from lagnet.recordings.readers.mat_layout import HEADER

TIME = np.arange(60) / 100.0


def saved(**options) -> bytes:
    """A file with one array of 60 numbers."""
    stream = io.BytesIO()
    scipy.io.savemat(stream, {"time": TIME}, **options)
    return stream.getvalue()


def with_number(data: bytes, at: int, value: int) -> bytes:
    return data[:at] + struct.pack("<I", value) + data[at + 4 :]


def compressed(data: bytes) -> bytes:
    """The same file with its array compressed."""
    inner = zlib.compress(data[HEADER:])
    return data[:HEADER] + struct.pack("<II", 15, len(inner)) + inner


PLACES = {  # bytes behind the tag of the array
    "type of the numbers": 40,
    "their length": 44,
    "type of the flags": 0,
    "type of the shape": 16,
    "shape": 24,
}


@pytest.mark.parametrize("coat", [lambda data: data, compressed], ids=["plain", "compressed"])
@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("value", [0, 10, 99, 255, 2**31 - 1])
def test_what_contradicts_the_format_is_refused(coat, place, value) -> None:
    broken = coat(with_number(saved(), HEADER + 8 + PLACES[place], value))
    with pytest.raises(RecordingError):
        MatArrays(broken, "run.mat").array("time")


@pytest.mark.parametrize("options", [{}, {"do_compression": True}, {"format": "4"}, {"long_field_names": True}])
def test_sound_files_are_read(options) -> None:
    np.testing.assert_array_equal(MatArrays(saved(**options), "run.mat").array("time").ravel(), TIME)


def test_all_kinds_of_arrays_are_let_through() -> None:
    stream, kinds = io.BytesIO(), (np.float32, np.int8, np.uint16, np.int64, np.complex128, np.bool_)
    arrays = {np.dtype(k).name: np.arange(6).reshape(2, 3).astype(k) for k in kinds}
    scipy.io.savemat(
        stream, {**arrays, "text": "words", "cell": np.array([1, "a"], dtype=object), "empty": np.zeros((0, 3))}
    )
    read = MatArrays(stream.getvalue(), "run.mat")
    for name in set(arrays) & set(read.shapes):
        np.testing.assert_array_equal(read.array(name), arrays[name])
    assert {"float32", "int8", "uint16", "int64"} <= set(read.shapes)
