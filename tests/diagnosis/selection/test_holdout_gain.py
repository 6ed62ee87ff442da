"""What an effect does for held-out recordings is told on the same scale as the fit that is shown beside it."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import diagnose

JOINT = 1


def test_the_error_with_the_only_effect_is_the_held_out_error_of_the_fit(plant, arm, at, names) -> None:
    real = plant(at(JOINT, lambda q, v, a, body: 0.2 * np.abs(body).mean() * v))
    fitted = [real.record(seed) for seed in (1, 2, 3)]
    calm = min((real.record(seed, seconds=12.0) for seed in range(4, 12)), key=lambda r: r.tau[:, JOINT].var())
    assert calm.tau[:, JOINT].var() < 0.5 * np.concatenate([r.tau for r in fitted])[:, JOINT].var()
    result = diagnose(fitted, arm, [calm])
    assert names(result) == {("viscous_friction", arm.joints[JOINT])}
    evidence, fit = result.effects[0].evidence, result.verdict.fit[JOINT]
    assert evidence.holdout_nmse_with == pytest.approx(fit.nmse_named, rel=0.05)
    assert evidence.holdout_nmse_without == pytest.approx(fit.nmse_nominal, rel=0.05)
