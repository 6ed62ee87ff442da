"""What a refit gives back lies inside physical bounds, also where several bodies ask for what no mass gives."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.refit import refit
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected import NamedEffect
from lagnet.rigid_body.inertia import is_physically_consistent

LINKS = (0, 1, 2)
IMPOSSIBLE = -3.0  # times the rotational inertia of each link is added


@pytest.fixture(scope="module")
def posed(plant, arm):
    """A plant whose torque is that of links with negative inertia."""
    bodies = np.asarray(arm.inertial_parameters())
    changes = np.zeros_like(bodies)
    changes[:, 4:] = IMPOSSIBLE * bodies[:, 4:]

    def law(q, v, a, body):
        return sum((arm.link_regressor(k, q, v, a) @ changes[k] for k in LINKS), np.zeros_like(q))

    real = plant(law)
    return pose(arm, real.record(61), real.record(62))


@pytest.mark.parametrize("links", [(0, 1), (2, 0), (0, 1, 2)])
def test_no_body_is_given_that_no_mass_has(posed, arm, links) -> None:
    nothing = effect_named("link_inertia").from_coordinates(np.zeros(10))
    start = [NamedEffect("link_inertia", k, nothing) for k in links]
    bodies = np.asarray(arm.inertial_parameters())
    found = refit(posed.problem, start, posed.noise).effects
    after = np.array([bodies[e.joint] + e.coordinates() for e in found])
    assert [e.joint for e in found] == list(links)
    assert is_physically_consistent(after).all()
    assert not np.allclose(after, bodies[list(links)], rtol=1e-3)
