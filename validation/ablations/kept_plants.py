"""Concealed plants that are simulated once and kept on disk, with truth and witness beside the recordings."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import lagnet
from lagnet.recordings.recording import Recording
from validation.plants.catalogue.draw_plan import draw_plan
from validation.plants.catalogue.plan import Plan, opened
from validation.plants.catalogue.simulate import simulate
from validation.plants.catalogue.witness import Witness, read_witness

TRUTH, WITNESS = "truth.json", "witness.json"


@dataclass(frozen=True)
class KeptPlant:
    """One plant on disk.

    Args:
        plan, witness: what is hidden, and what the recordings can show of it.
        folder: where the recordings are.
    """

    plan: Plan
    witness: Witness
    folder: Path

    def read(self) -> tuple[object, list[Recording]]:
        """The nominal robot and the recordings, the held-out one last."""
        robot = lagnet.load_robot(self.plan.robot)
        files = [str(self.folder / f"{name}.csv") for name in self.plan.recordings]
        return robot, [lagnet.load_recording(file, robot=robot) for file in files]


Disturbed = Callable[[Plan, Path, Witness], Witness]
"""Changes the recordings of a plant in a folder, and gives back what they show of each cause then."""


def keep(seed: int, number: int, home: Path, disturbed: Disturbed | None = None) -> KeptPlant:
    """The plant of that seed and number: read if it lies in `home`, else simulated (and disturbed) into it.

    Raises:
        RuntimeError: the plant's closed loop was lost.
    """
    folder = home / f"seed_{seed}" / f"plant_{number:04d}"
    if not folder.exists():
        folder.parent.mkdir(parents=True, exist_ok=True)
        plan = draw_plan(seed, number)
        with tempfile.TemporaryDirectory(dir=folder.parent) as unfinished:
            fresh = Path(unfinished) / "plant"
            witness, _ = simulate(plan, fresh)
            witness = witness if disturbed is None else disturbed(plan, fresh, witness)
            (fresh / TRUTH).write_bytes(plan.sealed())
            (fresh / WITNESS).write_bytes(witness.to_json())
            fresh.rename(folder)
    return opened_plant(folder)


def opened_plant(folder: Path) -> KeptPlant:
    """A plant that lies in a folder."""
    plan = opened((folder / TRUTH).read_bytes())
    return KeptPlant(plan, read_witness((folder / WITNESS).read_bytes()), folder)
