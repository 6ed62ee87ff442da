"""A disturbance near the band hides a law; the diagnosis finds it in a narrower band by itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import diagnose

pytestmark = pytest.mark.slow

FRICTION = 1.5  # [N m s/rad]
RINGING, DROWNING, QUICK = 3.0, 10.0, 5.0  # [N m], [N m], [Hz]


@pytest.fixture(scope="module")
def recordings(plant, at):
    """Friction at one joint, under a ringing of its torque, of so many N m, that comes and goes."""
    real = plant(at(1, lambda q, v, a, t: FRICTION * v))

    def ringing(size: float, seed: int):
        r = real.record(seed)
        swell = np.sin(2.0 * np.pi * 0.07 * r.time + seed) ** 2
        tau = r.tau.copy()
        tau[:, 1] += size * swell * np.sin(2.0 * np.pi * QUICK * r.time + 0.8 * np.sin(0.9 * r.time))
        return replace(r, tau=tau)

    return lambda size: ([ringing(size, 1), ringing(size, 2)], [ringing(size, 3)])


@pytest.mark.parametrize("size", [RINGING, DROWNING])
def test_what_rings_near_the_band_does_not_hide_friction(recordings, arm, names, size) -> None:
    fit, held = recordings(size)
    found = diagnose(fit, arm, held)
    assert names(found) == {("viscous_friction", arm.joints[1])}
    assert found.effects[0].value("Fv") == pytest.approx(FRICTION, rel=0.05)
    assert size < DROWNING or found.verdict.conditioning["bandwidth_hz"] < QUICK


def test_a_bandwidth_that_is_given_is_kept(recordings, arm) -> None:
    fit, held = recordings(RINGING)
    assert diagnose(fit, arm, held, bandwidth=12.0).verdict.conditioning["bandwidth_hz"] == 12.0


def test_where_nothing_puzzles_one_band_is_enough(plant, arm, at, monkeypatch) -> None:
    tried = []
    monkeypatch.setattr("lagnet.diagnosis.reruns.band._narrower", lambda *given: tried.append(given) or [])
    real = plant(at(1, lambda q, v, a, t: FRICTION * v))
    diagnose([real.record(1)], arm, [real.record(2)])
    assert not tried
