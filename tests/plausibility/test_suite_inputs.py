"""What the suite accepts, refuses and tells."""

from __future__ import annotations

import json

import numpy as np
import pytest

from lagnet.errors import LagnetError, ModelError
from lagnet.plausibility.settings import CheckSettings
from lagnet.plausibility.suite import check
from lagnet.plausibility.torque_function import TorqueFunction
from lagnet.rigid_body.random_arm import random_arm

LIGHT = CheckSettings(samples=32, starts=1, iterations=2)


def test_plain_function_is_checked():
    arm = random_arm(2, 3, ("revolute",))
    report = check(TorqueFunction(arm.inverse_dynamics, arm.joints), settings=LIGHT)
    assert report.passed, report.headline()


def test_friction_in_a_plain_function_is_found_in_its_coriolis_torque():
    arm = random_arm(2, 3, ("revolute",))
    model = TorqueFunction(lambda q, v, a: arm.inverse_dynamics(q, v, a) + 0.1 * v, arm.joints)
    assert "coriolis_quadratic" in [c.name for c in check(model, settings=LIGHT).failures]


def test_missing_calls_are_named():
    with pytest.raises(ModelError, match="mass_matrix, coriolis_torque, gravity_torque, joints, n_dof"):
        check(type("Bare", (), {"inverse_dynamics": lambda self, q, v, a: q})())


def test_wrong_shape_is_told_with_the_expected_one():
    model = TorqueFunction(lambda q, v, a: q[:, :1], ("one", "two"))
    with pytest.raises(ModelError, match="shape"):
        check(model, settings=LIGHT)


def test_failing_call_is_told_with_its_error():
    def torque(q, v, a):
        raise ValueError("no weights")

    with pytest.raises(ModelError, match="no weights"):
        check(TorqueFunction(torque, ("one",)), settings=LIGHT)


def test_other_number_of_joints_in_the_reference_is_refused():
    with pytest.raises(ModelError, match="the reference has 3 joints, the model 2"):
        check(random_arm(2, 0), random_arm(3, 0))


def test_unknown_check_is_refused_with_a_hint():
    with pytest.raises(LagnetError, match="did you mean gravity_is_gradient"):
        check(random_arm(1, 0), settings=CheckSettings(skip=("gravity_is_gradiant",)))


def test_own_limit_counts():
    model = TorqueFunction(lambda q, v, a: a + 0.1 * v, ("one",))
    wide = CheckSettings(samples=32, starts=1, iterations=2, limits={"coriolis_quadratic": 10.0})
    assert check(model, settings=LIGHT)["coriolis_quadratic"].status == "fail"
    assert check(model, settings=wide)["coriolis_quadratic"].status == "pass"
    assert check(model, settings=wide)["coriolis_quadratic"].limit == 10.0


def test_skipped_check_is_left_out():
    report = check(random_arm(1, 0), settings=CheckSettings(samples=32, starts=1, skip=("bounded_growth",)))
    assert "bounded_growth" not in [c.name for c in report.checks]


def test_single_precision_model_gets_its_own_rounding():
    arm = random_arm(2, 3, ("revolute",))

    def single(call):
        return lambda *x: call(*x).astype(np.float32).astype(float)

    model = TorqueFunction(single(arm.inverse_dynamics), arm.joints)
    names = ["mass_matrix_symmetric", "coriolis_quadratic", "gravity_is_gradient", "coriolis_from_mass_matrix"]
    report = check(model, settings=LIGHT)
    assert [n for n in names if report[n].status == "fail"] == []
    assert report["mass_matrix_symmetric"].limit > 1e-6


def test_not_finite_is_told_where_other_checks_stumble_on_it():
    arm = random_arm(2, 3, ("revolute",))

    def torque(q, v, a):
        tau = arm.inverse_dynamics(q, v, a)
        return np.where(np.all(q == arm.position_upper, axis=1, keepdims=True), np.nan, tau)

    report = check(TorqueFunction(torque, arm.joints), settings=LIGHT)
    assert report["finite_output"].status == "pass" or report["finite_output"].where["call"]
    assert all(c.value is None or np.isfinite(c.value) for c in report.checks)
    json.loads(report.to_json())


def test_json_has_the_promised_fields(tmp_path):
    report = check(random_arm(2, 0), settings=LIGHT)
    written = json.loads(report.write(tmp_path / "plausibility.json").read_text())
    assert len(written) == len(report.checks)
    for entry in written:
        assert {"name", "status", "value", "limit", "unit", "where", "meaning"} <= set(entry)
        assert entry["status"] in ("pass", "fail", "not_applicable")
    assert not list(tmp_path.glob("*.partial"))


def test_headline_says_what_and_where():
    arm = random_arm(2, 3, ("revolute",))
    model = TorqueFunction(lambda q, v, a: arm.inverse_dynamics(q, v, a) + 0.1 * v, arm.joints)
    line = check(model, settings=LIGHT).headline()
    assert line.startswith("FAIL coriolis_quadratic:")
    assert "at q = [" in line
