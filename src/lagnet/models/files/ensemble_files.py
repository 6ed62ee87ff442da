"""An ensemble on disk: `ensemble.json` with its band, and a folder a member as `saving` writes it."""

from __future__ import annotations

import dataclasses
import json
import math
from pathlib import Path
from typing import Any

from lagnet.errors import ModelError
from lagnet.files import finite_json, read_bounded, write_whole
from lagnet.models.ensemble import Band, Ensemble
from lagnet.models.files.saving import DAMAGED, load_model

FILE, FORMAT = "ensemble.json", 1
MOST_MEMBERS, MOST_BYTES = 1000, 2**20


def save_ensemble(ensemble: Ensemble, folder: str | Path) -> Path:
    """Write the members and then ensemble.json.

    Returns:
        The folder.
    """
    out = Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    for number, member in enumerate(ensemble.members):
        member.save(out / _name(number))
    text = {"format": FORMAT, "members": len(ensemble.members), "band": dataclasses.asdict(ensemble.band)}
    write_whole(out / FILE, finite_json(text, indent=2))
    return out


def load_ensemble(folder: str | Path) -> Ensemble:
    """Read what `save_ensemble` wrote.

    Raises:
        ModelError: not there, damaged, or from a newer format.
    """
    folder = Path(folder)
    where = str(folder / FILE)
    try:
        if (folder / FILE).stat().st_size > MOST_BYTES:
            raise ValueError("too large")
        said: Any = json.loads(read_bounded(folder / FILE, MOST_BYTES).decode("utf-8"))
        count, version, band = said["members"], said["format"], _band(said["band"])
        if not isinstance(count, int) or not 2 <= count <= MOST_MEMBERS or not isinstance(version, int):
            raise ValueError("members")
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise ModelError(f"is damaged ({error})", where=where, next_step=DAMAGED) from None
    if version > FORMAT:
        raise ModelError(f"is of format {version}, this lagnet reads up to {FORMAT}", where=where)
    members = [load_model(folder / _name(number)) for number in range(count)]
    if len(band.factor) != members[0].n_dof or len(band.floor) != members[0].n_dof:
        raise ModelError("has a band of another number of joints", where=where, next_step=DAMAGED)
    return Ensemble(members, band, source=str(folder))


def _band(said: Any) -> Band:
    band = Band(float(said["coverage"]), *(tuple(float(x) for x in said[name]) for name in ("factor", "floor")))
    if not all(math.isfinite(x) and x >= 0 for x in (band.coverage, *band.factor, *band.floor)):
        raise ValueError("band")
    return band


def _name(number: int) -> str:
    return f"member_{number:03d}"
