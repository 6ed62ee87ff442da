"""What a motion excites: facts that decide which physics a recording can show at all."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.recordings.recording import Recording

STILL = 0.02  # share of the joint's top speed below which it counts as standing
TOP = 0.99  # quantile of |v| that stands for the top speed: single glitches do not count
MOVED = 5e-3  # [rad or m] travel below which a joint was held, shaken by the others at most


@dataclass(frozen=True)
class JointExcitation:
    """What one joint did in all recordings together.

    Args:
        joint: its name.
        position_range: (lowest, highest) q [rad] or [m].
        speed_range: (lowest, highest) |v| while moving [rad/s] or [m/s]; (0, 0) where it was held.
        forward_share: share of moving samples with v > 0.
        backward_share: share of moving samples with v < 0.
        reversals: number of changes of direction, counted between stretches that are faster than standing.
        acceleration_rms: root mean square of a [rad/s²] or [m/s²].
        torque_range: (lowest, highest) torque [N m] or [N].
        samples: number of samples.
    """

    joint: str
    position_range: tuple[float, float]
    speed_range: tuple[float, float]
    forward_share: float
    backward_share: float
    reversals: int
    acceleration_rms: float
    torque_range: tuple[float, float]
    samples: int

    @property
    def moves(self) -> bool:
        """Whether the joint moved at all."""
        return self.position_range[1] - self.position_range[0] > MOVED

    @property
    def both_directions(self) -> bool:
        """Whether it moved either way for at least a twentieth of its moving time."""
        return min(self.forward_share, self.backward_share) >= 0.05


def excitation(recordings: Recording | list[Recording] | tuple[Recording, ...]) -> tuple[JointExcitation, ...]:
    """Per-joint facts about the motion in all recordings together, in joint order.

    Velocities and accelerations come from the recording; where absent, from differences of q inside each motion. Give
    conditioned recordings where a noisy q would make the differences meaningless.
    """
    given = [recordings] if isinstance(recordings, Recording) else list(recordings)
    motions = [_rates(part) for recording in given for part in recording.parts()]
    return tuple(_joint(given[0].joints[j], j, motions) for j in range(given[0].n_dof))


def _rates(part: Recording) -> tuple[Recording, np.ndarray, np.ndarray]:
    """One motion with v and a, shapes (n, dof)."""
    single = len(part) < 2
    v = part.v if part.v is not None else np.zeros_like(part.q) if single else np.gradient(part.q, part.time, axis=0)
    a = part.a if part.a is not None else np.zeros_like(v) if single else np.gradient(v, part.time, axis=0)
    return part, v, a


def _joint(name: str, j: int, motions: list[tuple[Recording, np.ndarray, np.ndarray]]) -> JointExcitation:
    q = np.concatenate([part.q[:, j] for part, _, _ in motions])
    tau = np.concatenate([part.tau[:, j] for part, _, _ in motions])
    v = np.concatenate([v[:, j] for _, v, _ in motions])
    a = np.concatenate([a[:, j] for _, _, a in motions])
    held = float(np.ptp(q)) <= MOVED
    threshold = np.inf if held else STILL * float(np.quantile(np.abs(v), TOP))
    moving = np.abs(v) > threshold
    speeds = np.abs(v[moving])
    return JointExcitation(
        joint=name,
        position_range=(float(q.min()), float(q.max())),
        speed_range=(float(speeds.min()), float(speeds.max())) if speeds.size else (0.0, 0.0),
        forward_share=float(np.mean(v[moving] > 0)) if speeds.size else 0.0,
        backward_share=float(np.mean(v[moving] < 0)) if speeds.size else 0.0,
        reversals=sum(_reversals(rate[:, j], threshold) for _, rate, _ in motions),
        acceleration_rms=float(np.sqrt(np.mean(a**2))),
        torque_range=(float(tau.min()), float(tau.max())),
        samples=q.size,
    )


def _reversals(v: np.ndarray, threshold: float) -> int:
    """Changes of direction in one motion; standing in between does not count twice."""
    directions = np.sign(v[np.abs(v) > threshold])
    return int(np.sum(directions[1:] != directions[:-1]))
