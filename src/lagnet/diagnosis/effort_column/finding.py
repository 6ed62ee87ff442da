"""What a column of effort holds, with its evidence, or that the recordings cannot tell."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass

from lagnet.recordings.quality.finding import LIKELY, POSSIBLE, Finding

CANNOT_TELL = "cannot tell"
KINDS = {
    "torque": "torque at the motors' side of the gears, with gravity and friction",
    "link-side torque": "torque at the links, with gravity and without the drives' friction",
    "torque of either side": "torque with gravity; whether the drives' friction is in it cannot be told",
    "torque without gravity": "torque of a gravity-compensated controller: gravity is not in it",
    "current": "motor current, or another unit of the drive's own",
    "magnitude": "the size of a torque, current or duty cycle without its sign",
    "magnitude of torque": "the size of a torque without its sign",
    "magnitude of current": "the size of a motor current without its sign",
    "duty": "duty cycle or voltage of the motors: it grows with speed by the motors' back electromotive force",
    "position": "a copy of the position",
    "velocity": "a copy of the velocity",
    "position error": "commanded minus measured position times a gain",
    "constant": "one number that never changes",
    CANNOT_TELL: "the recordings do not tell",
}

SURE = 0.99  # probability of a unit from which a finding is likely; copies and magnitudes have none and are
JOINT_TORQUE = ("torque", "link-side torque", "torque of either side")

UNIT_IN_NEWTON_METRES = {"N mm": 0.001, "N cm": 0.01, "kgf cm": 0.0980665}


@dataclass(frozen=True)
class EffortLimits:
    """What a decision needs.

    Args:
        explained: share of the column that the best hypothesis must predict in stretches that were left out.
        error: the same of a position error.
        copy: the same of a column that is a copy of another.
        probability: of the unit.
        significant: standard deviations of a coefficient from zero.
        with_gravity, without_gravity: factor of gravity over factor of the rest, above and below which it is decided.
        gain, gain_of_rest: share of variance that gravity must add in stretches left out, of all or of what is left
            without it (back electromotive force may be nearly all of a duty cycle).
        friction, no_friction: friction of all joints over their torques, above which the motor's side of the gears and
            below which the links' side is decided; drives lose a tenth and more, bearings and seals a few hundredths.
        turning: share of the fast motion that must go each way for a sign to be missed.
        back_emf, no_back_emf: share of the column that grows with speed, above and below which it is a duty cycle or
            not.
        no_load: range of full scale over viscous factor, in speed limits, that a motor's no-load speed lies in.
    """

    explained: float = 0.6
    error: float = 0.9
    copy: float = 0.999
    probability: float = 0.95
    significant: float = 4.0
    with_gravity: float = 0.5
    without_gravity: float = 0.25
    gain: float = 0.02
    gain_of_rest: float = 0.5
    friction: float = 0.1
    no_friction: float = 0.05
    turning: float = 0.1
    back_emf: float = 0.5
    no_back_emf: float = 0.35
    no_load: tuple[float, float] = (0.7, 6.0)


@dataclass(frozen=True)
class EffortFinding:
    """What the column holds.

    Args:
        kind: a key of `KINDS`.
        unit: N m, N mm, …, "drive's own", or "" where it cannot be told.
        joints: joint names; scale: the column's units in one N m at each, None where it cannot be told.
        evidence: sentences.
        explained: hypothesis to the share of the column that it predicts in stretches left out, mean over joints.
        probability: of the unit that was decided, 0 where none was.
        n_changing: number of joints whose column changes at all.
    """

    kind: str
    unit: str
    joints: tuple[str, ...]
    scale: tuple[float | None, ...]
    evidence: tuple[str, ...]
    explained: dict[str, float]
    probability: float = 0.0
    n_changing: int = 0

    @property
    def decided(self) -> bool:
        """Whether the kind is known."""
        return self.kind != CANNOT_TELL

    @property
    def is_torque(self) -> bool:
        """Whether the column can be diagnosed as joint torque as it is."""
        return self.kind in JOINT_TORQUE and self.unit == "N m"

    def data_quality(self, recording: str) -> Finding | None:
        """A finding for a verdict's `data_quality` where the column is no joint torque in N m.

        None where it is, and where that cannot be told: no alarm without a cause.

        Args:
            recording: its path, "" for all of them.
        """
        if self.is_torque or not self.decided:
            return None
        mend = "; ".join(f"[{section}] {line}" for section, lines in self.mapping(()).items() for line in lines)
        sure = LIKELY if self.probability > SURE or not self.probability else POSSIBLE
        detail = "; ".join((self.sentence(), *self.evidence))
        return Finding("effort_column", recording, "tau", None, sure, detail, f"in the mapping file: {mend}")

    def sentence(self) -> str:
        """The finding in one sentence."""
        if not self.decided:
            return f"what the effort column holds cannot be told: {self.evidence[-1] if self.evidence else ''}"
        unit = f", in {self.unit}" if self.unit else ""
        return f"the effort column most likely holds {KINDS[self.kind]}{unit}"

    def mapping(self, columns: Sequence[str]) -> dict[str, list[str]]:
        """Lines of a mapping file by section, which read the column as what it is.

        Args:
            columns: the file's name of the column of each joint.
        """
        if self.is_torque:
            return {}
        factor = UNIT_IN_NEWTON_METRES.get(self.unit) if self.kind in JOINT_TORQUE else None
        if factor is not None:
            return {"scale": [f"tau = {factor:g}  # {self.unit} to N m"]}
        if not self.decided:
            return {"columns": ['# what tau holds could not be told; tau = "" leaves it out']}
        lines = [f'tau = ""  # {KINDS[self.kind]}: no joint torque']
        if self.kind != "current":
            return {"columns": lines}
        lines += [f'"current_{j}" = {json.dumps(name)}' for j, name in enumerate(columns)]
        known = ", ".join(f"{1 / s:.4g}" if s else "nan" for s in self.scale)
        told = ["# From the maker; the nominal model's own torque suggests these numbers:", f"# values = [{known}]"]
        return {"columns": lines, "torque_constant": told}
