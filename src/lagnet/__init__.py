"""Find the physics that a robot's simulation leaves out.

The rooms, each importing only from those before it:

    types, errors    names of arrays, the InverseDynamics protocol, errors that say what to do next
    recordings       what a robot did: files, conditioning, splits, data sets
    rigid_body       what the simulator believes: URDF, MJCF, Pinocchio, inertial parameters
    effects          the catalogue of left-out physics, one cause a file
    servos           from a command to joint torque: delay, gains, dead band, saturation, friction of gears
    rollout          forward motion with exact stick and slip, compiled
    models           differentiable dynamics in JAX; the corrected model that a diagnosis makes
    simulation       PyBullet, with effects injected whose truth is known
    training         learning the models from recordings
    decomposition    torque by its terms, against a reference
    plausibility     checks of any model; the pytest plugin
    diagnosis        mismatch, where it is, which physics explains it, how sure that is
    simulators       exporters, one simulator a file; replay in MuJoCo and PyBullet
    comparison       several parameter sets of one robot against recordings
    reports          self-contained pages
    tracking         many recordings, over robots and time; the only room that imports Dask
    cli              the command `lagnet`

Names below are imported when first used, so that `import lagnet` costs next to nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from lagnet._version import __version__

if TYPE_CHECKING:
    from lagnet.decomposition.decompose import decompose as decompose
    from lagnet.diagnosis.diagnose import Diagnosis as Diagnosis
    from lagnet.diagnosis.diagnose import diagnose as diagnose
    from lagnet.diagnosis.writing import write_diagnosis as write_diagnosis
    from lagnet.effects.catalogue import CATALOGUE as CATALOGUE
    from lagnet.errors import LagnetError as LagnetError
    from lagnet.experiment_design.suggest_motion import suggest_motion as suggest_motion
    from lagnet.models.corrected.model import CorrectedModel as CorrectedModel
    from lagnet.models.corrected.named_effects import NamedEffect as NamedEffect
    from lagnet.models.files.loading import load_any as load_model
    from lagnet.models.files.loading import load_any as load_robot
    from lagnet.plausibility.suite import check as check
    from lagnet.recordings.loading.load import load_recording as load_recording
    from lagnet.recordings.recording import Recording as Recording
    from lagnet.rigid_body.robot import Robot as Robot
    from lagnet.training.ensemble import train_ensemble as train_ensemble
    from lagnet.training.train import train as train

_PUBLIC = {
    "CATALOGUE": "lagnet.effects.catalogue:CATALOGUE",
    "CorrectedModel": "lagnet.models.corrected.model:CorrectedModel",
    "Diagnosis": "lagnet.diagnosis.diagnose:Diagnosis",
    "LagnetError": "lagnet.errors:LagnetError",
    "NamedEffect": "lagnet.models.corrected.named_effects:NamedEffect",
    "Recording": "lagnet.recordings.recording:Recording",
    "Robot": "lagnet.rigid_body.robot:Robot",
    "check": "lagnet.plausibility.suite:check",
    "decompose": "lagnet.decomposition.decompose:decompose",
    "diagnose": "lagnet.diagnosis.diagnose:diagnose",
    "load_model": "lagnet.models.files.loading:load_any",
    "load_recording": "lagnet.recordings.loading.load:load_recording",
    "load_robot": "lagnet.models.files.loading:load_any",
    "suggest_motion": "lagnet.experiment_design.suggest_motion:suggest_motion",
    "train": "lagnet.training.train:train",
    "train_ensemble": "lagnet.training.ensemble:train_ensemble",
    "write_diagnosis": "lagnet.diagnosis.writing:write_diagnosis",
}
__all__ = ["__version__", *_PUBLIC]  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    if name not in _PUBLIC:
        raise AttributeError(f"module 'lagnet' has no attribute {name!r}")
    module, attribute = _PUBLIC[name].split(":")
    value = getattr(import_module(module), attribute)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
