"""A training's state on disk, so that a killed run goes on to the same result."""

from __future__ import annotations

import hashlib
import io
import json
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from lagnet.errors import ModelError, RecordingError
from lagnet.files import write_whole
from lagnet.recordings.readers.npz_file import NpzArchive

FILE = "training_checkpoint.npz"


def fingerprint(**said: Any) -> str:
    """Checksum of what a run is about: data, settings, seed. A checkpoint of another run is refused by it."""
    return hashlib.sha256(json.dumps(said, sort_keys=True, default=str).encode()).hexdigest()


def write_checkpoint(path: Path, state: Any, about: str, told: Any = None) -> None:
    """Write all arrays of a state, and plain values that were told so far; the file appears whole or not at all."""
    leaves = jax.tree.leaves(state)
    arrays = {f"leaf_{i}": np.asarray(_plain(x)) for i, x in enumerate(leaves)}
    stream = io.BytesIO()
    texts = {"about": about, "told": json.dumps(told)}
    texts = {name: np.frombuffer(text.encode(), np.uint8) for name, text in texts.items()}
    np.savez(stream, allow_pickle=False, **texts, **arrays)
    write_whole(path, stream.getvalue())


def read_checkpoint(path: Path, like: Any, about: str) -> tuple[Any, Any] | None:
    """The state in a checkpoint and what was told with it, None where there is none.

    Args:
        path: the file.
        like: a state of the same run, for its structure.
        about: fingerprint that the checkpoint must carry.

    Raises:
        ModelError: the file is damaged, or belongs to another run.
    """
    if not path.is_file():
        return None
    leaves, tree = jax.tree.flatten(like)
    try:
        archive = NpzArchive(path.read_bytes(), str(path))
        if bytes(archive.array("about")).decode() != about:
            raise ModelError("belongs to another training", where=str(path), next_step="remove it to start anew")
        wanted = {f"leaf_{i}": _plain(x).shape for i, x in enumerate(leaves)}
        if {n: s for n, s in archive.shapes.items() if n not in ("about", "told")} != wanted:
            raise ModelError("does not fit this training", where=str(path), next_step="remove it to start anew")
        arrays = [archive.array(name) for name in wanted]
        told = json.loads(bytes(archive.array("told")))
    except (RecordingError, KeyError, ValueError):
        raise ModelError("is damaged", where=str(path), next_step="remove it to start anew") from None
    return tree.unflatten([_like(x, leaf) for x, leaf in zip(arrays, leaves, strict=True)]), told


def _is_key(leaf: Any) -> bool:
    return isinstance(leaf, jax.Array) and jnp.issubdtype(leaf.dtype, jax.dtypes.prng_key)


def _plain(leaf: Any) -> Any:
    """Random keys as the integers behind them, all else as it is."""
    return jax.random.key_data(leaf) if _is_key(leaf) else jnp.asarray(leaf)


def _like(array: np.ndarray, leaf: Any) -> Any:
    values = jnp.asarray(array, _plain(leaf).dtype)
    return jax.random.wrap_key_data(values) if _is_key(leaf) else values
