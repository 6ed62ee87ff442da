"""`lagnet train` as a user calls it: the folder it writes is a ROBOT for every other command."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from lagnet.cli.main import main
from lagnet.models.files.saving import load_model
from lagnet.recordings.recording import Recording
from lagnet.recordings.writing import write_recording

pytestmark = pytest.mark.slow

TURN, FRICTION = 2 * np.pi, 2.0


def _pendulum(folder: Path, friction: float) -> Path:
    """One joint under gravity: τ = 0.7 a + 3 sin q, and friction."""
    time = np.arange(3000) / 100
    phase = TURN * np.outer(time, [0.21, 0.53])
    q = (phase * [0.0, 0.0] + np.sin(phase) * [1.6, 0.7]).sum(axis=1, keepdims=True)
    rate = TURN * np.array([0.21, 0.53])
    v = (np.cos(phase) * rate * [1.6, 0.7]).sum(axis=1, keepdims=True)
    a = -(np.sin(phase) * rate**2 * [1.6, 0.7]).sum(axis=1, keepdims=True)
    noise = 1e-3 * np.random.default_rng(0).normal(size=q.shape)
    tau = 0.7 * a + 3.0 * np.sin(q) + friction * v + noise
    return write_recording(Recording(time, q, tau, ("swing",), v=v, a=a), folder / f"run_{friction:g}.csv")


@pytest.fixture(scope="module")
def trained(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("trained")
    run = _pendulum(folder, 0.0)
    assert main(["train", str(run), "--steps", "600", "--seed", "3", "--out", str(folder / "arm")]) == 0
    return folder / "arm"


def test_the_folder_holds_a_model_and_how_it_came_about(trained: Path):
    assert {f.name for f in trained.iterdir()} == {"model.json", "weights.npz"}
    said = json.loads((trained / "model.json").read_text())["training"]
    assert (said["seed"], said["steps"]) == (3, 600)
    assert load_model(trained).mass_matrix(np.zeros((1, 1)))[0, 0, 0] == pytest.approx(0.7, rel=0.05)


def test_the_model_can_be_taken_apart(trained: Path, tmp_path: Path):
    out = tmp_path / "parts"
    assert main(["decompose", str(trained), str(_pendulum(tmp_path, 0.0)), "--out", str(out)]) == 0
    assert (out / "report.html").is_file()


def test_the_model_is_checked_like_any_arm(trained: Path, capsys: pytest.CaptureFixture):
    main(["check", str(trained)])
    assert "energy" not in capsys.readouterr().out.splitlines()[0]


def test_physics_beyond_the_trained_model_is_named(trained: Path, tmp_path: Path):
    out = tmp_path / "diagnosis"
    assert main(["diagnose", str(_pendulum(tmp_path, FRICTION)), "--robot", str(trained), "--out", str(out)]) == 0
    effects = json.loads((out / "verdict.json").read_text())["effects"]
    viscous = next(e for e in effects if e["effect"] == "viscous_friction")
    assert next(p["value"] for p in viscous["parameters"] if p["name"] == "Fv") == pytest.approx(FRICTION, rel=0.05)


def test_an_unknown_kind_is_bad_input(tmp_path: Path, capsys: pytest.CaptureFixture):
    assert main(["train", str(_pendulum(tmp_path, 0.0)), "--model", "delaan", "--out", str(tmp_path / "x")]) == 2
    assert "did you mean delan" in capsys.readouterr().err
