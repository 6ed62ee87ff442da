"""Every simulator that lagnet writes for, by the name that `--to` takes. A new one is one file and one line here."""

from __future__ import annotations

from lagnet.errors import LagnetError
from lagnet.simulators.exporter import Exporter
from lagnet.simulators.exporters.drake import DrakeExporter
from lagnet.simulators.exporters.isaaclab import IsaacLabExporter
from lagnet.simulators.exporters.mjcf import MjcfExporter
from lagnet.simulators.exporters.pybullet import PyBulletExporter
from lagnet.simulators.exporters.sdf import SdfExporter
from lagnet.simulators.exporters.urdf import UrdfExporter
from lagnet.simulators.exporters.usd import UsdExporter

_EXPORTERS: tuple[Exporter, ...] = (
    MjcfExporter(),
    PyBulletExporter(),
    UrdfExporter(),
    SdfExporter(),
    UsdExporter(),
    DrakeExporter(),
    IsaacLabExporter(),
)

EXPORTERS: dict[str, Exporter] = {exporter.name: exporter for exporter in _EXPORTERS}


def exporter_named(name: str) -> Exporter:
    """The exporter of that name.

    Raises:
        LagnetError: there is none.
    """
    if name not in EXPORTERS:
        raise LagnetError(f"no exporter writes for {name!r}", where="--to", choices=EXPORTERS)
    return EXPORTERS[name]
