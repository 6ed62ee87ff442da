"""A model called with care: batches of one size for a model that compiles, checked shapes, finite numbers."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from lagnet.errors import ModelError
from lagnet.types import Trajectory

BATCH = 32  # the only batch size that a compiled model sees: it compiles once a call, not for every number of rows
# Solving for accelerations costs a compiled model far more than being called does: few rows are padded to fewer.
BATCH_OF = {"forward_dynamics": 8}
COMPILING = 0.1, 5.0  # [s] and ratio by which a first call outlasts the second, if the model compiles
SQUARE, SCALAR = ("mass_matrix", "coriolis_matrix"), ("kinetic_energy", "potential_energy")


class NotFinite(Exception):
    """The model gave a number that is not finite; carries the call and the configuration."""

    def __init__(self, call: str, where: dict[str, list[float]]):
        self.call, self.where = call, where
        super().__init__(call)


@dataclass(frozen=True, eq=False)
class CarefulCalls:
    """A model that others wrote, asked for arrays.

    Args:
        model: anything with the InverseDynamics calls.
    """

    model: Any

    def call(self, name: str, *arrays: Trajectory) -> np.ndarray:
        """One call of the model, in batches of one size if it compiles.

        Raises:
            ModelError: the call fails, or gives an array of another shape.
            NotFinite: it gives a number that is not finite.
        """
        out = self._in_batches(name, arrays) if self.compiles else self._answer(name, list(arrays))
        good = np.isfinite(out.reshape(len(out), -1)).all(axis=1)
        if not good.all():
            bad = int(np.flatnonzero(~good)[0])
            raise NotFinite(name, {s: array[bad].tolist() for s, array in zip("qva", arrays, strict=False)})
        return out

    @cached_property
    def compiles(self) -> bool:
        """Whether the model compiles anew for every shape of its arrays: it says so, or its first call shows it."""
        if isinstance(said := getattr(self.model, "compiles", None), bool):
            return said
        row = np.random.default_rng(14).uniform(-1.0, 1.0, (3, 1, self.model.n_dof))
        rows, took = [np.repeat(x, BATCH, axis=0) for x in row], []
        for _ in range(2):
            begin = time.perf_counter()
            self._answer("inverse_dynamics", rows)
            took.append(time.perf_counter() - begin)
        least, ratio = COMPILING
        return took[0] > least and took[0] > ratio * took[1]

    def _in_batches(self, name: str, arrays: tuple[Trajectory, ...]) -> np.ndarray:
        pieces, size = [], BATCH_OF.get(name, BATCH)
        for start in range(0, len(arrays[0]), size):
            rows = [array[start : start + size] for array in arrays]
            short = size - len(rows[0])
            padded = [np.concatenate([r, np.repeat(r[-1:], short, axis=0)]) for r in rows] if short else rows
            pieces.append(self._answer(name, padded)[: len(rows[0])])
        return np.concatenate(pieces)

    def _answer(self, name: str, arrays: list[np.ndarray]) -> np.ndarray:
        n, dof = arrays[0].shape
        try:
            out = np.asarray(getattr(self.model, name)(*arrays), dtype=float)
        except (TypeError, ValueError, IndexError, ArithmeticError, AttributeError) as error:
            raise ModelError(
                f"{name} failed on arrays of shape {arrays[0].shape}: {error}",
                where=type(self.model).__name__,
                next_step="the calls take NumPy arrays, batch first, and return one row a sample",
            ) from error
        expected = (n, dof, dof) if name in SQUARE else (n,) if name in SCALAR else (n, dof)
        if out.shape != expected:
            raise ModelError(f"{name} gives shape {out.shape}, expected {expected}", where=type(self.model).__name__)
        return out
