"""A line in the spectrum of a torque is told; noise and motion are no line."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.problem.tonal_noise import spectral_line, tonal_noise_words
from lagnet.recordings.conditioning.condition import condition

SIZE, FREQUENCY = 0.6, 31.0  # [N m] amplitude, [Hz]


@pytest.fixture(scope="module")
def quiet(plant, at):
    return [plant(at(1, lambda q, v, a, t: 4.0 * v)).record(seed) for seed in (1, 2)]


def humming(recording, size=SIZE):
    tau = recording.tau.copy()
    tau[:, 2] += size * np.sin(2.0 * np.pi * FREQUENCY * recording.time + 1.0)
    return replace(recording, tau=tau)


def test_a_hum_is_told_with_its_joint_and_frequency_and_gets_no_name(quiet, arm, names) -> None:
    result = diagnose([humming(quiet[0])], arm, [humming(quiet[1])])
    told = [w for w in result.verdict.warnings if "hums" in w]
    assert len(told) == 1
    assert arm.joints[2] in told[0]
    assert "31 Hz" in told[0]
    assert names(result) == {("viscous_friction", arm.joints[1])}


def test_several_joints_are_told_in_one_warning_and_a_line_of_no_weight_in_none(quiet, arm) -> None:
    def words(*sizes: float) -> list[str]:
        tone = np.sin(2.0 * np.pi * FREQUENCY * quiet[0].time)[:, None] * np.array(sizes)
        return list(tonal_noise_words(condition([replace(quiet[0], tau=quiet[0].tau + tone)]), arm.joints))

    (told,) = words(2.0, 2.0, 2.0)
    assert all(joint in told for joint in arm.joints)
    whole = float(np.std(quiet[0].tau[:, 2]))
    (line,) = words(0.0, 0.0, 0.03 * whole)
    assert arm.joints[2] in line
    assert words(0.0, 0.0, 0.01 * whole) == []


def test_its_size_is_that_of_the_line(quiet) -> None:
    conditioned = condition([humming(quiet[0])])
    found = spectral_line(conditioned.stretches[0], 2, conditioned)
    assert found is not None
    assert found == (pytest.approx(FREQUENCY, abs=0.1), pytest.approx(SIZE / np.sqrt(2.0), rel=0.05))


def test_noise_and_motion_do_not_hum(quiet) -> None:
    conditioned = condition(quiet)
    assert all(spectral_line(s, j, conditioned) is None for s in conditioned.stretches for j in range(3))
