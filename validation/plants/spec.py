"""What is hidden in a plant, as data: drawn from a seed, sealed as JSON."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, dataclass

Value = float | list[float]


@dataclass(frozen=True)
class Hidden:
    """One piece of physics that the nominal model lacks.

    Args:
        effect: name of the catalogue, or "unlisted:..." for physics in nobody's catalogue.
        joint: joint name, or None for the whole arm.
        values: parameters of the plant's own law.
        size: rms of its torque over the rms of the joint's torque, as drawn.
    """

    effect: str
    joint: str | None
    values: dict[str, float]
    size: float


@dataclass(frozen=True)
class PlantSpec:
    """Everything that makes one plant, without a random draw left."""

    number: int
    seed: int
    robot: str
    hidden: tuple[Hidden, ...]
    noise: float = 0.01
    encoder_bits: int = 20
    velocity: bool = False
    controller: str = "computed_torque"
    speed_share: float = 0.7
    duration: float = 30.0
    rate: float = 100.0
    step_rate: float = 1000.0

    @property
    def name(self) -> str:
        """Folder name."""
        return f"plant_{self.number:04d}"

    def sealed(self) -> bytes:
        """The envelope's content."""
        return json.dumps(asdict(self), indent=1, sort_keys=True).encode()

    def fingerprint(self) -> str:
        """sha256 of the envelope."""
        return hashlib.sha256(self.sealed()).hexdigest()


def opened(content: bytes) -> PlantSpec:
    """The plant in an envelope."""
    fields = json.loads(content)
    hidden = tuple(Hidden(**entry) for entry in fields.pop("hidden"))
    return PlantSpec(hidden=hidden, **fields)
