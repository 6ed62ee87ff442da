"""One concealed plant as data, without a random draw left; sealed as JSON."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, dataclass

from validation.plants.spec import Hidden


@dataclass(frozen=True)
class Plan:
    """Everything that makes one plant.

    Args:
        number, seed: of the plant; the seed is that of motions and noise.
        group: what the plant is drawn for, such as "listed" or "unlisted".
        robot: a name of example-robot-data.
        hidden: the physics that the nominal model lacks; an unlisted cause is called "unlisted:...".
        noise: rms of the torque noise over the rms of each joint's torque.
        encoder_bits: per turn; 0 for an encoder without steps.
        angle_noise: [rad], of an encoder without steps.
        current_filter: corner of the first-order filter on the torque signal [Hz]; 0 for none.
        velocity: whether speeds are recorded.
        controller, engine: how the arm is driven, and what integrates it.
        shapes: of the recordings, the held-out one last.
        speed_share: of the joints' speed limits.
        duration, rate, step_rate: [s, Hz, Hz].
    """

    number: int
    seed: int
    group: str
    robot: str
    hidden: tuple[Hidden, ...]
    noise: float
    encoder_bits: int
    angle_noise: float
    current_filter: float
    velocity: bool
    controller: str
    engine: str
    shapes: tuple[str, ...]
    speed_share: float
    duration: float = 20.0
    rate: float = 100.0
    step_rate: float = 1000.0

    @property
    def name(self) -> str:
        """Folder name."""
        return f"plant_{self.number:04d}"

    @property
    def recordings(self) -> tuple[str, ...]:
        """Names of the recordings, in the order of `shapes`."""
        return (*(f"fit_{i}" for i in range(len(self.shapes) - 1)), "holdout")

    def sealed(self) -> bytes:
        """The envelope's content."""
        return json.dumps(asdict(self), indent=1, sort_keys=True).encode()

    def fingerprint(self) -> str:
        """sha256 of the envelope."""
        return hashlib.sha256(self.sealed()).hexdigest()


def opened(content: bytes) -> Plan:
    """The plant in an envelope."""
    fields = json.loads(content)
    hidden = tuple(Hidden(**entry) for entry in fields.pop("hidden"))
    fields["shapes"] = tuple(fields["shapes"])
    return Plan(hidden=hidden, **fields)
