"""Many samples need no more memory than a few regressors at once."""

from __future__ import annotations

import tracemalloc

import numpy as np

from lagnet.rigid_body.robot import load_description

SAMPLES = 60_000


def test_chunks_keep_the_regressor_in_bounds():
    robot = load_description("ur5")
    q, v, a = np.random.default_rng(0).normal(size=(3, SAMPLES, 6))
    whole = SAMPLES * 6 * 60 * 8
    tracemalloc.start()
    gram, seen = np.zeros((60, 60)), 0
    for rows, regressor in robot.regressor_chunks(q, v, a, chunk=2048):
        flat = regressor.reshape(-1, 60)
        gram += flat.T @ flat
        seen += rows.stop - rows.start
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert seen == SAMPLES
    assert peak < whole / 10
    assert np.linalg.matrix_rank(gram, tol=1e-9 * gram.max()) <= 60
