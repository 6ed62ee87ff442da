"""A load that is mounted differently in two recordings is told in each; one that is mounted alike is one load."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.problem.problem import pose_problem
from lagnet.diagnosis.transients import differing_recordings
from lagnet.diagnosis.transients.detection import Scan
from lagnet.diagnosis.transients.differing_recordings import differing_groups, with_the_same_loads
from lagnet.effects.inertia.payload import INERTIA
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.recordings.conditioning.condition import condition

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("differing recordings")]  # what they share is made once

MASS = 1.5  # [kg]
NEAR = 0.05  # relative error of a mass
CENTRES = np.array([[0.03, 0.0, 0.15], [0.03, 0.1, -0.12]])  # [m], in the frame of the last link
APART = 0.03  # [m] by which a centre may be off


def carrying(plant, arm, centre, seed: int, *laws):
    """A recording of the arm with the load, and laws, while its model has none."""
    loaded = arm.with_payload(MASS, centre, 0.004 * np.eye(3))

    def law(q, v, a, body):
        return loaded.inverse_dynamics(q, v, a) - arm.inverse_dynamics(q, v, a)

    return plant(law, *laws).record(seed)


@pytest.fixture(scope="module")
def differing(plant, arm):
    return diagnose([carrying(plant, arm, c, seed) for seed, c in zip((11, 12), CENTRES, strict=True)], arm)


def test_each_recording_has_its_load(differing, names) -> None:
    assert names(differing) == {("payload", None)}
    assert len(differing.effects) == 2
    for effect in differing.effects:
        index = int(effect.recording.rsplit(" ", 1)[1]) - 1
        assert effect.value("m") == pytest.approx(MASS, rel=NEAR)
        centre = [effect.value(name) for name in ("cx", "cy", "cz")]
        np.testing.assert_allclose(centre, CENTRES[index], atol=APART)
        assert "throughout recording" in effect.explanation


def test_the_difference_is_told_and_the_held_out_ends_are_predicted(differing) -> None:
    assert any("recordings differ from each other" in line for line in differing.verdict.warnings)
    assert all(fit.nmse_named < 0.01 * max(fit.nmse_nominal, 0.05) for fit in differing.verdict.fit)


def test_a_load_that_is_mounted_alike_is_one(plant, arm, names) -> None:
    result = diagnose([carrying(plant, arm, CENTRES[0], seed) for seed in (13, 14)], arm)
    assert names(result) == {("payload", None)}
    assert [e.interval_s for e in result.effects] == [None]
    assert not any("differ" in line for line in result.verdict.warnings)


def test_a_held_out_recording_that_contradicts_the_fitted_one_is_told(plant, arm) -> None:
    fitted, other = (carrying(plant, arm, c, seed) for seed, c in zip((15, 16), CENTRES, strict=True))
    result = diagnose([fitted], arm, [other])
    assert any("differs from the fitted recordings from beginning to end" in line for line in result.verdict.warnings)


@pytest.fixture(scope="module")
def apart(plant, arm):
    """Held out are recordings of their own: with the second mounting, without a load, with the first."""
    fitted, held = (
        [carrying(plant, arm, c, n) for n, c in zip(ns, CENTRES, strict=True)] for ns in ((17, 18), (19, 20))
    )
    return diagnose(fitted, arm, [held[1], plant().record(21), held[0]])


def test_a_held_out_recording_carries_the_load_of_the_fitted_one_that_explains_it(apart, names) -> None:
    assert names(apart) == {("payload", None)}
    assert apart.ends_of == (1, None, 0)
    assert all(fit.nmse_named < 0.01 * max(fit.nmse_nominal, 0.05) for fit in apart.verdict.fit)


def test_the_load_that_it_carries_is_told(apart) -> None:
    assert [line for line in apart.verdict.warnings if "it carries the load of" in line] == [
        "held-out recording 1: held out, it carries the load of recording 2",
        "held-out recording 3: held out, it carries the load of recording 1",
    ]


def test_a_held_out_recording_without_a_load_carries_none(plant, arm) -> None:
    fitted = condition([carrying(plant, arm, c, n) for n, c in zip((17, 18), CENTRES, strict=True)], None)
    held = condition([carrying(plant, arm, CENTRES[1], 20), plant().record(21)], fitted.bandwidth)
    problem = pose_problem(arm, fitted, held)
    moments = dict.fromkeys(INERTIA, 0.0) | dict.fromkeys(("Ixx", "Iyy", "Izz"), 0.004)
    loads = [
        NamedEffect("payload", None, {"m": MASS, **dict(zip(("cx", "cy", "cz"), c, strict=True)), **moments}, (0, 1), n)
        for n, c in enumerate(CENTRES)
    ]
    scan = Scan((), np.ones(arm.n_dof), 1.0)
    found = with_the_same_loads(problem, loads, scan)
    assert {(p.recording, p.origin) for p in found.holdout} == {(0, 1), (1, None)}


def test_groups_are_looked_for_among_few_recordings_only(plant, arm, monkeypatch) -> None:
    fitted = condition([plant().record(22), carrying(plant, arm, CENTRES[0], 23)], None)
    problem = pose_problem(arm, fitted, condition([carrying(plant, arm, CENTRES[0], 24)], fitted.bandwidth))
    scan = Scan((), np.ones(arm.n_dof), 1.0)
    found = differing_groups(problem, scan, ())
    assert found is not None
    assert [e.recording for e in found.loads] == [1]
    monkeypatch.setattr(differing_recordings, "MANY", 1)
    assert differing_groups(problem, scan, ()) is None


def rubbing(q, v, a, body) -> np.ndarray:
    """Viscous and Coulomb friction at every joint, more than the loads weigh."""
    return 4.0 * v + 6.0 * np.tanh(v / 1e-2)


def test_groups_keep_their_loads_beside_friction_that_is_several_times_as_much(plant, arm) -> None:
    free = [plant(rubbing).record(n) for n in (40, 41)]
    loaded = [carrying(plant, arm, CENTRES[k % 2], 50 + k, rubbing) for k in range(4)]
    found = diagnose([*free, *loaded], arm)
    loads = [e for e in found.effects if e.effect == "payload"]
    assert {e.recording for e in loads} == {f"recording {k}" for k in (3, 4, 5, 6)}
    for effect in loads:
        assert effect.value("m") == pytest.approx(MASS, rel=NEAR)


def test_each_has_its_load_where_every_joint_rubs(plant, arm) -> None:
    found = diagnose([carrying(plant, arm, c, n, rubbing) for n, c in zip((22, 23), CENTRES, strict=True)], arm)
    loads = [e for e in found.effects if e.effect == "payload"]
    assert len({e.recording for e in loads}) == 2
    assert [e.value("m") for e in loads] == pytest.approx([MASS, MASS], rel=NEAR)
    assert sum("friction" in e.effect for e in found.effects) == 2 * arm.n_dof
    assert len(found.effects) == 2 * arm.n_dof + 2
    assert all(fit.nmse_named < 0.01 for fit in found.verdict.fit)


def test_of_recordings_in_groups_each_has_the_load_of_its_group(plant, arm) -> None:
    """One without a load, two with the first mounting, two with the second: none stands out from the others."""
    groups = [(n, c) for c, ns in zip(CENTRES, ((31, 32), (33, 34)), strict=True) for n in ns]
    found = diagnose([plant().record(30), *(carrying(plant, arm, c, n) for n, c in groups)], arm)
    assert {e.effect for e in found.effects} == {"payload"}
    masses = {e.recording: e.value("m") for e in found.effects}
    assert masses == {f"recording {k}": pytest.approx(MASS, rel=NEAR) for k in (2, 3, 4, 5)}
    assert all(fit.nmse_named < 0.01 for fit in found.verdict.fit)
