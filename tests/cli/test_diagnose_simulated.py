"""`lagnet diagnose --simulated`: a log of the simulator in the place of its model."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from lagnet.cli.main import main
from lagnet.rigid_body.random_arm import random_arm

pytestmark = pytest.mark.slow

RATE, SECONDS = 100.0, 20.0
FRICTION = 1.5  # [N m s/rad]


def write(path: Path, arm, seed: int, friction: float) -> Path:
    rng, n = np.random.default_rng(seed), arm.n_dof
    time = np.arange(round(SECONDS * RATE)) / RATE
    omega, phase = 2.0 * np.pi * 0.15 * np.arange(1, 5)[:, None], rng.uniform(0.0, 6.0, (4, n))
    size = rng.normal(0.0, 0.4, (4, n))
    angle = omega * time[:, None, None] + phase
    q, v, a = (size * np.sin(angle), size * omega * np.cos(angle), -size * omega**2 * np.sin(angle))
    q, v, a = q.sum(axis=1), v.sum(axis=1), a.sum(axis=1)
    tau = arm.inverse_dynamics(q, v, a)
    tau[:, 1] += friction * v[:, 1]
    tau += 1e-3 * np.std(tau, axis=0) * rng.standard_normal(tau.shape)
    header = ",".join(["time", *(f"{s}_{j}" for s in ("q", "v", "a", "tau") for j in range(n))])
    np.savetxt(path, np.column_stack([time, q, v, a, tau]), delimiter=",", header=header, comments="")
    return path


@pytest.fixture(scope="module")
def diagnosed(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("logs")
    arm = random_arm(2, seed=5, kinds=("revolute",), fixed=False)
    simulated = [write(folder / f"sim_{k}.csv", arm, k, 0.0) for k in range(3)]
    real = [write(folder / f"real_{k}.csv", arm, k, FRICTION) for k in (2, 7)]
    command = ["diagnose", str(real[0]), "--holdout", str(real[1]), "--out", str(folder / "out")]
    for path in simulated:
        command += ["--simulated", str(path)]
    assert main(command) == 0
    return folder / "out"


def test_physics_that_the_simulator_lacks_is_named_without_its_model(diagnosed: Path) -> None:
    verdict = json.loads((diagnosed / "verdict.json").read_text())
    assert verdict["nominal"]["kind"] == "learned"
    found = {(e["effect"], verdict["nominal"]["joints"].index(e["joint"])) for e in verdict["effects"]}
    assert found == {("viscous_friction", 1)}
    assert verdict["effects"][0]["parameters"][0]["value"] == pytest.approx(FRICTION, rel=0.05)


def test_logs_of_the_same_commands_are_laid_over_each_other(diagnosed: Path) -> None:
    page = (diagnosed / "report.html").read_text()
    assert "Real and simulated log, same commands" in page
    assert "real_2.csv" in page
    assert "sim_2.csv" in page
    assert "overlay-1" in page
