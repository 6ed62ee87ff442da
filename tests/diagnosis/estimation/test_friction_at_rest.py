"""The share of dry friction that joints keep at rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.diagnosis.stop_and_go import COULOMB, SHARE, stop_and_go

from lagnet.diagnosis.estimation.friction_at_rest import friction_at_rest


@pytest.mark.parametrize("known", [None, np.array([0.3]), np.array([1.0])])
def test_the_share_is_found_whatever_was_taken_for_it_before(known) -> None:
    np.testing.assert_allclose(friction_at_rest(replace(stop_and_go(), held=known), [COULOMB]), SHARE, atol=0.05)


def test_nothing_is_said_to_stay_where_no_friction_has_a_name() -> None:
    np.testing.assert_array_equal(friction_at_rest(stop_and_go(), ()), 0.0)
