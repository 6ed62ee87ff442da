"""A ripple is one only where it is known that it repeats."""

from __future__ import annotations

import pytest

from lagnet.effects.catalogue import CATALOGUE

LAW = CATALOGUE["torque_ripple"]


@pytest.mark.parametrize(
    ("order", "amplitude", "determined"),
    [
        ((11.9, 12.1), (0.2, 0.4), True),
        ((4.6, 6.8), (0.2, 0.4), False),  # a bump, or a kink: nothing that comes again
        ((11.9, 12.1), (-0.1, 0.4), False),
    ],
)
def test_a_ripple_needs_an_order_and_an_amplitude(order, amplitude, determined: bool) -> None:
    intervals = {"N": order, "amplitude": amplitude, "phase": (0.0, 0.5)}
    assert LAW.is_determined(intervals) == determined
