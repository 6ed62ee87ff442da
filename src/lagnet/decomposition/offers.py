"""Which calls a model answers itself, beyond those of InverseDynamics."""

from __future__ import annotations

import inspect
from typing import Any

import numpy as np

from lagnet.errors import LagnetError

ENERGIES = {"kinetic_energy": 2, "potential_energy": 1}  # number of arrays they take

ROWS = 32  # of the call that tries: a model that compiles for every shape is asked for this one again


def offers(model: Any, call: str) -> bool:
    """Whether a model has a call of its own.

    What a model only passes on to the one it is built around does not count: the energies of a nominal arm are not
    those of the corrected one. A model may also have energies in its type and none in fact (a network of torques).
    """
    # A property or partial is callable only once it is read; what is not in the type or the instance is passed on.
    if inspect.getattr_static(model, call, None) is None or not callable(getattr(model, call, None)):
        return False
    if call in ENERGIES:
        try:
            getattr(model, call)(*[np.zeros((ROWS, model.n_dof))] * ENERGIES[call])
        except LagnetError:
            return False
    return True
