"""Odds from the scatter between blocks: signs, bounds, and what one block alone can say."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import norm
from tests.tolerances import IDENTITY

from lagnet.diagnosis.identifiability.block_odds import GREATEST, held_out_errors, log10_odds
from lagnet.diagnosis.regression.cross_validation import RIDGE
from lagnet.diagnosis.regression.normal_equations import ridge_solve

BLOCKS, FOLDS = 60, 6


@pytest.fixture
def errors() -> np.ndarray:
    return np.random.default_rng(0).chisquare(20, (2, 1, BLOCKS))


def test_the_other_way_round_the_odds_are_the_inverse(errors) -> None:
    here, there = errors
    told = log10_odds([500.0], here, 1.3 * there, [0.0])
    assert told > 0.0
    assert log10_odds([500.0], 1.3 * there, here, [0.0]) == pytest.approx(-told, rel=IDENTITY)


def test_few_pieces_of_evidence_are_not_surer_for_agreeing_blocks(errors) -> None:
    here, there = errors[0], 2.0 * errors[0]
    assert log10_odds([10.0], here, there, [0.0]) == pytest.approx(5.0 * np.log10(2.0))
    assert log10_odds([1e9], here, there, [0.0]) == GREATEST


def test_one_block_alone_decides_nothing(errors) -> None:
    here, there = errors[0], errors[0].copy()
    there[0, 7] += 100.0 * there.mean()
    assert abs(log10_odds([1e6], here, there, [0.0])) < 1.3


def test_many_times_larger_errors_outweigh_a_rival_that_is_simpler_in_three_blocks() -> None:
    here, there = np.array([[1.0, 1.2, 0.9]]), np.array([[90.0, 310.0, 180.0]])
    alone = log10_odds([80.0], here, there, [0.0])
    assert 0.5 < alone < 4.0  # three blocks are sure of no more, whatever they say
    assert 0.5 < log10_odds([80.0], here, there, [0.0], -9.0) < alone
    assert log10_odds([80.0], here, there, [0.0], 9.0) == pytest.approx(alone + 9.0 / np.log(10.0))


@pytest.mark.parametrize("simpler", [-30.0, -2.0, -0.1, 0.0, 0.1, 2.0, 30.0])
def test_odds_of_the_rival_are_the_inverse_whichever_is_simpler(errors, simpler) -> None:
    here, there = errors
    told = log10_odds([500.0], here, 1.1 * there, [0.0], simpler)
    assert log10_odds([500.0], 1.1 * there, here, [0.0], -simpler) == pytest.approx(-told, rel=IDENTITY)


def test_a_penalty_that_blocks_do_not_make_good_decides() -> None:
    here, there = np.full((1, BLOCKS), 1.0), np.full((1, BLOCKS), 1.02)
    gain = 50.0 * np.log(1.02)
    assert log10_odds([100.0], here, there, [0.0], -3.0) == pytest.approx((gain - 3.0) / np.log(10.0))


def test_where_blocks_tell_nothing_the_simpler_one_is_preferred_by_its_penalty(errors) -> None:
    here = errors[0]
    assert log10_odds([500.0], here, here, [0.0], 2.0) == pytest.approx(2.0 / np.log(10.0))
    assert log10_odds([500.0], here[:, :1], here[:, :1], [0.0], 2.0) == pytest.approx(2.0 / np.log(10.0))


def test_scattering_blocks_give_the_odds_of_their_mean_over_its_error() -> None:
    rng = np.random.default_rng(3)
    z = np.array([_z_and_odds(rng) for _ in range(50)])
    normal = (norm.logcdf(z[:, 0]) - norm.logsf(z[:, 0])) / np.log(10.0)
    np.testing.assert_allclose(z[:, 1], normal, atol=0.35)  # Student's tails are wider than the normal ones


def _z_and_odds(rng: np.random.Generator) -> tuple[float, float]:
    here, there = (100.0 + rng.normal(0.0, 1.0, (1, 400)) for _ in range(2))
    there = there + 0.1
    difference = there - here
    z = difference.mean() / (difference.std(ddof=1) / np.sqrt(difference.size))
    return float(z), log10_odds([1e9], here, there, [0.0])


def test_held_out_errors_are_those_of_a_fit_without_the_fold() -> None:
    rng = np.random.default_rng(1)
    rows = rng.normal(size=(BLOCKS, 30, 4))
    blocks = np.einsum("bni,bnj->bij", rows, rows)
    folds = np.stack([blocks[f::FOLDS].sum(axis=0) for f in range(FOLDS)])
    columns = np.array([2, 0])
    rest = folds.sum(axis=0) - folds[3]
    theta = ridge_solve(rest[np.ix_(columns, columns)], rest[columns, -1], RIDGE)
    left = rows[3][:, -1] - rows[3][:, columns] @ theta
    assert held_out_errors(blocks, folds, columns)[3] == pytest.approx(left @ left, rel=1e3 * IDENTITY)
    assert held_out_errors(blocks, folds, columns[:0])[3] == pytest.approx(blocks[3, -1, -1], rel=IDENTITY)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_rival_that_a_fold_leaves_undetermined_has_the_greatest_odds_against_it(sign) -> None:
    sound, lost = np.full((1, BLOCKS), 2.0), np.full((1, BLOCKS), 2.0)
    lost[0, 1] = np.inf
    pair = (sound, lost) if sign > 0 else (lost, sound)
    with np.errstate(all="raise"):
        assert log10_odds([10.0], *pair, [0.0]) == sign * GREATEST
