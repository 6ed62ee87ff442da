"""Positions in another unit, q → s q, too small for a violation of the joints' limits."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.data_quality.check import Evidence, Reading, ReadingCheck
from lagnet.diagnosis.data_quality.misfit import misfit_of, misfits_of
from lagnet.diagnosis.data_quality.samples import Samples
from lagnet.types import joint_types_of

TURNS = {"turns": 2.0 * np.pi, "half turns": np.pi, "degrees": np.pi / 180.0, "milliradians": 1e-3, "gons": np.pi / 200}
WAYS = {"millimetres": 1e-3, "centimetres": 1e-2, "inches": 0.0254}


class PositionUnit(ReadingCheck):
    """Recordings that fit the model when all revolute (or all sliding) positions are read in another unit."""

    name = "position_unit"
    title = "positions are in another unit"

    def readings(self, evidence: Evidence) -> Iterator[Reading]:
        sliding = np.array([kind == "prismatic" for kind in joint_types_of(evidence.model, evidence.model.n_dof)])
        for units, which in ((TURNS, ~sliding), (WAYS, sliding)):
            if not which.any():
                continue
            found = [(misfit_of(evidence.model, scaled(evidence.few, f, which)), u, f) for u, f in units.items()]
            for _, unit, factor in sorted(found)[:1]:
                yield Reading(
                    self.name,
                    "q",
                    misfits_of(evidence.model, scaled(evidence.many, factor, which)),
                    f"positions are in {unit}: so read, they fit the model's torques",
                    f"[scale] q = {factor:.7g}, and v and a alike"
                    if which.all()
                    else "; ".join(f'[scale] "q_{j}" = {factor:.7g}' for j in np.flatnonzero(which)),
                )


def scaled(samples: Samples, factor: float, which: np.ndarray) -> Samples:
    """The samples with some joints' positions in another unit."""
    by = np.where(which, factor, 1.0)
    return replace(samples, q=samples.q * by, v=samples.v * by, a=samples.a * by)
