"""Where no load sets the scale of torques, all that is a torque is told over kp, friction per load as well."""

from __future__ import annotations

import pytest

from lagnet.diagnosis.motion.wording import as_ratio
from lagnet.diagnosis.verdict.verdict import NamedParameter


@pytest.mark.parametrize(
    ("name", "unit", "law_parameter", "told", "as_unit"),
    [
        ("Fc", "N m", "coulomb", "Fc/kp", "rad"),
        ("K", "–", "load_driving", "K/kp", "rad/(N m)"),
        ("K_driven", "–", "load_driven", "K_driven/kp", "rad/(N m)"),
        ("K2", "1/(N m)", "load_squared", "K2/kp", "rad/(N m)²"),
    ],
)
def test_a_torque_is_told_over_the_gain(name, unit, law_parameter, told, as_unit):
    ratio = as_ratio(NamedParameter(name, 1.2, unit, (1.0, 1.6)), 10.0, law_parameter)
    assert (ratio.name, ratio.unit) == (told, as_unit)
    assert (ratio.value, *ratio.ci95) == pytest.approx((0.12, 0.1, 0.16))


@pytest.mark.parametrize(
    ("name", "unit", "law_parameter"),
    [("K", "–", "load_motor"), ("s", "–", "load_stribeck"), ("T", "s", "delay"), ("kp", "N m/rad", "kp")],
)
def test_what_is_no_torque_stays(name, unit, law_parameter):
    given = NamedParameter(name, 0.3, unit, (0.2, 0.4))
    assert as_ratio(given, 10.0, law_parameter) == given
