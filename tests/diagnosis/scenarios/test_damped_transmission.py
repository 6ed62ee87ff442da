"""A flexible joint with a damper is named with both, and with no delay beside it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

from lagnet.diagnosis.diagnose import diagnose
from lagnet.recordings.recording import Recording

JOINT = 1
NEAR_K, NEAR_D = 0.02, 0.2  # relative


def seen_at_the_motor(link: Recording, stiffness: float, damping: float) -> Recording:
    """The recording of the motor's encoder, which leads the link by e with K e + D de/dt = τ."""
    load = CubicSpline(link.time, link.tau[:, JOINT])

    def winds(t, e):
        return (load(t) - stiffness * e) / damping

    start = [load(link.time[0]) / stiffness]
    wound = solve_ivp(
        winds, (link.time[0], link.time[-1]), start, t_eval=link.time, rtol=1e-9, atol=1e-12, max_step=0.01
    )
    q = link.q.copy()
    q[:, JOINT] += wound.y[0]
    noise = 2e-3 * np.std(link.tau, axis=0) * np.random.default_rng(len(link)).standard_normal(link.tau.shape)
    return Recording(link.time, q, link.tau + noise, link.joints)


@pytest.mark.parametrize("constant", [0.0008, 0.03])  # [s]
def test_spring_and_damper_are_told_apart(plant, arm, constant: float) -> None:
    real = plant()
    real = type(real)(arm, noise=0.0, encoder=0.0)
    links = [real.record(seed) for seed in (51, 52, 53)]
    stiffness = np.abs(links[0].tau[:, JOINT]).max() / 0.05
    seen = [seen_at_the_motor(link, stiffness, constant * stiffness) for link in links]
    result = diagnose(seen[:2], arm, seen[2:], seed=0)
    (told,) = result.effects
    assert (told.effect, told.joint) == ("joint_elasticity", arm.joints[JOINT])
    assert told.value("K") == pytest.approx(stiffness, rel=NEAR_K)
    if constant > 0.01:
        assert told.value("D") == pytest.approx(constant * stiffness, rel=NEAR_D)
        (interval,) = [p.ci95 for p in told.parameters if p.name == "D"]
        assert interval is not None
        assert interval[0] > 0.0
    else:
        assert told.value("D") <= 0.004 * stiffness
