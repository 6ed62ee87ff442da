"""Torque and friction that change over the range of a joint: a layer has them where they predict unseen motion."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.conftest import Plant
from tests.diagnosis.identified.test_identify import MUCH_LESS, along, corrected, usual_load

from lagnet.diagnosis.identified.borne_out import is_borne_out
from lagnet.diagnosis.identified.fit import identify
from lagnet.diagnosis.identified.verdict_entry import identified_as_json
from lagnet.diagnosis.problem.problem import pose_problem
from lagnet.models.corrected.motion_terms import OVER_POSITION, wave
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.recordings.conditioning.condition import condition
from lagnet.rigid_body.random_arm import random_arm

JOINT = 1
FITTED = (1, 3, 4, 5)


def at_joint(values: np.ndarray, dof: int) -> np.ndarray:
    return np.outer(values, np.arange(dof) == JOINT)


def slack_spring(arm):
    """A spring that goes slack: no sine of an angle, and no line."""
    size = usual_load(arm)[JOINT]
    return lambda q, v, a, load: at_joint(0.4 * size * np.maximum(q[:, JOINT] - 0.1, 0.0), arm.n_dof)


def worn(arm):
    """Viscous friction five times as large at one end of the range as at the other."""
    size = usual_load(arm)[JOINT]
    return lambda q, v, a, load: at_joint(0.2 * size * v[:, JOINT] * np.exp(np.sin(1.5 * q[:, JOINT])), arm.n_dof)


def posed_on_several(arm, law):
    plant = Plant(arm, [law])
    fit = condition([plant.record(seed) for seed in FITTED])
    return pose_problem(arm, fit, condition([plant.record(2)], fit.bandwidth))


def errors_in_range(problem, model) -> tuple[float, float]:
    """Mean squared held-out error at the joint before and after, where the fitted motion has been."""
    q = np.concatenate([p.q[p.keep, JOINT] for p in problem.fit])
    before, after = [], []
    for p in problem.holdout:
        inside = (p.q[p.keep, JOINT] > q.min()) & (p.q[p.keep, JOINT] < q.max())
        before.append(problem.reduce(p, p.tau - p.load)[inside, JOINT])
        after.append(problem.reduce(p, p.tau - along(model)(p))[inside, JOINT])
    return tuple(float(np.mean(np.concatenate(x) ** 2)) for x in (before, after))


@pytest.mark.parametrize(("law", "friction"), [(slack_spring, False), (worn, True)])
def test_what_changes_over_the_range_is_corrected_and_told(law, friction) -> None:
    arm = random_arm(3, seed=5, kinds=("revolute",))
    problem = posed_on_several(arm, law(arm))
    found = identify(problem, ())
    waves = {
        t.joint for t, w in zip(found.layer.terms, found.layer.weights, strict=True) if w and t.kind in OVER_POSITION
    }
    assert waves == {JOINT}
    before, after = errors_in_range(problem, corrected(problem, found))
    assert after < MUCH_LESS * before
    entry = identified_as_json(found, arm, arm.joints)
    words = "Friction changes over the range of" if friction else "A torque that depends on position acts at"
    assert f"{words} {arm.joints[JOINT]}." in entry["words"]
    curve = next(e for e in entry["joints"] if e["joint"] == arm.joints[JOINT])["curve_over_position"]
    assert np.ptp(curve["friction" if friction else "torque"]) > 0.3 * np.sqrt(before)


def test_friction_of_one_value_gets_no_wave() -> None:
    arm = random_arm(3, seed=5, kinds=("revolute",))
    size = usual_load(arm)
    problem = posed_on_several(arm, lambda q, v, a, load: 0.2 * size * (np.tanh(v / 0.01) + v))
    assert not [t for t in identify(problem, ()).layer.terms if t.kind in OVER_POSITION]


def test_no_mean_of_friction_that_changes_over_the_range_is_borne_out() -> None:
    arm = random_arm(3, seed=5, kinds=("revolute",))
    found = identify(posed_on_several(arm, worn(arm)), ())
    weights = {(t.kind, t.joint): float(w) for t, w in zip(found.layer.terms, found.layer.weights, strict=True)}
    assert not is_borne_out(found, NamedEffect("viscous_friction", JOINT, {"Fv": weights["viscous", JOINT]}))


def test_a_wave_is_constant_beyond_the_range_that_was_seen() -> None:
    ends, beyond = wave(3, np.array([-0.5, 1.5]), 0.5, 1.0), wave(3, np.array([-9.0, 7.0]), 0.5, 1.0)
    np.testing.assert_array_equal(ends, beyond)
