"""A name is tied with a law that the recordings could not judge, where that law would explain them as well."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import diagnose

SHARP = 1e-3  # [rad/s] over which the plant's dry friction changes sign


def about_one_pose(real, seed: int):
    """One joint in small strokes, so that its load hardly varies; the others stand still."""
    from lagnet.recordings.recording import Recording

    rng, n = np.random.default_rng(seed), real.robot.n_dof
    time = np.arange(2000) / 100.0
    q = np.tile(np.array([0.2, 0.5, 0.3]), (time.size, 1))
    omega, phase = 2.0 * np.pi * 0.4, rng.uniform(0.0, 2.0 * np.pi)
    v, a = np.zeros_like(q), np.zeros_like(q)
    q[:, 1] += 0.03 * np.sin(omega * time + phase)
    v[:, 1] = 0.03 * omega * np.cos(omega * time + phase)
    a[:, 1] = -0.03 * omega**2 * np.sin(omega * time + phase)
    tau = real.torque(q, v, a)
    tau = tau + 0.01 * real.usual_torque() * rng.standard_normal((time.size, n))
    return Recording(time, q + 1e-5 * rng.standard_normal(q.shape), tau, real.robot.joints)


@pytest.mark.slow
def test_friction_under_a_constant_load_has_two_names(plant, arm, at) -> None:
    laws = (
        lambda q, v, a, t: 0.3 * np.abs(t) * np.tanh(v / SHARP),
        lambda q, v, a, t: 2.0 * np.tanh(v / SHARP),
    )
    for law in laws:
        real = plant(at(1, law))
        result = diagnose([about_one_pose(real, 1)], arm, [about_one_pose(real, 2)])
        named = {e.effect: e for e in result.effects if e.joint == arm.joints[1]}
        silent = {(a.effect, a.joint) for a in result.verdict.abstentions}
        assert set(named) == {"coulomb_friction"}
        assert ("load_dependent_friction", arm.joints[1]) in silent
        assert "load_dependent_friction" in named["coulomb_friction"].tied_with
        assert named["coulomb_friction"].status == "tied"


def test_dry_friction_under_all_loads_has_one_name(plant, arm, at) -> None:
    real = plant(at(1, lambda q, v, a, t: 2.0 * np.tanh(v / SHARP)))
    result = diagnose([real.record(51)], arm, [real.record(52)])
    assert [(e.effect, e.tied_with) for e in result.effects] == [("coulomb_friction", ())]


@pytest.mark.slow
def test_a_rotor_is_tied_with_its_link_only_while_the_other_joints_rest(plant, arm, at) -> None:
    real = plant(at(2, lambda q, v, a, t: 3.0 * a))
    alone = diagnose([real.record(53, hold=[0, 1])], arm, [real.record(54, hold=[0, 1])])
    ties = {e.effect: set(e.tied_with) for e in alone.effects if e.joint == arm.joints[2]}
    assert "link_inertia" in ties["rotor_inertia"]
    together = diagnose([real.record(55)], arm, [real.record(56)])
    assert [(e.effect, e.tied_with) for e in together.effects] == [("rotor_inertia", ())]


def test_the_first_joint_is_coupled_to_none_before_it(plant, arm, at) -> None:
    real = plant(at(0, lambda q, v, a, t: 2.0 * v + 2.0 * np.tanh(v / SHARP)))
    hold = [1, 2]  # the coupling of a joint that moves alone could not be judged
    result = diagnose([real.record(57, hold=hold)], arm, [real.record(58, hold=hold)])
    assert {e.effect for e in result.effects} == {"viscous_friction", "coulomb_friction"}
    assert not any("coupled_transmission" in e.tied_with for e in result.effects)
    silent = {(a.effect, a.joint) for a in result.verdict.abstentions}
    assert ("coupled_transmission", arm.joints[0]) not in silent
    assert ("coupled_transmission", arm.joints[1]) in silent
