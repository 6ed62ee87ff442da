"""White noise on the torque of a concealed plant: its size, that it alone changes, and what it leaves to be seen."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from validation.noisy_torque.plants import LEAST, MOST, WhiteNoise
from validation.plants.catalogue.witness import Sight, Witness
from validation.plants.simulate import write_csv

N, DOF, OWN = 4000, 3, 0.01
NAMES = ("fit_0", "holdout")


@pytest.fixture
def recorded(tmp_path):
    """Torques of two recordings, as written."""
    time = np.arange(N) / 100.0
    q = np.sin(np.outer(time, [0.7, 1.1, 1.9]))
    taus = [5.0 + 3.0 * q, 5.0 - 2.0 * q]
    for name, tau in zip(NAMES, taus, strict=True):
        write_csv(tmp_path / f"{name}.csv", {"time": time, "q": q, "tau": tau})
    return tmp_path, taus


def plan(seed: int) -> Any:
    return SimpleNamespace(recordings=NAMES, seed=seed, noise=OWN)


def read(path) -> np.ndarray:
    return np.loadtxt(path, delimiter=",", skiprows=1)


def test_its_size_is_a_share_of_the_variation_of_each_joint(recorded) -> None:
    folder, taus = recorded
    WhiteNoise()(plan(3), folder, Witness(()))
    for name, tau in zip(NAMES, taus, strict=True):
        table = read(folder / f"{name}.csv")
        noise = table[:, 1 + DOF :] - tau
        assert noise.std(axis=0) == pytest.approx(WhiteNoise.share(plan(3)) * tau.std(axis=0), rel=0.05)
        assert np.abs(np.corrcoef(noise.T) - np.eye(DOF)).max() < 0.1
        assert table[:, 1 : 1 + DOF] == pytest.approx(np.sin(np.outer(table[:, 0], [0.7, 1.1, 1.9])), abs=1e-8)


def test_a_plant_has_its_own_size_and_the_same_again(recorded) -> None:
    shares = [WhiteNoise.share(plan(seed)) for seed in range(200)]
    assert LEAST <= min(shares) < 1.2 * LEAST
    assert MOST / 1.2 < max(shares) <= MOST
    assert shares == [WhiteNoise.share(plan(seed)) for seed in range(200)]


def test_a_cause_is_seen_beside_all_noise(recorded) -> None:
    folder, taus = recorded
    seen = WhiteNoise()(plan(3), folder, Witness((Sight(0.1, 10.0, (), ()),)))
    more = WhiteNoise.share(plan(3)) * np.max(taus[0].std(axis=0) / np.sqrt(np.mean(taus[0] ** 2, axis=0)))
    assert seen.sights[0].over_noise == pytest.approx(10.0 * OWN / np.hypot(OWN, more), rel=1e-6)
