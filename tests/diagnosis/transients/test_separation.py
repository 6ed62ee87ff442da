"""Edges of what acts for a while lie within its recording, or a little beyond; what lasts is no event."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.problem.intervals import EventInterval
from lagnet.diagnosis.problem.problem import pose_problem
from lagnet.diagnosis.transients.detection import Scan
from lagnet.diagnosis.transients.separation import separate, within_recording
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.recordings.conditioning.condition import condition

LITTLE = 0.1  # [s]
KNOWN = {"t0": (-60.0, 10.0), "t1": (8.9, 9.1), "m": (0.9, 1.1)}


@pytest.fixture(scope="module")
def problem(plant, arm):
    return pose(arm, plant().record(27), plant().record(28)).problem


def test_an_edge_far_before_the_recording_is_where_it_begins(problem) -> None:
    effect, intervals = within_recording(problem, NamedEffect("payload", None, {"m": 1.0}, (-25.0, 9.0), 0), KNOWN)
    start, end = effect.interval
    assert -LITTLE < start <= problem.fit[0].time[0]
    assert end == 9.0
    assert intervals == {**KNOWN, "t0": (start, start)}


def test_edges_inside_are_left_as_they_are(problem) -> None:
    given = NamedEffect("payload", None, {"m": 1.0}, (3.0, 9.0), 0)
    effect, intervals = within_recording(problem, given, KNOWN)
    assert effect == given
    assert intervals == KNOWN


MASS, OFF = 1.0, 0.8  # [kg] of a load on the arm, and of its estimate from other motion over the true one
PUSH = np.array([6.0, -9.0, 12.0])  # [N]


@pytest.fixture(scope="module", params=["still", "pushed"])
def recording_throughout(request, plant, arm):
    """What is told of an event that is all of recording 1, and whether something pushed there."""
    real = plant(robot=arm.with_payload(MASS, np.array([0.0, 0.0, 0.08]), 3e-4 * np.eye(3)))
    first = real.record(1)
    if request.param == "pushed":
        first = replace(first, tau=first.tau + np.einsum("tij,i->tj", jacobian(arm, first.q), PUSH))
    fit = condition([first, real.record(2)])
    problem = pose_problem(arm, fit, condition([real.record(3)], fit.bandwidth))
    moments = {"Ixx": 3e-4, "Ixy": 0.0, "Iyy": 3e-4, "Ixz": 0.0, "Iyz": 0.0, "Izz": 3e-4}
    guess = NamedEffect("payload", None, {"m": OFF * MASS, "cx": 0.0, "cy": 0.0, "cz": 0.08, **moments})
    noise = np.full(arm.n_dof, 0.02) * problem.scale
    whole = EventInterval(0, False, float(first.time[0]), float(first.time[-1]), 1e4)
    return separate(problem, [guess], noise, Scan((whole,), noise**2, 1.0)), request.param == "pushed"


def jacobian(arm, q):
    """∂ place of the last joint / ∂ q by central differences, shape (n, 3, dof)."""
    out = []
    for joint in range(q.shape[1]):
        step = 1e-5 * np.eye(q.shape[1])[joint]
        there, here = (np.array([arm.skeleton(row)[-2] for row in q + s]) for s in (step, -step))
        out.append((there - here) / 2e-5)
    return np.stack(out, axis=-1)


def test_what_lasts_is_fitted_to_a_recording_before_something_is_said_to_act_all_along_it(recording_throughout) -> None:
    """A mass from other recordings that is off leaves a force of its weight, which the mass itself explains better."""
    found, pushed = recording_throughout
    assert [t.effect.effect for t in found.transients] == (["contact_force"] if pushed else [])
    assert found.unnamed == ()
    assert found.refit.effects[0].values["m"] == pytest.approx(MASS, rel=0.03)


RIPPLE = 0.2  # of the usual torque


def test_loads_of_all_recordings_need_not_stand_beside_laws_of_one_alone(plant, arm) -> None:
    """Springs and offsets fitted to one recording take the weight of its load: there is no other that denies them.

    A ripple of a fifth of the torque is then more than what the load explains beside them.
    """
    size = plant().usual_torque()
    centres = (np.array([0.15, 0.0, 0.1]), np.array([-0.15, 0.0, 0.1]))
    arms = [arm.with_payload(2.0, centre, 3e-3 * np.eye(3)) for centre in centres]
    loaded = [plant(lambda q, v, a, tau: RIPPLE * size * np.sin(9.0 * q), robot=one) for one in arms]
    records = [real.record(seed, 8.0) for seed, real in enumerate(loaded, 1)]
    fit = condition(records)
    problem = pose_problem(arm, fit, condition([loaded[0].record(3, 8.0)], fit.bandwidth))
    laws = {"joint_spring": {"k": 0.0, "q0": 0.0}, "torque_offset": {"b": 0.0}, "viscous_friction": {"Fv": 0.0}}
    beside = [NamedEffect(law, joint, values) for joint in range(arm.n_dof) for law, values in laws.items()]
    noise = np.full(arm.n_dof, 0.1) * problem.scale
    events = [EventInterval(n, False, float(r.time[0]), float(r.time[-1]), 1e4) for n, r in enumerate(records)]
    found = separate(problem, beside, noise, Scan(tuple(events), noise**2, 1.0))
    assert sorted((t.effect.effect, t.effect.recording) for t in found.transients) == [("payload", 0), ("payload", 1)]
