"""Where in a step a damper acts: at its middle where the step resolves it, towards its end where it does not."""

from __future__ import annotations

from numba import njit


@njit(cache=True, error_model="numpy")
def explicit_share(damping, m, h):  # pragma: no cover - compiled
    """Share of a damper that is taken at the start of the step: half (second order) where the step resolves it."""
    return 0.5 if h * damping <= 2.0 * m else m / (h * damping)
