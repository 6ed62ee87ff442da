"""Broken inputs from sound ones: bytes, cells and whole files, drawn by a seed."""

from __future__ import annotations

import gzip
import re

import numpy as np

from validation.fuzz.arrays import archive_changed, table_changed
from validation.fuzz.seeds import plain

NUMBERS = ("1e300", "-1e308", "nan", "inf", "-inf", "0", "-1", "1e-320", "99999999999999999999", "0x10", "true", "1,5")
TEXTS = (
    "[]",
    "{}",
    '"text"',
    "null",
    "a" * 5000,
    "\u0000",
    "\u202e",
    "../../etc/passwd",
    "<script>alert(1)</script>",
    "",
)
PIECES = (b"\x00", b"\xff\xfe", b"\xef\xbb\xbf", b"\n" * 50, b'"', b"{" * 300, b"[" * 2000, b"<a>" * 300, b"PK\x03\x04")


GENTLE = 0.5  # of the inputs: one number, word or array is changed and all else is sound


def mutated(data: bytes, rng: np.random.Generator) -> bytes:
    """One to three changes of a file's bytes, or one of its content; a gzip coat is put on again, most times."""
    inner, coated = plain(data)
    if rng.random() < GENTLE:
        change = next((c for magic, c in OF_CONTENT.items() if inner.startswith(magic)), None)
        text = (_number_changed, _word_changed)[int(rng.integers(2))]
        inner = (change or text)(inner, rng)
        return gzip.compress(inner, compresslevel=1, mtime=0) if coated else inner
    if coated and rng.random() < 0.3:
        return _bytes_changed(data, rng)
    for _ in range(int(rng.integers(1, 4))):
        inner = CHANGES[int(rng.integers(len(CHANGES)))](inner, rng)
    return gzip.compress(inner, compresslevel=1, mtime=0) if coated else inner


def _bytes_changed(data: bytes, rng: np.random.Generator) -> bytes:
    out = bytearray(data)
    for _ in range(int(rng.integers(1, 20))):
        if out:
            out[int(rng.integers(len(out)))] = int(rng.integers(256))
    return bytes(out)


def _cut(data: bytes, rng: np.random.Generator) -> bytes:
    return data[: int(rng.integers(len(data) + 1))]


def _repeated(data: bytes, rng: np.random.Generator) -> bytes:
    a, b = sorted(int(x) for x in rng.integers(0, len(data) + 1, 2))
    return data[:a] + data[a:b] * int(rng.integers(2, 20 if b - a < 5000 else 3)) + data[b:]


def _left_out(data: bytes, rng: np.random.Generator) -> bytes:
    a, b = sorted(int(x) for x in rng.integers(0, len(data) + 1, 2))
    return data[:a] + data[b:]


def _inserted(data: bytes, rng: np.random.Generator) -> bytes:
    at = int(rng.integers(len(data) + 1))
    return data[:at] + PIECES[int(rng.integers(len(PIECES)))] + data[at:]


def _number_changed(data: bytes, rng: np.random.Generator) -> bytes:
    """A number of a text file in another, or something that is none."""
    places = list(re.finditer(rb"-?\d+\.?\d*(?:e-?\d+)?", data[:200_000]))
    if not places:
        return _bytes_changed(data, rng)
    place, values = places[int(rng.integers(len(places)))], NUMBERS + TEXTS
    return data[: place.start()] + values[int(rng.integers(len(values)))].encode() + data[place.end() :]


def _word_changed(data: bytes, rng: np.random.Generator) -> bytes:
    """A word of a text file in another word of it, or something that is none."""
    places = list(re.finditer(rb"[A-Za-z_]\w+", data[:200_000]))
    if not places:
        return _bytes_changed(data, rng)
    place, other = (places[int(k)] for k in rng.integers(0, len(places), 2))
    word = other.group() if rng.random() < 0.6 else TEXTS[int(rng.integers(len(TEXTS)))].encode()
    return data[: place.start()] + word + data[place.end() :]


OF_CONTENT = {b"PK": archive_changed, b"PAR1": table_changed}
CHANGES = (_bytes_changed, _cut, _repeated, _left_out, _inserted, _number_changed, _number_changed, _word_changed)
