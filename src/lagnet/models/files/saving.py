"""Models on disk: `model.json` says what the model is, `weights.npz` holds its numbers; nothing is ever unpickled.

model.json    format, version, kind, settings, joints, features, scales, training, sha256 of weights.npz
weights.npz   one array a leaf of the model, by its path in the model
"""

from __future__ import annotations

import dataclasses
import hashlib
import io
import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from lagnet.errors import ModelError, RecordingError
from lagnet.files import read_bounded, write_whole
from lagnet.models.dynamics import AbstractDynamics
from lagnet.models.features import JOINT_TYPES, JointFeatures
from lagnet.models.kinds import ModelSpec, draw, settings_from
from lagnet.models.learned_model import LearnedModel
from lagnet.models.scales import Scales
from lagnet.recordings.readers.npz_file import NpzArchive

FORMAT, VERSION = "lagnet-model", 1
DESCRIPTION, WEIGHTS = "model.json", "weights.npz"
PREVIOUS = ".weights_previous.npz"  # of a folder whose writing was cut off between its two files
LARGEST_DESCRIPTION, LARGEST_WEIGHTS = 2**20, 2**28  # bytes; a model of this library takes well under a megabyte
LARGEST_ARM = 64  # joints
DAMAGED = "copy it again or train anew"


def save_model(model: LearnedModel, folder: str | Path) -> Path:
    """Write model.json and weights.npz; an old model stays readable until the new one is there.

    Returns:
        The folder.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    stream = io.BytesIO()
    np.savez(stream, allow_pickle=False, **_leaves(model.dynamics))
    weights = stream.getvalue()
    previous = folder / PREVIOUS
    if (folder / WEIGHTS).is_file() and (folder / DESCRIPTION).is_file():
        write_whole(previous, (folder / WEIGHTS).read_bytes())  # for the description that still stands there
    write_whole(folder / WEIGHTS, weights)
    text = json.dumps(_description(model, weights), indent=2, allow_nan=False)
    write_whole(folder / DESCRIPTION, text)
    previous.unlink(missing_ok=True)
    return folder


def load_model(folder: str | Path, n_dof: int | None = None) -> LearnedModel:
    """Read a model that `save` wrote.

    Args:
        folder: where model.json is.
        n_dof: number of joints that the caller needs; None for any.

    Raises:
        ModelError: no model there, damaged, from a newer format, or for another number of joints.
    """
    folder = Path(folder)
    said = _read_description(folder)
    where = str(folder / DESCRIPTION)
    try:
        spec = _spec(said)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise ModelError(f"is damaged ({error})", where=where, next_step=DAMAGED) from None
    if n_dof is not None and n_dof != len(spec.joints):
        raise ModelError(
            f"the model has {len(spec.joints)} joints, {n_dof} are needed",
            where=where,
            next_step="train one on recordings of this arm",
        )
    weights = _read_weights(folder / WEIGHTS, said.get("weights_sha256"))
    dynamics = _filled(spec, NpzArchive(weights, str(folder / WEIGHTS)), str(folder / WEIGHTS))
    checksum = hashlib.sha256(weights).hexdigest()
    return LearnedModel(spec, dynamics, said.get("training") or {}, source=str(folder), sha256=checksum)


def _description(model: LearnedModel, weights: bytes) -> dict[str, Any]:
    spec = model.spec
    return {
        "format": FORMAT,
        "version": VERSION,
        "kind": spec.kind,
        "settings": dataclasses.asdict(spec.settings),
        "joints": list(spec.joints),
        "features": dataclasses.asdict(spec.features),
        "scales": dataclasses.asdict(spec.scales),
        "training": model.training,
        "weights_sha256": hashlib.sha256(weights).hexdigest(),
    }


def _read_description(folder: Path) -> dict[str, Any]:
    path = folder / DESCRIPTION
    if not path.is_file():
        raise ModelError("holds no learned model", where=str(folder), next_step="give a folder written by lagnet train")
    if path.stat().st_size > LARGEST_DESCRIPTION:
        raise ModelError("is too large to be a model", where=str(path), next_step=DAMAGED)
    try:
        said = json.loads(read_bounded(path, LARGEST_DESCRIPTION).decode("utf-8"))
    except (ValueError, RecursionError):
        raise ModelError("is damaged (not JSON)", where=str(path), next_step=DAMAGED) from None
    if not isinstance(said, Mapping) or said.get("format") != FORMAT:
        raise ModelError("is not a learned model's description", where=str(path), next_step=DAMAGED)
    version = said.get("version")
    if not isinstance(version, int) or version < 1:
        raise ModelError("is damaged (no version)", where=str(path), next_step=DAMAGED)
    if version > VERSION:
        raise ModelError(
            f"is of format {version}, this lagnet reads up to {VERSION}", where=str(path), next_step="update lagnet"
        )
    return dict(said)


def _spec(said: Mapping[str, Any]) -> ModelSpec:
    joints = tuple(said["joints"])
    if not 1 <= len(joints) <= LARGEST_ARM or not all(isinstance(name, str) for name in joints):
        raise ValueError("joints")
    types = tuple(said["features"]["joint_types"])
    if len(types) != len(joints) or not set(types) <= set(JOINT_TYPES):
        raise ValueError("joint types")
    features = JointFeatures(types, *(_numbers(said["features"], name) for name in ("centre", "offset", "scale")))
    scales = Scales(*(_numbers(said["scales"], name) for name in ("velocity", "acceleration", "torque")))
    n_features = len(features.owner)
    lengths = [len(features.centre), len(scales.velocity), len(scales.acceleration), len(scales.torque)]
    if lengths != [len(joints)] * 4 or len(features.offset) != n_features or len(features.scale) != n_features:
        raise ValueError("lengths")
    if min(*features.scale, *scales.velocity, *scales.acceleration, *scales.torque) <= 0:
        raise ValueError("scales")
    return ModelSpec(said["kind"], settings_from(said["kind"], said["settings"]), joints, features, scales)


def _numbers(said: Mapping[str, Any], name: str) -> tuple[float, ...]:
    values = tuple(float(x) for x in said[name])
    if not all(math.isfinite(x) for x in values):
        raise ValueError(name)
    return values


def _read_weights(path: Path, promised: Any) -> bytes:
    if not path.is_file():
        raise ModelError("is missing", where=str(path), next_step=DAMAGED)
    if path.stat().st_size > LARGEST_WEIGHTS:
        raise ModelError("is too large to be a model", where=str(path), next_step=DAMAGED)
    data = path.read_bytes()
    previous = path.with_name(PREVIOUS)
    if hashlib.sha256(data).hexdigest() != promised and previous.is_file():
        data = previous.read_bytes() if previous.stat().st_size <= LARGEST_WEIGHTS else data
    if hashlib.sha256(data).hexdigest() != promised:
        raise ModelError(
            f"is damaged (its checksum is not the one in {DESCRIPTION})", where=str(path), next_step=DAMAGED
        )
    return data


def _filled(spec: ModelSpec, archive: NpzArchive, where: str) -> AbstractDynamics:
    """A model of the spec's shape with the archive's numbers; shapes are compared before anything is read."""
    shell = jax.eval_shape(lambda key: eqx.filter(draw(spec, key), eqx.is_array), jax.random.key(0))
    named, tree = jax.tree_util.tree_flatten_with_path(shell)
    wanted = {jax.tree_util.keystr(path): leaf.shape for path, leaf in named}
    if archive.shapes != wanted:
        raise ModelError(f"does not hold the arrays that {DESCRIPTION} promises", where=where, next_step=DAMAGED)
    try:
        arrays = [archive.array(name) for name in wanted]
    except RecordingError as error:
        raise ModelError(error.what, where=where, next_step=DAMAGED) from None
    if not all(x.dtype.kind == "f" and np.isfinite(x).all() for x in arrays):
        raise ModelError("holds values that are not finite numbers", where=where, next_step=DAMAGED)
    with jax.enable_x64(True):
        return tree.unflatten([jnp.asarray(x, jnp.float64) for x in arrays])


def _leaves(dynamics: AbstractDynamics) -> dict[str, np.ndarray]:
    named, _ = jax.tree_util.tree_flatten_with_path(dynamics)
    return {jax.tree_util.keystr(path): _shortest(np.asarray(leaf)) for path, leaf in named}


def _shortest(x: np.ndarray) -> np.ndarray:
    """In single precision where that loses nothing, as for weights trained in it."""
    single = x.astype(np.float32)
    return single if np.array_equal(single, x) else x
