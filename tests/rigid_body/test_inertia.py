"""Ten numbers and bodies: conversions are exact, and only real bodies pass."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lagnet.rigid_body import inertia

IDENTITY = 1e-9  # round trips in float64 on numbers of order 1
DIFFERENCE = 1e-6  # central differences at step 1e-6, relative

coordinates = st.lists(st.floats(-1.0, 1.0), min_size=10, max_size=10).map(np.array)


@given(coordinates)
def test_every_log_cholesky_point_is_a_body_and_comes_back(theta):
    parameters = inertia.from_log_cholesky(theta)
    assert inertia.is_physically_consistent(parameters)
    assert inertia.triangle_inequality(parameters) > 0
    assert inertia.smallest_eigenvalue(parameters) > 0
    assert np.allclose(inertia.to_log_cholesky(parameters), theta, atol=1e-7)


@given(coordinates)
def test_pseudo_inertia_is_linear_and_comes_back(theta):
    parameters = inertia.from_log_cholesky(theta)
    matrix = inertia.pseudo_inertia(parameters)
    assert np.allclose(inertia.from_pseudo_inertia(matrix), parameters, rtol=IDENTITY)
    assert np.allclose(inertia.pseudo_inertia(3 * parameters), 3 * matrix, rtol=IDENTITY)


@given(coordinates)
def test_the_slope_of_log_cholesky_matches_differences(theta):
    steps = np.eye(10) * 1e-6
    slope = [(inertia.from_log_cholesky(theta + e) - inertia.from_log_cholesky(theta - e)) / 2e-6 for e in steps]
    exact = inertia.log_cholesky_jacobian(theta)
    assert np.abs(np.stack(slope, axis=1) - exact).max() < DIFFERENCE * (1 + np.abs(exact).max())


def test_pseudo_inertia_is_the_second_moment_of_point_masses():
    generator = np.random.default_rng(0)
    points, masses = generator.normal(size=(7, 3)), generator.uniform(0.1, 1.0, 7)
    com = masses @ points / masses.sum()
    arms = points - com
    tensor = sum(m * (r @ r * np.eye(3) - np.outer(r, r)) for m, r in zip(masses, arms, strict=True))
    parameters = inertia.parameters_of_body(masses.sum(), com, tensor)
    homogeneous = np.column_stack([points, np.ones(7)])
    expected = (homogeneous.T * masses) @ homogeneous
    assert np.allclose(inertia.pseudo_inertia(parameters), expected, atol=IDENTITY)
    assert np.allclose(inertia.tensor_about_com(parameters), tensor, atol=IDENTITY)


def test_a_solid_box_has_the_moments_of_the_textbook():
    a, b, c, m = 0.3, 0.2, 0.1, 2.0
    tensor = m / 12 * np.diag([b * b + c * c, a * a + c * c, a * a + b * b])
    parameters = inertia.parameters_of_body(m, np.array([1.0, 2.0, 3.0]), tensor)
    assert inertia.principal_moments(parameters) == pytest.approx(np.sort(np.diag(tensor)))
    assert inertia.is_physically_consistent(parameters)


@pytest.mark.parametrize(
    ("mass", "moments"),
    [(-1.0, (1, 1, 1)), (0.0, (1, 1, 1)), (1.0, (1, 1, -1)), (1.0, (1.0, 1.0, 2.02)), (1.0, (1, 1, 3))],
)
def test_what_no_mass_can_make_is_refused(mass, moments):
    parameters = np.array([mass, 0, 0, 0, moments[0], 0, moments[1], 0, 0, moments[2]], dtype=float)
    assert not inertia.is_physically_consistent(parameters)
    with pytest.raises(ValueError, match="not a physically consistent body"):
        inertia.to_log_cholesky(parameters)


def test_the_margin_lets_a_flat_body_pass_and_is_free_of_units():
    flat = inertia.parameters_of_body(1.0, np.array([0.1, 0.0, 0.0]), np.diag([1.0, 1.0, 2.0]))
    assert inertia.is_physically_consistent(flat, margin=-1e-9)
    assert not inertia.is_physically_consistent(flat, margin=1e-9)
    body = inertia.from_log_cholesky(np.linspace(-1, 1, 10))
    in_millimetres = body * np.array([1, *[1e3] * 3, *[1e6] * 6])
    for margin in (0.0, 1e-3, 1e-2, 0.1):
        assert inertia.is_physically_consistent(body, margin) == inertia.is_physically_consistent(
            in_millimetres, margin
        )


def test_many_bodies_at_once_and_wrong_shapes():
    bodies = np.array([inertia.from_log_cholesky(t) for t in np.random.default_rng(0).normal(size=(4, 10)) * 0.3])
    assert inertia.pseudo_inertia(bodies).shape == (4, 4, 4)
    assert inertia.principal_moments(bodies).shape == (4, 3)
    assert inertia.is_physically_consistent(bodies).tolist() == [True] * 4
    with pytest.raises(ValueError, match=r"expected \(…, 10\)"):
        inertia.pseudo_inertia(np.zeros(9))
    with pytest.raises(ValueError, match=r"expected \(…, 4, 4\)"):
        inertia.from_pseudo_inertia(np.zeros((3, 3)))


def test_least_density_of_a_ball_is_its_own() -> None:
    mass, radius = 3.0, 0.07
    ball = inertia.parameters_of_body(mass, np.array([0.3, -0.1, 0.2]), 0.4 * mass * radius**2 * np.eye(3))
    assert inertia.least_density(ball) == pytest.approx(mass / (4.0 / 3.0 * np.pi * radius**3))
    rod = inertia.parameters_of_body(mass, np.zeros(3), np.diag([1e-4, 0.04, 0.04]))
    assert inertia.least_density(rod) < inertia.least_density(ball)
