"""The arrays behind a verdict, which reports draw: residuals, laws, and comparisons with rivals.

A verdict holds the conclusions, as JSON; this holds the evidence for them. Every part may be absent:
a learned nominal model has no skeleton, a joint without friction no law to draw.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from lagnet.diagnosis.nominal.log_alignment import SideBySide
from lagnet.diagnosis.unexplained.formula import RemainderShape
from lagnet.rigid_body.body_tree import TreeBody
from lagnet.types import Samples


@dataclass(frozen=True)
class HeldOutSeries:
    """Torque of one joint on the held-out recordings, all lines through the same zero-phase filter.

    Args:
        time: t, shape (n,) [s], increasing within a segment; every recording may start anew.
        measured: torque of the recording, shape (n,) [N m or N].
        nominal: torque of the nominal model, shape (n,) [N m or N].
        corrected: torque of the nominal model with the named effects, shape (n,) [N m or N].
        segments: (start, stop) of each unbroken motion, as sample indices; one segment of all samples if empty.
        names: a name for each segment, such as its recording; may be empty.
        full: torque of all layers of the correction, shape (n,) [N m or N]; None where only the named one has any.
    """

    time: Samples
    measured: Samples
    nominal: Samples
    corrected: Samples
    segments: tuple[tuple[int, int], ...] = ()
    names: tuple[str, ...] = ()
    full: Samples | None = None


@dataclass(frozen=True)
class ResidualByVelocity:
    """Measured minus modelled torque of one joint, sample by sample, low-pass filtered.

    Args:
        velocity: v, shape (n,) [rad/s or m/s].
        nominal: residual of the nominal model, shape (n,) [N m or N].
        corrected: residual of the corrected model, shape (n,) [N m or N].
    """

    velocity: Samples
    nominal: Samples
    corrected: Samples


@dataclass(frozen=True)
class FrictionLaw:
    """r(v), the sum of the named friction effects of one joint as a curve over velocity.

    Args:
        effects: names of the effects in the sum.
        velocity: v, shape (n,) [rad/s or m/s], increasing.
        torque: r(v), shape (n,) [N m or N].
    """

    effects: tuple[str, ...]
    velocity: Samples
    torque: Samples


@dataclass(frozen=True)
class JointEvidence:
    """The evidence on one joint.

    Args:
        joint: its name.
        unit: "N m" for a revolute joint, "N" for a prismatic one.
        held_out: torque over time on the held-out recordings.
        residual: residual against velocity.
        law: the fitted friction law.
        noise_rms: estimated noise of the torque residual [unit].
        predictable_share: predictable share of the remainder, R² of a smooth function of state and short history on
            held-out motion, 0 to 1; None where the remainder is noise.
        remainder: the remainder against the signal that predicts it best.
    """

    joint: str
    unit: str = "N m"
    held_out: HeldOutSeries | None = None
    residual: ResidualByVelocity | None = None
    law: FrictionLaw | None = None
    noise_rms: float | None = None
    predictable_share: float | None = None
    remainder: RemainderShape | None = None

    @property
    def velocity_unit(self) -> str:
        """Unit of the joint's velocity."""
        return "m/s" if self.unit == "N" else "rad/s"


@dataclass(frozen=True)
class Comparison:
    """A named effect against its rivals on the same data: (rival, log10 odds in favour of the named effect)."""

    effect: str
    joint: str | None
    rivals: tuple[tuple[str, float], ...]


@dataclass(frozen=True)
class Skeleton:
    """Positions and axes of the joints in one pose, in the base frame.

    Args:
        points: base, origin of every joint in model order, tip; shape (dof + 2, 3) [m].
        axes: unit vector along which or about which each joint moves, shape (dof, 3).
    """

    points: np.ndarray
    axes: np.ndarray


@dataclass(frozen=True, eq=False)
class ArmMotion:
    """A held-out motion to play, with the residual of every joint.

    Args:
        tree: the moving bodies.
        tip: shape (3,), point at the end of the arm in the last joint's frame [m].
        time: shape (m,), from zero [s].
        q: shape (m, dof), positions [rad or m].
        before, after: shape (m, dof), |r_j| of the nominal and of the corrected model over the standard deviation of
            the measured torque.
    """

    tree: tuple[TreeBody, ...]
    tip: np.ndarray
    time: Samples
    q: np.ndarray
    before: np.ndarray
    after: np.ndarray


@dataclass(frozen=True)
class SelectionStep:
    """One selected effect, and the mean nMSE on held-out blocks with it and all before it."""

    effect: str
    joint: str | None
    holdout_nmse: float


@dataclass(frozen=True)
class ReportData:
    """The evidence that a report shows beside the verdict.

    Args:
        joints: one entry a joint, in model order.
        comparisons: the named and tied effects against their rivals.
        skeleton: the arm's joints in space, where the nominal model has bodies.
        selection: the effects in the order of their choice.
        settings: resolved settings of the diagnosis, by name.
        versions: versions of the packages that computed it, by name.
        checksums: sha256 of what went in, by file name.
        overlays: real and simulated logs of the same commands, where there were logs of a simulator.
        motion: a held-out motion to play, where the nominal model has bodies.
    """

    joints: tuple[JointEvidence, ...] = ()
    comparisons: tuple[Comparison, ...] = ()
    skeleton: Skeleton | None = None
    selection: tuple[SelectionStep, ...] = ()
    settings: Mapping[str, Any] = field(default_factory=dict)
    versions: Mapping[str, str] = field(default_factory=dict)
    checksums: Mapping[str, str] = field(default_factory=dict)
    overlays: tuple[SideBySide, ...] = ()
    motion: ArmMotion | None = None

    def of(self, joint: str) -> JointEvidence:
        """The evidence on a joint by its name; an empty one where there is none."""
        found = (entry for entry in self.joints if entry.joint == joint)
        return next(found, JointEvidence(joint))
