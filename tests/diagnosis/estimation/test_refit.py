"""What a refit gives back lies inside physical bounds, also where several bodies ask for what no mass gives."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.estimation.refit import refit
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.model import NamedEffect
from lagnet.reports.wording import NOT_SAID
from lagnet.rigid_body.inertia import is_physically_consistent

LINKS = (0, 1, 2)
ROTOR = 0.5  # [kg m²]
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


@pytest.fixture(scope="module")
def rotor(plant, arm):
    """A plant whose first joint has inertia that the model lacks."""

    def law(q, v, a, body):
        out = np.zeros_like(q)
        out[:, 0] = ROTOR * a[:, 0]
        return out

    real = plant(law)
    return pose(arm, real.record(63), real.record(64))


@pytest.mark.parametrize("extra", [0.0, 90.0])
def test_what_recordings_leave_open_stays_near_the_model(rotor, arm, extra) -> None:
    """The mass of the first link, that no motion of the arm shows, wherever the search put it."""
    base = np.asarray(arm.inertial_parameters())[0]
    start = np.zeros(10)
    start[0] = extra
    law = effect_named("link_inertia")
    found = refit(rotor.problem, [NamedEffect("link_inertia", 0, law.from_coordinates(start))], rotor.noise)
    change, told = found.effects[0].coordinates(), found.intervals[0]
    assert is_physically_consistent(base + change)
    assert abs(change[0]) < base[0]
    open_ = {name for name, (low, high) in told.items() if high - low > 2.0 * NOT_SAID}
    assert "dm" in open_
    about = [told[name] for name in ("dIxx", "dIyy", "dIzz") if name not in open_]
    assert any(low < ROTOR < high and high - low < 0.2 * ROTOR for low, high in about)
