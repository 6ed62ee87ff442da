"""From samples as recorded to motion on an even clock, with what noise is left in it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.interpolate import make_interp_spline

from lagnet.errors import RecordingError
from lagnet.recordings.conditioning.bandwidth import choose_bandwidth
from lagnet.recordings.conditioning.noise import band_noise, white_noise
from lagnet.recordings.conditioning.smoothing import SHORTEST, derivative, even_clock, low_pass, resample
from lagnet.recordings.conditioning.stretches import stretches_of
from lagnet.recordings.conditioning.velocity_source import choose_velocity
from lagnet.recordings.recording import Recording
from lagnet.recordings.signals import DRIVE_SIGNALS

WIDER = 2.0  # motion is filtered this much wider than torque, so that its own filter does not colour the torque


@dataclass(frozen=True, eq=False)
class Stretch:
    """One uninterrupted stretch of motion on an even clock.

    Args:
        time: shape (n,), [s].
        q, v, a: shape (n, dof), smoothed motion.
        tau: shape (n, dof), recorded torque on the same clock, not filtered.
        recording: index of the recording it is part of.
        first, last: rows of the recording at its two ends, inclusive.
        drive: per drive signal ("command", "temperature", …) that was recorded its values of shape (n, dof), held
            from sample to sample: commands are steps, which a spline would overshoot.
    """

    time: np.ndarray
    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    tau: np.ndarray
    recording: int
    first: int
    last: int
    drive: Mapping[str, np.ndarray] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Conditioned:
    """Recordings on one even clock.

    Args:
        stretches: the uninterrupted stretches, in order.
        rate: sample rate [Hz].
        bandwidth: zero-phase low-pass for torques, recorded and modelled alike [Hz].
        velocity_from, acceleration_from: "recorded" or "differentiated".
        velocity_reason: why velocity comes from there.
        noise_q, noise_v, noise_a, noise_tau: shape (dof,), what noise leaves after filtering, standard deviations.
        white_q, white_tau: shape (dof,), noise of the samples as recorded.
        torque_shift: by which torques were read later than their stamps say [s].
    """

    stretches: tuple[Stretch, ...]
    rate: float
    bandwidth: float
    velocity_from: str
    velocity_reason: str
    acceleration_from: str
    noise_q: np.ndarray
    noise_v: np.ndarray
    noise_a: np.ndarray
    noise_tau: np.ndarray
    white_q: np.ndarray
    white_tau: np.ndarray
    torque_shift: float = 0.0


def condition(
    recordings: Sequence[Recording], bandwidth: float | None = None, torque_shift: float = 0.0
) -> Conditioned:
    """Puts recordings on an even clock, smooths their motion without phase shift and differentiates it.

    Args:
        recordings: one or more of the same joints.
        bandwidth: [Hz], chosen from the data if not given.
        torque_shift: torques are read that much later than their stamps say [s].

    Raises:
        RecordingError: a recording without torque, or none long enough to differentiate.
    """
    for recording in recordings:
        _ = recording.torque
    rate = float(np.median([r.rate for r in recordings]))
    noise = _noise(recordings, rate)
    if not noise:
        raise _too_short(recordings)
    chosen = choose_bandwidth(recordings, noise) if bandwidth is None else bandwidth
    motion_band = min(WIDER * chosen, 0.4 * rate)
    source = choose_velocity(recordings, noise, rate, motion_band)
    blend = source.crossover
    stretches = []
    for index, recording in enumerate(recordings):
        for rows in stretches_of(recording):
            if len(recording.used(rows)) >= SHORTEST:
                stretches.append(_stretch(recording, rows, index, rate, motion_band, blend, torque_shift))
    noise_q = band_noise(noise["q"], rate, motion_band)
    noise_v, noise_a = _derived_noise(noise, rate, chosen, motion_band, blend)
    return Conditioned(
        stretches=tuple(stretches),
        rate=rate,
        bandwidth=chosen,
        velocity_from=source.name,
        velocity_reason=source.reason,
        acceleration_from="differentiated",
        noise_q=noise_q,
        noise_v=noise_v,
        noise_a=noise_a,
        noise_tau=band_noise(noise["tau"], rate, chosen),
        white_q=noise["q"],
        white_tau=noise["tau"],
        torque_shift=torque_shift,
    )


def _too_short(recordings: Sequence[Recording]) -> RecordingError:
    """What is wrong with recordings of which no stretch without a gap is long enough to differentiate."""
    longest = max((rows.stop - rows.start for r in recordings for rows in stretches_of(r)), default=0)
    return RecordingError(
        f"{longest} samples without a gap are too few to differentiate; {SHORTEST} are the least",
        where=", ".join(r.path for r in recordings if r.path) or None,
        next_step="record longer, or join what was cut into pieces",
    )


def _stretch(
    recording: Recording, rows: slice, index: int, rate: float, motion_band: float, blend: float | None, shift: float
) -> Stretch:
    used = recording.used(rows)
    time = used.time
    clock = even_clock(time, rate)
    q = low_pass(resample(time, used.q, clock), rate, motion_band)
    v = derivative(clock, q)
    if blend is not None and used.v is not None:
        difference = low_pass(resample(time, used.v, clock), rate, motion_band) - v
        v = v + difference - low_pass(difference, rate, blend)
    a = derivative(clock, v)
    tau = resample(time, used.torque, clock + shift)
    return Stretch(clock, q, v, a, tau, index, rows.start, rows.stop - 1, _drive_signals(used, clock))


def _drive_signals(recording: Recording, clock: np.ndarray) -> dict[str, np.ndarray]:
    """Each drive signal at the last sample before each time of the clock, shape (n, dof)."""
    last = np.maximum(np.searchsorted(recording.time, clock, side="right") - 1, 0)
    return {name: getattr(recording, name)[last] for name in recording.signals if name in DRIVE_SIGNALS}


def _noise(recordings: Sequence[Recording], rate: float) -> dict[str, np.ndarray]:
    """White noise of q, v and tau, the root mean square over stretches."""
    powers: dict[str, list[np.ndarray]] = {"q": [], "v": [], "tau": []}
    weights: list[int] = []
    for recording in recordings:
        for rows in stretches_of(recording):
            used = recording.used(rows)
            if len(used) < SHORTEST:
                continue
            weights.append(len(used))
            clock = even_clock(used.time, rate)
            for name in powers:
                signal = getattr(used, name)
                if signal is not None:
                    powers[name].append(white_noise(resample(used.time, signal, clock)) ** 2)
    return {n: np.sqrt(np.average(p, axis=0, weights=weights)) for n, p in powers.items() if len(p) == len(weights) > 0}


def _derived_noise(
    noise: dict[str, np.ndarray], rate: float, band: float, motion_band: float, blend: float | None
) -> tuple[np.ndarray, np.ndarray]:
    if blend is None:
        return band_noise(noise["q"], rate, motion_band, 1), band_noise(noise["q"], rate, band, 2)
    slow_v, slow_a = (band_noise(noise["q"], rate, min(blend, band), k) for k in (1, 2))
    quick_v, quick_a = (band_noise(noise["v"], rate, b, k) for b, k in ((motion_band, 0), (band, 1)))
    return np.hypot(slow_v, quick_v), np.hypot(slow_a, quick_a)


def motion_at_samples(recording: Recording, conditioned: Conditioned, index: int) -> tuple[np.ndarray, ...]:
    """Smoothed q, v, a at every sample of the recording as given, each of shape (n, dof).

    Samples outside every stretch (too short a run between gaps) keep their position, at rest.
    """
    q, v, a = recording.q.copy(), np.zeros_like(recording.q), np.zeros_like(recording.q)
    for stretch in conditioned.stretches:
        if stretch.recording != index:
            continue
        rows = slice(stretch.first, stretch.last + 1)
        at = np.clip(recording.time[rows], stretch.time[0], stretch.time[-1])
        for out, signal in ((q, stretch.q), (v, stretch.v), (a, stretch.a)):
            out[rows] = make_interp_spline(stretch.time, signal, k=3, axis=0)(at)
    return q, v, a
