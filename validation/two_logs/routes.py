"""The two routes of `lagnet diagnose`: `--robot ur5`, and `--simulated` with the simulator's recordings."""

from __future__ import annotations

import json
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jax
import numpy as np

import lagnet
from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.nominal.from_recordings import learn_nominal
from lagnet.models.files.loading import load_any
from validation.plants.catalogue.plan import Plan
from validation.plants.catalogue.simulate import simulate


@dataclass(frozen=True, eq=False)
class Route:
    """A nominal model and how it came about.

    Args:
        name: "urdf" or "simulated".
        model: what recordings are held against.
        missed: shape (dof,), torque that the model is known to miss [N m]; None for the URDF.
        told: what there is to say of the model.
    """

    name: str
    model: Any
    missed: np.ndarray | None
    told: dict[str, Any]

    def verdict(self, plan: Plan, folder: Path) -> dict:
        """What `lagnet diagnose` writes of a plant's recordings, with joints by the names that the plant gives them."""
        read = [lagnet.load_recording(str(folder / f"{name}.csv"), robot=self.model) for name in plan.recordings]
        began = time.process_time()
        verdict = diagnose(read[:-1], self.model, read[-1:], nominal_error=self.missed).verdict.to_dict()
        names = dict(zip(verdict["nominal"]["joints"], lagnet.load_robot(plan.robot).joints, strict=True))
        for entry in (*verdict["effects"], *verdict["unexplained"]):
            entry["joint"] = names.get(entry["joint"])
        return verdict | {"processor_seconds": time.process_time() - began}


def by_urdf(robot: str) -> Route:
    """The route with the robot's file."""
    return Route("urdf", lagnet.load_robot(robot), None, {"kind": "urdf"})


def by_simulated(plan: Plan, folder: Path, seed: int = 0) -> Route:
    """The route without: as the command learns it, once, since all plants have the same simulator; kept in a folder."""
    notes = folder / "told.json"
    if not notes.exists():
        with tempfile.TemporaryDirectory() as logs:
            simulate(plan, Path(logs))
            read = [lagnet.load_recording(str(Path(logs) / f"{name}.csv")) for name in plan.recordings]
        began = time.process_time()
        learned = learn_nominal(read, seed=seed)
        learned.model.save(folder / "model")
        told = {
            "kind": learned.kind,
            "held_out_share_of_torque_variance": learned.share.tolist(),
            "held_out_rms_error_nm": learned.error.tolist(),
            "processor_seconds": time.process_time() - began,
        }
        notes.write_text(json.dumps(told))
    told = json.loads(notes.read_text())
    return Route("simulated", load_any(str(folder / "model")), np.array(told["held_out_rms_error_nm"]), told)


def compile_once(folder: Path) -> None:
    """Keep compiled code on disk: every diagnosis would compile the functions of the learned arm anew."""
    jax.config.update("jax_compilation_cache_dir", str(folder))
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
