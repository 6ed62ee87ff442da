"""Sound archives and tables with one array in them broken, which a change of bytes hardly reaches behind a checksum."""

from __future__ import annotations

import io
import warnings
from collections.abc import Callable

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

VALUES = (np.nan, np.inf, -np.inf, 1e300, -1e308, 1e13, 0.0, -1.0, 1e-320)
TYPES = (np.int8, np.float16, np.bool_, np.complex128, np.uint64, "S8", "U8", "datetime64[ns]")


def archive_changed(data: bytes, rng: np.random.Generator) -> bytes:
    """A .npz file with one array changed."""
    with np.load(io.BytesIO(data), allow_pickle=False) as archive:
        arrays = {name: archive[name] for name in archive.files}
    name = str(rng.choice(list(arrays)))
    arrays[name] = changed(arrays[name], rng)
    if rng.random() < 0.1:
        arrays[str(rng.choice(list(arrays)))] = arrays.pop(name)
    stream = io.BytesIO()
    np.savez(stream, allow_pickle=False, **arrays)
    return stream.getvalue()


def table_changed(data: bytes, rng: np.random.Generator) -> bytes:
    """A Parquet file with one column changed, and all columns as long as that."""
    table = pq.read_table(io.BytesIO(data))
    name = str(rng.choice(table.column_names))
    column = table[name].to_numpy()
    if column.dtype == object:
        column = np.stack(list(column))
    new = np.atleast_1d(changed(column, rng))
    cut = {n: table[n].to_numpy()[: len(new)] for n in table.column_names}
    kept = min(len(new), table.num_rows)
    columns = {n: _as_column(new[:kept] if n == name else old[:kept]) for n, old in cut.items()}
    stream = io.BytesIO()
    pq.write_table(pa.table(columns).replace_schema_metadata(table.schema.metadata), stream)
    return stream.getvalue()


def _as_column(values: np.ndarray) -> pa.Array:
    if values.dtype.kind == "c":
        values = values.real
    return pa.array(values.tolist() if values.ndim > 1 or values.dtype.kind == "S" else values)


def changed(array: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """One array with another value, type, shape or order."""
    return CHANGES[int(rng.integers(len(CHANGES)))](np.array(array), rng)


def _value(array: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    if array.dtype.kind != "f" or not array.size:
        return array
    flat = array.reshape(-1)
    with np.errstate(over="ignore"):
        flat[rng.integers(0, flat.size, int(rng.choice([1, 1, 3, 50])))] = VALUES[int(rng.integers(len(VALUES)))]
    return array


def _all_values(array: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    with np.errstate(over="ignore"):
        return np.full_like(array, VALUES[int(rng.integers(len(VALUES)))]) if array.dtype.kind == "f" else array


def _scaled(array: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    factor = float(rng.choice([1e12, 1e-12, -1.0, 1e200, 1e-300]))
    with np.errstate(over="ignore", invalid="ignore"):
        return (array * factor).astype(array.dtype) if array.dtype.kind == "f" else array


def _type(array: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    try:
        with warnings.catch_warnings(action="ignore"), np.errstate(all="ignore"):
            return array.astype(TYPES[int(rng.integers(len(TYPES)))])
    except (ValueError, TypeError):
        return array


def _shorter(array: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    return array[: int(rng.integers(len(array) + 1))] if array.ndim else array


def _deeper(array: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    return array[..., None] if rng.random() < 0.5 else array.reshape(-1)


def _joint_lost(array: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    return array[:, :-1] if array.ndim > 1 else array[::-1]


def _shuffled(array: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    return rng.permutation(array) if array.ndim else array


def _repeated(array: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    return np.repeat(array, 2, axis=0) if array.ndim else array


CHANGES: tuple[Callable[[np.ndarray, np.random.Generator], np.ndarray], ...] = (
    *(_value, _value, _all_values, _scaled, _type, _shorter, _deeper, _joint_lost, _shuffled, _repeated),
)
