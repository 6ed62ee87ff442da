"""Saved models that are damaged, foreign, newer or for another arm are refused in one clear sentence."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lagnet.errors import ModelError
from lagnet.models.files.saving import load_model

KEPT = Path(__file__).parent / "fixtures" / "ur5_delan"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return Path(shutil.copytree(KEPT, tmp_path / "model"))


def change(folder: Path, **values: Any) -> None:
    said = json.loads((folder / "model.json").read_text())
    (folder / "model.json").write_text(json.dumps({**said, **values}))


def test_another_joint_count_is_refused():
    with pytest.raises(ModelError, match="6 joints, 7 are needed"):
        load_model(KEPT, n_dof=7)


def test_an_empty_folder_is_refused(tmp_path):
    with pytest.raises(ModelError, match="holds no learned model"):
        load_model(tmp_path)


def test_a_newer_format_is_refused(folder):
    change(folder, version=2)
    with pytest.raises(ModelError, match="update lagnet"):
        load_model(folder)


@pytest.mark.parametrize("text", ["", "{", "[1]", '{"format": "other"}', "[" * 100_000])
def test_a_description_that_is_none_is_refused(folder, text):
    (folder / "model.json").write_text(text)
    with pytest.raises(ModelError):
        load_model(folder)


@pytest.mark.parametrize(
    "values",
    [
        {"joints": []},
        {"joints": ["a"]},
        {"kind": "oracle"},
        {"settings": {"rank": 10**9}},
        {"settings": {"depth": 3}},
        {"settings": 4},
        {"scales": {}},
        {"features": None},
    ],
)
def test_a_description_with_impossible_values_is_refused(folder, values):
    change(folder, **values)
    with pytest.raises(ModelError):
        load_model(folder)


def test_a_flipped_byte_in_the_weights_is_noticed(folder):
    data = bytearray((folder / "weights.npz").read_bytes())
    data[len(data) // 2] ^= 1
    (folder / "weights.npz").write_bytes(bytes(data))
    with pytest.raises(ModelError, match="checksum"):
        load_model(folder)


def test_weights_of_another_shape_are_refused(folder):
    change(folder, settings={"rank": 5})
    with pytest.raises(ModelError, match="does not hold the arrays"):
        load_model(folder)


def test_pickled_objects_are_never_loaded(folder):
    import hashlib

    np.savez(folder / "weights.npz", evil=np.array([{"a": 1}], dtype=object))
    data = (folder / "weights.npz").read_bytes()
    change(folder, weights_sha256=hashlib.sha256(data).hexdigest())
    with pytest.raises(ModelError, match="does not hold the arrays"):
        load_model(folder)


def test_missing_weights_are_said(folder):
    (folder / "weights.npz").unlink()
    with pytest.raises(ModelError, match="is missing"):
        load_model(folder)
