"""A few plain terms find on little data what a forest cannot learn from it, and nothing in noise."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.regression.plain_terms import sparse_share

NAMES = ("q_0", "q_1", "v_0", "v_1", "load_0", "history_0", "time")
LAWS = {
    "a spring": (lambda s: 2.0 * s["q_0"] - 0.3, {"q_0"}),
    "friction with another joint's speed": (lambda s: np.abs(s["v_1"]) * np.sign(s["v_0"]), {"v_0", "v_1"}),
    "friction with load": (lambda s: np.abs(s["load_0"]) * np.sign(s["v_1"]), {"v_1", "load_0"}),
    "drag": (lambda s: s["v_1"] ** 2 * np.sign(s["v_1"]), {"v_1"}),
}


def signals(seed: int, n: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-1.0, 1.0, (n, len(NAMES)))


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
@pytest.mark.parametrize("seed", [1, 2])
def test_a_simple_law_is_found_with_its_signals(law, seed: int) -> None:
    torque, expected = law
    seen, unseen = signals(seed, 300), signals(seed + 10, 200)
    rest, test = (torque(dict(zip(NAMES, table.T, strict=True))) for table in (seen, unseen))
    noise = 0.1 * np.random.default_rng(seed).standard_normal(300)
    share, found = sparse_share(NAMES, seen, rest + noise, unseen, test)
    assert share > 0.9
    assert expected <= set(found)


@pytest.mark.parametrize("seed", range(5))
def test_noise_holds_nothing(seed: int) -> None:
    noise = np.random.default_rng(seed).standard_normal(700)
    share, _ = sparse_share(NAMES, signals(seed, 500), noise[:500], signals(seed + 1, 200), noise[500:])
    assert share < 0.05


def test_samples_without_a_residual_are_no_matter() -> None:
    _, found = sparse_share(NAMES, signals(0, 60), np.zeros(60), signals(1, 40), np.zeros(40))
    assert found == ()
