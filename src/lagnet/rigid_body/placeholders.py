"""Links whose masses nobody knew: none at all, or one number for each."""

from __future__ import annotations

import numpy as np

SAME = 1e-6  # of the usual mass: rounding
FEWEST = 3  # links: two of one mass may be two of one make


def are_placeholders(masses: np.ndarray) -> bool:
    """Whether no link has mass, or all but one at most have the same, of three or more.

    A tool that is welded on gives the last link another one.

    Args:
        masses: shape (dof,), of the bodies behind each joint [kg].
    """
    masses = np.asarray(masses, dtype=float)
    if not masses.any():
        return True
    usual = float(np.median(masses))
    return masses.size >= FEWEST and int(np.sum(np.abs(masses - usual) > SAME * usual)) <= 1
