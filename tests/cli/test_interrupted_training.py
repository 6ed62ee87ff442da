"""An interrupted training leaves a finished model in its folder as it is."""

from __future__ import annotations

import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from lagnet.cli.main import main
from lagnet.cli.train import holds_finished_model
from lagnet.recordings.recording import Recording
from lagnet.recordings.writing import write_recording

KEPT = Path(__file__).parents[1] / "models" / "fixtures" / "ur5_delan"


@pytest.fixture
def interrupted(monkeypatch) -> list:
    """Training that is interrupted at once; the folders that its model was saved to."""
    saved: list = []
    model = SimpleNamespace(save=saved.append, joints=("a",))
    result = SimpleNamespace(model=model, stats={"interrupted": True})
    monkeypatch.setattr("lagnet.training.train.train", lambda *_, **__: result)
    return saved


@pytest.fixture
def run(tmp_path) -> str:
    time = np.arange(40) / 100
    return str(write_recording(Recording(time, time[:, None], time[:, None], ("a",)), tmp_path / "run.csv"))


def test_a_finished_model_is_kept(interrupted, run, tmp_path, capsys) -> None:
    folder = Path(shutil.copytree(KEPT, tmp_path / "model"))
    assert holds_finished_model(folder)
    assert main(["train", run, "--out", str(folder)]) == 3
    assert not interrupted
    assert "was kept as it is" in capsys.readouterr().out


def test_without_one_the_best_so_far_is_kept(interrupted, run, tmp_path) -> None:
    folder = tmp_path / "new"
    assert not holds_finished_model(folder)
    assert main(["train", run, "--out", str(folder)]) == 3
    assert interrupted == [folder]


def test_a_model_whose_weights_were_just_replaced_is_still_read(tmp_path) -> None:
    """Killed between the two files of a model: the description that stands there finds the weights that it is of."""
    from lagnet.models.files.saving import PREVIOUS, load_model

    folder = Path(shutil.copytree(KEPT, tmp_path / "model"))
    shutil.copy(folder / "weights.npz", folder / PREVIOUS)
    (folder / "weights.npz").write_bytes(b"of the next model")
    assert load_model(folder).n_dof == 6
