"""The axis of torque errors counts in percent, whatever their size, with room between its labels."""

from __future__ import annotations

import pytest

from lagnet.reports.figures.figure import Figure
from lagnet.reports.sections.fit import KINDS, MOST_TICKS, _figure


def axis_of(nominal: float, named: float) -> dict:
    row = {"joint": "elbow_joint", "nmse_nominal": nominal, "nmse_named": named, "nmse_noise_floor": 1e-9}
    figure = _figure([row], list(KINDS[:2]))
    assert isinstance(figure, Figure)
    return figure.layout["xaxis"]


@pytest.mark.parametrize("named", [0.3, 1e-3, 1e-5, 1e-9])
def test_ticks_are_percentages(named: float) -> None:
    axis = axis_of(1.2, named)
    assert 1 <= len(axis["tickvals"]) <= MOST_TICKS
    for value, text in zip(axis["tickvals"], axis["ticktext"], strict=True):
        assert float(text.removesuffix(" %")) == pytest.approx(100.0 * value)
        assert "e" not in text
