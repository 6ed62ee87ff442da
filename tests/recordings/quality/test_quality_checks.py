"""Each check of data finds its own fault, sets aside no more than that, and says nothing of sound recordings."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from lagnet.recordings.quality.checks import CHECK_NAMES, CHECKS
from lagnet.recordings.quality.screen import screen
from lagnet.recordings.recording import Recording

N, RATE = 2000, 100.0
JOINTS = ("shoulder", "elbow", "wrist")


def sound(seed: int = 0, *, velocity: bool = False, noise: float = 0.01, friction: float = 2.0) -> Recording:
    """Three joints on sums of sines, gravity, inertia and dry friction, with noise and an encoder's scale."""
    rng = np.random.default_rng(seed)
    time = np.arange(N) / RATE
    omega, phase = rng.uniform(0.7, 3.0, (4, 3)), rng.uniform(0, 6.3, (4, 3))
    angle = omega * time[:, None, None] + phase
    q = np.sum(0.4 * np.sin(angle), axis=1)
    v, a = np.sum(0.4 * omega * np.cos(angle), axis=1), -np.sum(0.4 * omega**2 * np.sin(angle), axis=1)
    tau = 20.0 * np.cos(q) + 1.5 * a + friction * np.tanh(v / 0.02) + v
    tau = tau + noise * 20.0 * rng.standard_normal(tau.shape)
    scale = 2 * np.pi / 2**20
    return Recording(time, np.round(q / scale) * scale, tau, JOINTS, v=v if velocity else None)


def put(recording: Recording, name: str, rows, joint, value) -> Recording:
    table = getattr(recording, name).copy()
    table[rows, joint] = value
    return replace(recording, **{name: table})


def lost(r: Recording) -> Recording:
    return put(put(r, "q", slice(700, 702), slice(None), 0.0), "tau", slice(700, 702), slice(None), 0.0)


def copies(r: Recording) -> Recording:
    source = np.arange(N)
    for row in (300, 301, 850, 1201, 1711):
        source[row] = source[row - 1]
    return replace(r.rows(source), time=r.time)


def held(r: Recording) -> Recording:
    return replace(r.rows(np.arange(N) // 5 * 5), time=r.time)


def reread(r: Recording) -> Recording:
    return replace(r.rows((np.arange(N) / 1.03).astype(int)), time=r.time)


def cut_off(r: Recording) -> Recording:
    return replace(r, tau=np.clip(r.tau, -np.inf, np.quantile(r.tau, 0.9, axis=0)))


def stuck(r: Recording) -> Recording:
    start = 900 + int(np.argmax(np.abs(np.diff(r.q[900:1100, 1]))))
    return put(r, "q", slice(start, start + 400), 1, r.q[start, 1])


def jump(r: Recording) -> Recording:
    return put(r, "q", slice(1000, None), 2, r.q[1000:, 2] + 1.5)


BROKEN: dict[str, tuple[Callable[[Recording], Recording], int, int]] = {  # fault, least and most samples set aside
    "clock_unit": (lambda r: replace(r, time=1e3 * r.time), 0, 0),
    "dead_channels": (lambda r: put(r, "tau", slice(None), 1, 0.0), 0, 0),
    "lost_packets": (lost, 2, 2),
    "held_samples": (held, N - N // 5, N - N // 5),
    "repeated_packets": (copies, 5, 5),
    "source_clock": (reread, 55, 62),
    "outliers": (lambda r: put(r, "tau", 555, 0, 300.0), 1, 1),
    "stuck_channels": (stuck, 390, 401),
    "position_steps": (jump, 0, 0),
    "velocity_of_positions": (lambda r: replace(r, v=r.v * np.array([1.0, -1.0, 1.0])), 0, 0),
    "slow_sampling": (lambda r: r.rows(slice(None, None, 60)), 0, 0),
    "sensor_saturation": (cut_off, 0, 0),
    "quantisation": (lambda r: replace(r, tau=np.round(r.tau / 4.0) * 4.0), 0, 0),
}


@pytest.mark.parametrize("name", CHECK_NAMES)
def test_the_check_finds_its_fault(name: str) -> None:
    fault, least, most = BROKEN[name]
    whole = sound(velocity=name == "velocity_of_positions")
    broken = fault(whole)
    found = [f for f in screen(broken).findings if f.check == name]
    assert found, f"{name} says nothing"
    rows = np.unique(np.concatenate([f.rows for f in found]))
    assert least <= rows.size <= most
    assert all(f.detail and f.mend for f in found)
    assert set(found[0].to_dict()) == {
        "check",
        "recording",
        "channel",
        "interval_s",
        "certainty",
        "detail",
        "mend",
    }


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("noise", [0.0, 0.03])
def test_sound_recordings_raise_no_alarm(seed: int, noise: float) -> None:
    for velocity in (False, True):
        assert not [f.sentence() for f in screen(sound(seed, velocity=velocity, noise=noise)).findings]


@pytest.mark.parametrize("check", CHECKS)
def test_every_check_says_what_it_is(check) -> None:
    assert check.name in BROKEN
    assert check.title
    assert check.meaning.endswith(".")


@pytest.mark.parametrize("size", [1.0, 8.0, -3.0])
@pytest.mark.parametrize("length", [1, 2, 5])
def test_runs_of_positions_off_their_curve_are_set_aside_and_nothing_else(size: float, length: int) -> None:
    whole = sound(3)
    rows = np.arange(612, 612 + length)
    broken = put(whole, "q", rows, 1, whole.q[rows, 1] + size)
    valid = screen(broken).recording.valid
    assert valid is not None
    np.testing.assert_array_equal(np.flatnonzero(~valid), rows)


def test_a_stop_that_shows_in_motion_and_torque_is_no_outlier() -> None:
    """An arm that is stopped at once: the torque of one sample is large, and the speed falls to zero in it."""
    whole = sound(1, noise=0.01)
    q, tau = whole.q.copy(), whole.tau.copy()
    q[1200:] = q[1200]
    tau[1200:] = tau[1201] + 0.2 * np.random.default_rng(1).standard_normal((N - 1200, 3))
    tau[1200] += 60.0
    findings = screen(replace(whole, q=q, tau=tau)).findings
    assert not [f for f in findings if f.check == "outliers"]


@pytest.mark.parametrize("start", range(898, 906))
def test_the_edges_of_a_contact_are_no_outliers(start: int) -> None:
    """Torque that rises within three samples, stays, and falls again, while the motion goes on as planned."""
    whole = sound(2, noise=0.01)
    edge = np.interp(np.arange(N), [start, start + 3, start + 400, start + 403], [0.0, 1.0, 1.0, 0.0])
    pushed = replace(whole, tau=whole.tau + 6.0 * edge[:, None])
    assert not [f for f in screen(pushed).findings if f.check == "outliers"]


def test_a_brief_blow_on_the_torque_is_told_and_left_in() -> None:
    """A gap's flank that hits: two samples a little off; the log of a bus that fails looks no different."""
    whole = sound(4, noise=0.01)
    hit = put(whole, "tau", slice(1771, 1773), 2, whole.tau[1771:1773, 2] - 12.0)
    found = [f for f in screen(hit).findings if f.check == "outliers"]
    assert [f.certainty for f in found] == ["likely"]
    assert "left in" in found[0].mend
    assert not found[0].rows.size


@pytest.mark.shared_data
def test_real_recordings_raise_no_false_alarm(shared_data) -> None:
    """Seen as pictures: the UR10e runs end in stops, the Panda's log repeats 5 % of its rows to the last digit."""
    from lagnet.recordings.loading.load import load_recording

    for name in ("ur10e/holdout", "ur10e/joint_1_alone", "staubli_tx40/fit", "emps/holdout"):
        recording = load_recording(shared_data / f"{name}.csv.gz", torque_constant=10.0)
        assert not [f.sentence() for f in screen(recording).findings], name
    panda = screen(load_recording(shared_data / "panda" / "holdout.csv.gz")).findings
    assert [f.check for f in panda] == ["repeated_packets"]


@pytest.mark.parametrize(
    ("types", "unit"),
    [
        (None, "rad or m"),
        (("revolute", "prismatic", "revolute"), "m"),
        (("continuous", "revolute", "prismatic"), "rad"),
    ],
)
def test_an_outlier_is_told_in_the_unit_of_its_joint(types: tuple[str, ...] | None, unit: str) -> None:
    robot = None if types is None else SimpleNamespace(joint_types=types)
    found = screen(put(sound(), "q", 500, 1, 3.0), robot).findings
    assert [f"{unit} off their curve" in f.detail for f in found if f.check == "outliers"] == [True]
