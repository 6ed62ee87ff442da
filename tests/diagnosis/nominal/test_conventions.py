"""Recordings whose signs, units, zeros or columns are not the model's are refused with the mapping that mends them."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest
from tests.diagnosis.posed import of_one_mass
from validation.whole_joints.plants import draw

from lagnet.cli.main import main
from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.nominal.conventions import refuse_other_conventions
from lagnet.diagnosis.problem.problem import pose_problem
from lagnet.effects.catalogue import CATALOGUE
from lagnet.errors import DiagnosisError
from lagnet.models.corrected.model import CorrectedModel, NamedEffect
from lagnet.recordings.conditioning.condition import condition
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.recording import Recording
from lagnet.recordings.writing import write_recording


def changed(
    recording: Recording, *, joint: int = 1, turn: float = 1.0, zero: float = 0.0, sense: float = 1.0
) -> Recording:
    q, tau = recording.q.copy(), recording.tau.copy()
    q[:, joint] = turn * q[:, joint] + zero
    tau[:, joint] *= sense
    return replace(recording, q=q, tau=tau)


def friction(q, v, a, body):
    return 2.0 * np.tanh(v / 1e-3) + 1.5 * v


OTHERWISE = {
    "sense of torque": ({"sense": -1.0}, ['"tau_joint_1" = -1']),
    "sense of rotation": (
        {"turn": -1.0, "sense": -1.0},
        ['"q_joint_1" = -1', '"v_joint_1" = -1', '"tau_joint_1" = -1'],
    ),
    "zero": ({"zero": np.pi / 2}, ['"q_joint_1" = -1.5708']),
    "motor side": ({"sense": 0.01}, ["by a factor: 0.0", " at joint_1; ", '"tau_joint_1" = ']),
}


@pytest.mark.parametrize("case", OTHERWISE)
def test_another_convention_is_told_with_its_mapping(case, plant, arm, at) -> None:
    change, said = OTHERWISE[case]
    real = plant(at(1, friction))
    recordings = [changed(real.record(seed), **change) for seed in (1, 2, 3)]
    with pytest.raises(DiagnosisError) as caught:
        diagnose(recordings[:2], arm, recordings[2:])
    assert all(words in str(caught.value) for words in said)
    assert "joint_0" not in str(caught.value)


def test_columns_in_another_order_are_told(plant, arm) -> None:
    recordings = [replace(r, tau=r.tau[:, [1, 0, 2]]) for r in (plant().record(seed) for seed in (1, 2, 3))]
    with pytest.raises(
        DiagnosisError, match="tau_joint_0 is the torque of joint_1, tau_joint_1 is the torque of joint_0"
    ):
        diagnose(recordings[:2], arm, recordings[2:])


@pytest.mark.parametrize("case", ["sense of rotation", "zero"])
def test_the_mapping_that_is_told_mends_it(case, plant, arm, at, tmp_path, capsys) -> None:
    change, _ = OTHERWISE[case]
    write_recording(changed(plant(at(1, friction)).record(1), **change), tmp_path / "run.csv")
    arm.write_urdf(tmp_path / "arm.urdf")
    words = [
        "diagnose",
        str(tmp_path / "run.csv"),
        "--robot",
        str(tmp_path / "arm.urdf"),
        "--out",
        str(tmp_path / "out"),
    ]
    assert main(words) == 2
    told = capsys.readouterr().err.split("--columns: ")[1]
    sections: dict[str, list[str]] = {}
    for line in told.strip().split("; "):
        section, entry = line.split(" ", 1)
        sections.setdefault(section, []).append(entry)
    (tmp_path / "map.toml").write_text("\n".join("\n".join([s, *entries]) for s, entries in sections.items()))
    mapped = load_recording(tmp_path / "run.csv", robot=arm, columns=tmp_path / "map.toml")
    problem = pose_problem(arm, *(condition([mapped], 8.0) for _ in range(2)))
    refuse_other_conventions(problem)
    np.testing.assert_allclose(mapped.q, plant(at(1, friction)).record(1).q, atol=1e-5)


def test_a_load_that_turns_the_torque_of_the_last_joint_round_is_no_convention(plant, arm) -> None:
    body = arm.inertial_parameters()[2]
    for times in (-1.5, -2.0, 12.0):
        moment = times * body[1:4]
        loaded = arm.with_payload(1.0, moment, 1e-3 * np.eye(3))
        refuse_other_conventions(pose_problem(arm, *(condition([plant(robot=loaded).record(s)], 8.0) for s in (1, 2))))


@pytest.mark.parametrize("knows", [True, False])
def test_links_of_one_mass_that_is_far_too_little_are_no_other_unit(knows, monkeypatch) -> None:
    rough = draw(3)
    assert not rough.nominal.knows_masses
    monkeypatch.setattr("lagnet.diagnosis.nominal.conventions.knows_masses", lambda _: knows)
    posed = pose_problem(rough.nominal, *(condition([rough.record(seed)], None) for seed in (1, 2)))
    with pytest.raises(DiagnosisError, match="far from the model's by a factor") if knows else nullcontext():
        refuse_other_conventions(posed)


def test_another_unit_of_an_arm_whose_links_do_have_one_mass_is_told(plant, arm) -> None:
    equal = of_one_mass(arm, 2.0)
    recordings = [plant(robot=equal).record(seed) for seed in (1, 2)]
    recordings = [replace(r, tau=100.0 * r.tau) for r in recordings]
    with pytest.raises(DiagnosisError, match="far from the model's by a factor: 100 at joint_0"):
        refuse_other_conventions(pose_problem(equal, *(condition([r], 8.0) for r in recordings)))


def test_physics_is_no_convention(plant, arm, at) -> None:
    ceiling, wall = (arm.with_gravity(np.array(g)) for g in ((0.0, 0.0, 9.81), (9.81, 0.0, 0.0)))
    heavy = arm.with_payload(5.0, np.array([0.1, 0.1, 0.2]), 0.02 * np.eye(3))
    sticky = at(0, lambda q, v, a, body: 40.0 * np.tanh(v / 1e-3))
    for real in (
        plant(),
        plant(robot=ceiling),
        plant(robot=wall),
        plant(robot=heavy),
        plant(sticky),
        plant(at(1, lambda q, v, a, body: 1.4 * body)),
        plant(at(2, lambda q, v, a, body: -0.55 * body)),
        plant(at(1, lambda q, v, a, body: 60.0 * q)),
    ):
        refuse_other_conventions(pose_problem(arm, *(condition([real.record(seed)], 8.0) for seed in (1, 2))))


@pytest.mark.parametrize("effect", CATALOGUE)
def test_a_calibrated_model_with_any_effect_is_no_convention_in_several_recordings(effect, plant, arm) -> None:
    recordings = [plant().record(seed) for seed in (1, 2)]
    posed = pose_problem(arm, *(condition(recordings, 8.0) for _ in range(2)))
    law = CATALOGUE[effect]
    values = {p.name: float(np.clip(0.02, p.lower, p.upper)) for p in law.parameters}
    model = CorrectedModel(arm, (NamedEffect(effect, None if law.whole_arm else 1, values),), posed.slow)
    for told in (None, (0.1, 12.0)):
        spell = replace(model, effects=tuple(replace(e, interval=told) for e in model.effects))
        refuse_other_conventions(pose_problem(spell, *(condition(recordings, 8.0) for _ in range(2))))
