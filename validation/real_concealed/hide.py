"""What is hidden in recordings of the real UR10e, and how each is hidden. No formula of the catalogue is used here."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import butter, sosfiltfilt

from lagnet.models.corrected.model import CorrectedModel
from lagnet.recordings.recording import Recording

Case = tuple[Any, list[list[Recording]]]
"""A nominal model, and the recordings to fit on and to hold out."""

BAND = 5.0  # [Hz] of the motion that a virtual load is carried along
PAYLOAD, CENTRE = 2.0, np.array([0.0, 0.02, 0.08])  # [kg], [m] in the frame of the last joint
LIGHTER, GAIN, DELAY = 0.75, 1.12, 0.020  # share of a link's mass, of a joint's torque; [s]
LINK, GAINED, DELAYED, RUBBING = 2, 1, 0, 2  # joints, counted from 0


@dataclass(frozen=True)
class Hiding:
    """One known difference.

    Args:
        name: what is hidden, in words.
        effects: the names that are right, at `joint` (None: the whole arm).
        joint: index.
        parameter, value: what should be found.
        apply: makes the case from calibrated model and recordings.
    """

    name: str
    effects: tuple[str, ...]
    joint: int | None
    parameter: str | None
    value: float | None
    apply: Callable[[CorrectedModel, Sequence[Sequence[Recording]]], Case]


def _each(recordings: Sequence[Sequence[Recording]], change: Callable[[Recording], Recording]) -> list[list[Recording]]:
    return [[change(r) for r in part] for part in recordings]


def _nothing(model: CorrectedModel, recordings: Sequence[Sequence[Recording]]) -> Case:
    return model, _each(recordings, lambda r: r)


def _lighter_link(model: CorrectedModel, recordings: Sequence[Sequence[Recording]]) -> Case:
    bodies = model.nominal.inertial_parameters().copy()
    bodies[LINK] *= LIGHTER
    return replace(model, nominal=model.nominal.with_inertial_parameters(bodies)), _each(recordings, lambda r: r)


def _wrong_constant(model: CorrectedModel, recordings: Sequence[Sequence[Recording]]) -> Case:
    factors = np.ones(model.n_dof)
    factors[GAINED] = GAIN
    return model, _each(recordings, lambda r: replace(r, tau=r.tau * factors))


def _late_current(model: CorrectedModel, recordings: Sequence[Sequence[Recording]]) -> Case:
    def late(r: Recording) -> Recording:
        tau = r.tau.copy()
        tau[:, DELAYED] = np.interp(r.time - DELAY, r.time, r.tau[:, DELAYED])
        return replace(r, tau=tau)

    return model, _each(recordings, late)


def _virtual_payload(model: CorrectedModel, recordings: Sequence[Sequence[Recording]]) -> Case:
    loaded = model.nominal.with_payload(PAYLOAD, CENTRE, 0.004 * np.eye(3))

    def carried(r: Recording) -> Recording:
        motion = _motion(r)
        return replace(r, tau=r.tau + loaded.inverse_dynamics(*motion) - model.nominal.inverse_dynamics(*motion))

    return model, _each(recordings, carried)


def _twice_as_viscous(model: CorrectedModel, recordings: Sequence[Sequence[Recording]]) -> Case:
    viscous = _viscous(model)

    def rubbing(r: Recording) -> Recording:
        tau = r.tau.copy()
        tau[:, RUBBING] += viscous * _motion(r)[1][:, RUBBING]
        return replace(r, tau=tau)

    return model, _each(recordings, rubbing)


def _viscous(model: CorrectedModel) -> float:
    """What the calibration named [N m s/rad]. Its layers hold as much, so that the name cannot be taken out."""
    return next(e.values["Fv"] for e in model.effects if (e.effect, e.joint) == ("viscous_friction", RUBBING))


def _motion(r: Recording) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Position, velocity and acceleration of a spline through the low-passed positions, at the recorded instants."""
    rate = r.rate
    clock = np.arange(r.time[0], r.time[-1], 1.0 / rate)
    even = np.column_stack([np.interp(clock, r.time, r.q[:, j]) for j in range(r.n_dof)])
    smooth = CubicSpline(clock, sosfiltfilt(butter(4, BAND, fs=rate, output="sos"), even, axis=0))
    inside = np.clip(r.time, clock[0], clock[-1])
    return smooth(inside), smooth(inside, 1), smooth(inside, 2)


def hidings(model: CorrectedModel) -> tuple[Hiding, ...]:
    """All of them; the friction to be found is as much again as that of the calibration."""
    missing = (1.0 - LIGHTER) * float(model.nominal.inertial_parameters()[LINK][0])
    return (
        Hiding("nothing", (), None, None, None, _nothing),
        Hiding("a quarter of a link's mass", ("link_inertia",), LINK, "dm", missing, _lighter_link),
        Hiding("a wrong torque constant", ("torque_gain",), GAINED, "g", GAIN, _wrong_constant),
        Hiding("a current that comes late", ("time_delay",), DELAYED, "T", DELAY, _late_current),
        Hiding("a virtual payload", ("payload",), None, "m", PAYLOAD, _virtual_payload),
        Hiding("viscous friction", ("viscous_friction",), RUBBING, "Fv", _viscous(model), _twice_as_viscous),
    )
