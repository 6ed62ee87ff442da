"""A push and a load that act for a while are found with their edges; what lasts is found as if they were not there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.transients.separation import is_resolved
from lagnet.models.corrected.folder import load_corrected, save_corrected
from lagnet.models.corrected.model import NamedEffect
from lagnet.models.files.loading import load_any
from lagnet.recordings.recording import Recording

pytestmark = pytest.mark.xdist_group("transients")  # what they share is made once

FORCE, POINT = np.array([6.0, -9.0, 12.0]), np.array([0.02, -0.05, 0.08])
START, END = 9.004, 13.006  # [s], between two samples of the recording
SAMPLE = 0.01  # [s] between two samples
NEAR = 0.03  # relative error of a force from four seconds with 1 % noise
WITHIN = 0.02  # [s] by which an edge may be off: two samples
FRICTION = 4.0  # [N m s/rad]


@pytest.fixture(scope="module")
def during():
    """A recording with another torque in it from START to END, of a law of (q, v, a)."""

    def added(recording: Recording, real, law) -> Recording:
        time = recording.time
        q = recording.q
        v, a = np.gradient(q, SAMPLE, axis=0), np.gradient(np.gradient(q, SAMPLE, axis=0), SAMPLE, axis=0)
        inside = ((time >= START) & (time < END))[:, None]
        return replace(recording, tau=recording.tau + inside * law(q, v, a))

    return added


def pushed(arm):
    """Joint torque of a push on the surroundings, by the work that it does in a small motion of the point."""

    def law(q, v, a):
        out = np.zeros_like(q)
        for joint in range(q.shape[1]):
            step = np.zeros(q.shape[1])
            step[joint] = 1e-5
            out[:, joint] = (place_of(arm, q + step) - place_of(arm, q - step)) @ FORCE / 2e-5
        return out

    return law


def place_of(arm, q):
    """Where the point of contact is, shape (n, 3): the last joint's origin, and the point in its frame."""
    origins = np.array([arm.skeleton(row)[-2] for row in q])
    return origins + arm.orientation(q) @ POINT


@pytest.fixture(scope="module")
def contact(plant, arm, at, during):
    real = plant(at(1, lambda q, v, a, t: FRICTION * v))
    recordings = [real.record(1), during(real.record(2), real, pushed(arm))]
    return diagnose(recordings, arm, [real.record(3)]), real


def test_a_contact_is_found_with_its_force_and_its_edges(contact, names, arm) -> None:
    result, _ = contact
    assert names(result) == {("viscous_friction", arm.joints[1]), ("contact_force", None)}
    effect = next(e for e in result.effects if e.effect == "contact_force")
    found = np.array([effect.value(n) for n in ("Fx", "Fy", "Fz")])
    assert np.linalg.norm(found - FORCE) < NEAR * np.linalg.norm(FORCE)
    assert effect.interval_s == pytest.approx((START, END), abs=WITHIN)
    assert effect.recording == "recording 2"
    assert effect.evidence.holdout_nmse_with < 0.1 * effect.evidence.holdout_nmse_without


def test_what_lasts_is_not_bent_by_a_contact(contact) -> None:
    result, _ = contact
    friction = next(e for e in result.effects if e.effect == "viscous_friction")
    assert friction.value("Fv") == pytest.approx(FRICTION, rel=NEAR)
    assert all(f.nmse_named < 3.0 * f.nmse_noise_floor + 1e-4 for f in result.verdict.fit)


def test_the_corrected_model_does_not_push_in_other_motion(contact, tmp_path) -> None:
    result, real = contact
    corrected = load_corrected(save_corrected(result.corrected, tmp_path / "corrected"), load_any)
    without = corrected.with_effects([e for e in corrected.effects if e.interval is None])
    other = real.record(4)
    motion = other.time, other.q, np.gradient(other.q, SAMPLE, axis=0), np.zeros_like(other.q)
    np.testing.assert_array_equal(corrected.torque_along(*motion), without.torque_along(*motion))
    np.testing.assert_array_equal(corrected.inverse_dynamics(*motion[1:]), without.inverse_dynamics(*motion[1:]))
    there = replace(corrected, recording=1).torque_along(*motion) - without.torque_along(*motion)
    inside = (other.time > START + SAMPLE) & (other.time < END - SAMPLE)
    assert np.abs(there[inside]).max() > 1.0
    np.testing.assert_array_equal(there[(other.time < START - WITHIN) | (other.time > END + WITHIN)], 0.0)


def test_a_contact_beside_a_payload_bends_neither(plant, arm, at, during, names) -> None:
    """A payload bent by the contact differs a little all along the other recordings: these are no events."""
    loaded = arm.with_payload(1.0, np.array([0.0, 0.0, 0.08]), 3e-4 * np.eye(3))
    real = plant(at(1, lambda q, v, a, t: 0.6 * np.tanh(v / 0.01)), robot=loaded)
    recordings = [real.record(1), during(real.record(2), real, pushed(arm)), real.record(3)]
    result = diagnose(recordings, arm, [real.record(4)])
    assert names(result) == {("payload", None), ("coulomb_friction", arm.joints[1]), ("contact_force", None)}
    found = {e.effect: e for e in result.effects}
    assert found["payload"].value("m") == pytest.approx(1.0, rel=NEAR)
    assert found["contact_force"].interval_s == pytest.approx((START, END), abs=WITHIN)


def test_a_load_that_is_picked_up_is_a_payload_from_then_on(plant, arm, names, during) -> None:
    real = plant()
    loaded = arm.with_payload(1.5, np.array([0.03, 0.0, 0.1]), 0.004 * np.eye(3))
    late = during(
        real.record(12), real, lambda q, v, a: loaded.inverse_dynamics(q, v, a) - arm.inverse_dynamics(q, v, a)
    )
    result = diagnose([real.record(11), late], arm, [real.record(13)])
    assert names(result) == {("payload", None)}
    effect = result.effects[0]
    assert effect.value("m") == pytest.approx(1.5, rel=NEAR)
    assert effect.interval_s == pytest.approx((START, END), abs=WITHIN)


@pytest.mark.slow
def test_a_load_is_found_where_one_joint_is_much_less_noisy_than_the_others(plant, arm, names, during) -> None:
    real, rng = plant(), np.random.default_rng(3)
    loaded = arm.with_payload(1.5, np.array([0.03, 0.0, 0.1]), 0.004 * np.eye(3))

    def noisy(recording: Recording) -> Recording:
        noise = rng.normal(0.0, 3.0, recording.tau.shape) * (np.arange(arm.n_dof) < arm.n_dof - 1)
        return replace(recording, tau=recording.tau + noise)

    late = during(
        real.record(12), real, lambda q, v, a: loaded.inverse_dynamics(q, v, a) - arm.inverse_dynamics(q, v, a)
    )
    result = diagnose([noisy(real.record(11)), noisy(late)], arm, [noisy(real.record(13))])
    assert names(result) == {("payload", None)}
    assert result.effects[0].interval_s == pytest.approx((START, END), abs=WITHIN)


@pytest.mark.slow
def test_a_contact_in_a_held_out_recording_is_told_and_spoils_no_name(plant, arm, at, names, during) -> None:
    real = plant(at(1, lambda q, v, a, t: FRICTION * v))
    held = during(real.record(23), real, pushed(arm))
    result = diagnose([real.record(21), real.record(22)], arm, [held])
    assert names(result) == {("viscous_friction", arm.joints[1])}
    assert any("something acts on the arm" in warning for warning in result.verdict.warnings)
    touched = [u for u in result.verdict.unexplained if u.above_noise]
    assert touched
    assert all(u.depends_on[0] == "time" for u in touched)


def test_without_an_event_nothing_acts_for_a_while(plant, arm, at) -> None:
    real = plant(at(0, lambda q, v, a, t: 2.0 * np.tanh(v / 1e-3)))
    result = diagnose([real.record(31), real.record(32)], arm, [real.record(33)])
    assert all(e.interval_s is None for e in result.effects)
    assert result.verdict.warnings == ()


@pytest.mark.parametrize(
    ("length", "bandwidth", "resolved"), [(0.1, 6.9, False), (0.4, 6.9, False), (0.7, 6.9, True), (0.7, 1.2, False)]
)
def test_what_is_shorter_than_a_burst_or_a_period_of_the_low_pass_has_no_name(length, bandwidth, resolved) -> None:
    """0.4 s: as long as a piece of what the Panda leaves unexplained, on a plant that hides nothing."""
    values = dict.fromkeys(("Fx", "Fy", "Fz", "px", "py", "pz"), 1.0)
    push = NamedEffect("contact_force", None, values, (5.0, 5.0 + length))
    assert is_resolved(push, bandwidth) is resolved


def test_an_interval_belongs_to_one_recording(arm) -> None:
    effect = NamedEffect("contact_force", None, {n: 1.0 for n in ("Fx", "Fy", "Fz", "px", "py", "pz")}, (1.0, 2.0), 1)
    moved = effect.at_coordinates(effect.coordinates() + 0.25)
    assert moved.interval == (1.25, 2.25)
    assert moved.recording == 1
    assert moved.parameters()["t1"] == 2.25


@pytest.mark.slow
def test_a_load_carried_for_a_while_on_a_tilted_base_weighs_in_the_true_field(plant, arm, names, during) -> None:
    gravity = 9.81 * np.array([0.14, -0.11, 0.0])
    tilted = arm.with_gravity(gravity - np.array([0.0, 0.0, np.sqrt(9.81**2 - gravity @ gravity)]))
    loaded = tilted.with_payload(1.0, np.array([0.05, 0.08, 0.15]), 0.004 * np.eye(3))
    real = plant(robot=tilted)

    def load(q, v, a):
        return loaded.inverse_dynamics(q, v, a) - tilted.inverse_dynamics(q, v, a)

    result = diagnose([real.record(1), during(real.record(2), real, load)], arm, [real.record(3)])
    assert names(result) == {("gravity_tilt", None), ("payload", None)}
    found = next(e for e in result.effects if e.effect == "payload")
    assert found.value("m") == pytest.approx(1.0, rel=0.02)
    assert found.interval_s == pytest.approx((START, END), abs=WITHIN)
