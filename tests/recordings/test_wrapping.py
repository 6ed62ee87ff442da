"""Encoders that wrap at a whole turn."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from lagnet.recordings.loading.load import load_recording

TIME = 0.01 * np.arange(600)
ROLL = SimpleNamespace(
    joints=("roll",),
    n_dof=1,
    position_lower=np.array([-np.inf]),
    position_upper=np.array([np.inf]),
    joint_types=("continuous",),
)


def wrapped(q: np.ndarray) -> np.ndarray:
    return (q + np.pi) % (2 * np.pi) - np.pi


def load(folder: Path, q: np.ndarray, robot: object = ROLL, **more: np.ndarray):
    np.savez(folder / "run.npz", time=TIME, q=q, tau=np.sin(q), **more)
    return load_recording(folder / "run.npz", robot=robot)


@pytest.mark.parametrize("speed", [2.0, -2.0, 0.7])
def test_jumps_of_a_turn_are_taken_out_and_told(speed: float, tmp_path: Path) -> None:
    q = speed * TIME + 0.3 * np.sin(5 * TIME)
    found = load(tmp_path, wrapped(q))
    np.testing.assert_allclose(found.q[:, 0], q, atol=1e-12)
    assert "q_0 (roll) jumps by a whole turn" in found.warnings[0]
    assert "first at row " in found.warnings[0]


def test_each_motion_starts_on_the_scale_of_its_file(tmp_path: Path) -> None:
    q = wrapped(2.0 * TIME)
    found = load(tmp_path, q, trajectory=np.repeat([0, 1, 2], 200))
    for part in found.parts():
        assert part.q[0, 0] in q
        assert np.abs(np.diff(part.q[:, 0])).max() < 0.1


def test_what_is_no_wrap_stays(tmp_path: Path) -> None:
    smooth = np.sin(TIME)
    glitch = smooth.copy()
    glitch[100] += 4.0
    wild = np.random.default_rng(0).uniform(-6, 6, TIME.size)
    rail = SimpleNamespace(**{**vars(ROLL), "joint_types": ("prismatic",)})
    jumping_rail = np.where(TIME > 3, 2 * np.pi, 0.0)
    for q, robot in ((smooth, ROLL), (glitch, ROLL), (wild, ROLL), (jumping_rail, rail)):
        found = load(tmp_path, q, robot)
        np.testing.assert_array_equal(found.q[:, 0], q)
        assert found.warnings == ()
