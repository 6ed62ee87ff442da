"""A payload that motion shows, as a value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class PayloadFound:
    """A payload at the last link.

    Args:
        values: m [kg] and c [m] in the last joint's frame.
        intervals: 95 %, by name.
        tied: effects of one joint that predict as well.
        gain, errors: of the held-out score over the nominal model, and that gain over its standard error.
        lead: of the held-out score over the effects joint by joint.
        lead_errors: that lead over its standard error.
        power: mean squared held-out error over the variance of the motion, without and with it.
        body: shape (10,), (m, m c, I) at the last joint's frame [kg, kg m, kg m²], as the corrected model carries it.
    """

    values: Mapping[str, float]
    intervals: Mapping[str, tuple[float, float]]
    tied: tuple[str, ...]
    gain: float
    errors: float
    lead: float
    lead_errors: float
    power: tuple[float, float]
    body: np.ndarray
