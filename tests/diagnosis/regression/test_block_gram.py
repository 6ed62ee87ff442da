"""Gram matrices of blocks are collected of those joints alone that need them."""

from __future__ import annotations

import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.regression.block_gram import block_length, collect_block_grams


def test_matrices_of_joints_that_are_known_are_not_collected_anew(plant, arm) -> None:
    real = plant()
    posed = pose(arm, real.record(1), real.record(2))
    whole = posed.equations.grams.joints
    again = collect_block_grams(posed.problem, posed.library, posed.problem.fit, {0: whole[0], 2: whole[2]})
    assert again.joints[0] is whole[0]
    assert again.joints[2] is whole[2]
    assert len(again.joints) == len(whole)
    for known, made in zip(whole, again.joints, strict=True):
        assert made == pytest.approx(known, rel=1e-12)


@pytest.mark.parametrize(
    ("seconds", "periods"),
    [(60.0, 12.0), (14.4, 12.0), (9.6, 8.0), (4.8, 4.0), (1.2, 4.0)],
    ids=["long", "just long enough", "short", "shorter", "shortest"],
)
def test_blocks_are_shorter_where_they_would_be_too_few(seconds, periods) -> None:
    rate, bandwidth = 100.0, 5.0
    assert block_length(round(seconds * rate), rate, bandwidth) == periods * rate / bandwidth
