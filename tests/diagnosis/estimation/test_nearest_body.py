"""Real bodies nearest to fitted ones: alone, and next to each other, where they share what a fit cannot tell."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.estimation.nearest_body import nearest_body
from lagnet.rigid_body.inertia import is_physically_consistent, parameters_of_body

LINK = parameters_of_body(3.0, np.array([0.02, -0.1, 0.05]), np.diag([0.03, 0.02, 0.025]))
LOAD = parameters_of_body(1.2, np.array([0.01, 0.02, 0.12]), np.diag([2e-3, 2e-3, 1e-3]))
SHIFTED = 4.0  # [kg] that the fit gave to one body and took from the other


@pytest.fixture(scope="module")
def shared() -> tuple[np.ndarray, np.ndarray]:
    """Information on two bodies of which only the sum of masses is told, and a fit with a negative mass."""
    mass = np.zeros(20)
    mass[[0, 10]] = 1.0, -1.0
    mass /= np.linalg.norm(mass)
    gram = 1e6 * (np.eye(20) - np.outer(mass, mass))
    wanted = np.array([0.8 * LINK, LOAD])
    wanted[:, 0] += SHIFTED, -SHIFTED
    return gram, wanted


def test_bodies_that_share_a_mass_are_made_real_together_without_loss(shared) -> None:
    gram, wanted = shared
    found = nearest_body(gram, wanted, np.array([LINK, np.zeros(10)]))
    assert found.shape == wanted.shape
    assert np.all(is_physically_consistent(found))
    change = (found - wanted).ravel()
    assert change @ gram @ change < 20.0  # within chance, as far as bodies are held near the model
    assert found[:, 0].sum() == pytest.approx(0.8 * LINK[0] + LOAD[0], abs=0.01)


def test_one_after_the_other_would_lose_what_the_second_needs(shared) -> None:
    """The load alone, the link held as fitted, cannot be real near its fitted parameters."""
    gram, wanted = shared
    alone = nearest_body(gram[10:, 10:], wanted[1], np.zeros(10))
    change = np.concatenate([np.zeros(10), alone - wanted[1]])
    assert change @ gram @ change > 1e3


def test_a_real_body_that_is_told_stays() -> None:
    found = nearest_body(1e8 * np.eye(10), 1.3 * LINK, LINK)
    np.testing.assert_allclose(found, 1.3 * LINK, rtol=0, atol=1e-3)
