"""Adds the layers of the correction to a verdict: their nMSE on held-out torque, and the identified parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.identified.fit import Identified
from lagnet.diagnosis.identified.verdict_entry import identified_as_json
from lagnet.diagnosis.verdict.verdict import JointFit, Verdict
from lagnet.diagnosis.verdict.wording import BESIDE_FREE_LINKS, whole_error_words
from lagnet.models.corrected.model import CorrectedModel


def with_layers(
    verdict: Verdict, errors: Mapping[str, np.ndarray], found: Identified | None, corrected: CorrectedModel
) -> Verdict:
    """The verdict with the held-out errors of all layers, each from the same samples, and the identified layer.

    Args:
        verdict: of the named physics.
        errors: nMSE (dof,) of "nominal", "named", "identified" and "corrected" torque.
        found: the identified layer with its equations.
        corrected: the model of all layers.
    """
    fits = tuple(_fit(fit, errors, j, corrected.remainder is not None) for j, fit in enumerate(verdict.fit))
    told = identified_as_json(found, corrected.regressor_source, corrected.joints, corrected.instead is not None)
    beside = BESIDE_FREE_LINKS in verdict.warnings
    effects = tuple(replace(e, explanation=e.explanation + whole_error_words(e, fits, beside)) for e in verdict.effects)
    return replace(verdict, fit=fits, effects=effects, identified=told)


def _fit(fit: JointFit, errors: Mapping[str, np.ndarray], joint: int, learned: bool) -> JointFit:
    at = {kind: float(values[joint]) for kind, values in errors.items()}
    return replace(
        fit,
        nmse_nominal=at["nominal"],
        nmse_named=at["named"],
        nmse_identified=at["identified"],
        nmse_full=at["corrected"],
        nmse_named_and_residual_network=at["corrected"] if learned else None,
    )
