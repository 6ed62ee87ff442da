"""Changes are found and dated, warmth is no wear, and a fleet in which nothing happens stays quiet."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.tracking.fleets import START, observations

from lagnet.tracking.statistics.analyse import analyse
from lagnet.tracking.statistics.change_points import column_of
from lagnet.tracking.statistics.covariates import KELVIN, fit_covariates
from lagnet.tracking.statistics.pooling import pool
from lagnet.tracking.statistics.series import series_of

N = 12
NOISE = 0.01  # relative scatter of a parameter, as its intervals say


def fleet(
    rng: np.random.Generator, robots: int = 8, warm: tuple[int, ...] = (0, 1, 2), thermometer: float = 0.0
) -> dict[str, tuple]:
    """Values and temperatures told of robots whose friction falls by about 2 % a kelvin; some warm up by 10 K."""
    out = {}
    for r in range(robots):
        temperature = 25.0 + rng.normal(0.0, 0.7, N) + (10.0 * np.linspace(0.0, 1.0, N) if r in warm else 0.0)
        slope = -0.02 * rng.lognormal(0.0, 0.2)
        level = rng.lognormal(0.0, 0.07)
        values = level * np.exp(slope * (temperature - 25.0) + NOISE * rng.standard_normal(N))
        out[f"arm_{r}"] = (values, temperature + thermometer * rng.standard_normal(N))
    return out


def flat(robots: dict[str, tuple]) -> list:
    return [o for name, (values, warm) in robots.items() for o in observations(name, values, warm, half=1.96 * NOISE)]


def test_step_and_drift_are_told_apart_and_dated():
    robots = fleet(np.random.default_rng(0))
    robots["arm_5"][0][7:] *= 1.2
    robots["arm_6"][0][:] *= 1.0 + 0.3 * np.linspace(0.0, 1.0, N)
    found = {e.robot: e for e in analyse(flat(robots)).events}
    assert set(found) == {"arm_5", "arm_6"}
    step, drift = found["arm_5"], found["arm_6"]
    assert (step.kind, (step.date - START).days) == ("step", 49)
    assert step.lower < 0.2 < step.upper
    assert drift.kind == "drift"
    assert (drift.date - START).days <= 14
    assert drift.lower < 0.3 < drift.upper


def test_warmth_is_no_wear():
    told = [analyse(flat(fleet(np.random.default_rng(seed)))).events for seed in range(12)]
    assert sum(map(len, told)) <= 1  # a rate of 1 % over twelve fleets: two would have a chance below 1 %


def test_slopes_are_not_flattened_by_errors_of_the_thermometer():
    """Steady robots alone: temperatures vary by 0.7 K, the thermometer errs by 0.5 K."""
    slopes = []
    for seed in range(20):
        robots = fleet(np.random.default_rng(seed), robots=16, warm=(), thermometer=0.5)
        (group,) = series_of(flat(robots)).values()
        slopes.append(fit_covariates(group, thermometer=0.5).slopes[0] / KELVIN)
    error = np.std(slopes) / np.sqrt(len(slopes))
    assert np.mean(slopes) == pytest.approx(-0.02 * np.exp(0.02), abs=4 * error)  # e^(0.2²/2): mean of the lognormal
    assert error < 0.0015


def test_warmth_told_by_a_poor_thermometer_is_no_wear():
    told = [analyse(flat(fleet(np.random.default_rng(seed), robots=16, thermometer=0.5))).events for seed in range(20)]
    assert sum(map(len, told)) <= 1


def test_without_temperature_a_change_says_so():
    values = np.where(np.arange(N) < 6, 1.0, 1.3) * (1.0 + 0.005 * np.random.default_rng(0).standard_normal(N))
    rows = [o.__class__(**{**vars(o), "temperature": None}) for o in observations("arm_0", values)]
    (event,) = analyse(rows).events
    assert not event.temperature_known
    assert event.kind == "step"


def test_wear_of_a_warming_robot_is_judged_by_the_slopes_of_its_sisters():
    robots = fleet(np.random.default_rng(3), robots=16, warm=tuple(range(8)))
    robots["arm_0"][0][:] *= np.exp(0.35 * np.linspace(0.0, 1.0, N))
    assert {e.robot for e in analyse(flat(robots)).events} == {"arm_0"}


def test_one_bad_recording_is_an_outlier_and_no_change():
    robots = fleet(np.random.default_rng(1))
    robots["arm_4"][0][6] *= 1.3
    result = analyse(flat(robots))
    assert result.events == ()
    assert [a.observation.recording for a in result.adjusted if a.outlier] == ["arm_4/6"]


def test_two_changes_of_one_parameter():
    robots = fleet(np.random.default_rng(2))
    robots["arm_4"][0][4:8] *= 1.25
    events = analyse(flat(robots)).events
    assert [(e.robot, (e.date - START).days) for e in events] == [("arm_4", 28), ("arm_4", 56)]
    assert events[0].change > 0 > events[1].change


def test_odd_robot_stands_apart_and_levels_are_drawn_together():
    robots = fleet(np.random.default_rng(5), robots=12)
    robots["arm_7"][0][:] *= 1.6
    standings = analyse(flat(robots)).standings
    assert [s.robot for s in standings if s.out_of_family] == ["arm_7"]
    mean = standings[0].family
    assert all(abs(s.pooled - mean) <= abs(s.value - mean) + 1e-12 for s in standings)


def test_family_agrees_with_the_normal_hierarchy():
    """Seeds of one family: μ and τ come out as drawn, within their standard errors."""
    rng = np.random.default_rng(0)
    truth = rng.normal(3.0, 0.5, 400)
    sigma = rng.uniform(0.1, 0.6, 400)
    family = pool(truth + sigma * rng.standard_normal(400), sigma, 0.01)
    assert family.mean == pytest.approx(3.0, abs=4 * 0.65 / 20)
    assert family.spread == pytest.approx(0.5, abs=0.1)
    assert np.mean((family.pooled - truth) ** 2) < 0.8 * np.mean(sigma**2)


def test_too_few_sisters_make_no_family():
    standings = analyse(flat(fleet(np.random.default_rng(0), robots=3))).standings
    assert all(s.family is None and not s.out_of_family for s in standings)


def test_scale_is_logarithmic_only_where_physics_keeps_a_parameter_positive():
    share = observations("arm_0", np.linspace(0.5, 1.0, N), parameter=("payload", "share", None))
    friction = observations("arm_0", np.linspace(0.5, 1.0, N))
    scales = {g[2]: s[0].logarithmic for g, s in series_of([*share, *friction]).items()}
    assert scales == {"payload": False, "coulomb_friction": True}


def test_an_interval_of_rounding_alone_has_no_weight():
    told = observations("arm_0", np.linspace(0.5, 1.0, N))
    unseen = [replace(o, lower=o.value, upper=np.nextafter(o.value, 2.0)) for o in told[: N // 2]]
    ((series,),) = series_of([*unseen, *told[N // 2 :]]).values()
    assert series.days.size == N - N // 2


def test_a_drift_ends_at_its_size():
    days = np.array([0.0, 1.0, 2.0, 4.0])
    assert column_of("drift", 1, days) == pytest.approx([0.0, 0.0, 1 / 3, 1.0])
    assert column_of("step", 2, days) == pytest.approx([0.0, 0.0, 1.0, 1.0])


@pytest.mark.parametrize("n", [1, 2, 3])
def test_short_series_do_no_harm(n):
    assert analyse(observations("arm_0", np.ones(n))).events == ()
    assert analyse([]).events == ()
