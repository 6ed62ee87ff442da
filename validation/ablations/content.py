"""A digest of values by their content, so that equal questions are known again."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

PLAIN = (str, bytes, bool, int, float, complex, np.generic, type(None))
LEFT_OUT = "limits"  # what is remembered must not depend on them


class Contents:
    """Digests; what has no content that can be read, such as a robot, counts by its identity and is kept alive."""

    def __init__(self) -> None:
        self._kept: dict[int, Any] = {}

    def digest(self, x: Any) -> bytes:
        """Of arrays, plain values, containers and dataclasses, all the way down."""
        digest = hashlib.blake2b(digest_size=16)
        self._feed(digest, x)
        return digest.digest()

    def _feed(self, digest: Any, x: Any) -> None:
        if isinstance(x, np.ndarray) and x.dtype != object:
            digest.update(repr((x.shape, x.dtype)).encode() + b":")
            digest.update(np.ascontiguousarray(x).data if x.size else b"")
        elif isinstance(x, PLAIN):
            digest.update(f"{type(x).__name__}:{x!r};".encode())
        elif is_dataclass(x) and not isinstance(x, type):
            own = [f.name for f in fields(x) if f.init and f.name != LEFT_OUT]
            self._feed(digest, (type(x).__qualname__, *((n, getattr(x, n)) for n in own)))
        elif isinstance(x, Mapping):
            self._feed(digest, tuple(x.items()))
        elif isinstance(x, (tuple, list)):
            digest.update(f"{len(x)}(".encode())
            for part in x:
                self._feed(digest, part)
        else:
            self._kept[id(x)] = x
            digest.update(f"id:{id(x)};".encode())
