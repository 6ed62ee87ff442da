"""A servo that logs commands alone: its friction is followed from recording to recording, and told where it grows."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import timedelta
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from tests.diagnosis.motion import pendulum
from tests.tracking.fleets import START

from lagnet.errors import EffectError, LagnetError
from lagnet.models.files.loading import load_any
from lagnet.recordings.writing import write_recording
from lagnet.servos.parameters import INDEX
from lagnet.tracking.engine import EngineSettings
from lagnet.tracking.growth import grown
from lagnet.tracking.manifest import Make, TrackedRecording, TrackSettings
from lagnet.tracking.servos.fit import fit_servos, owner_of
from lagnet.tracking.servos.judgement import WIDER, why_not_determined, why_not_shown
from lagnet.tracking.servos.new_physics import again_and_again, candidates_of, with_candidates, with_new_payload
from lagnet.tracking.servos.tracked import common_followed, followed_from_plain
from lagnet.tracking.servos.work import calibrated_servos, on_motion
from lagnet.tracking.statistics.followed_law import lower_bound, stage_of
from lagnet.tracking.track import track
from lagnet.tracking.work import Work, fit_one

pytestmark = [
    pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::DeprecationWarning"),
    pytest.mark.xdist_group("servo track"),
]
MANIFEST = """[settings]
reports = false
search = "unusual"
[[make]]
name = "servo"
robot = "../pendulum.xml"
calibration = "calibration.csv"
[[robot]]
name = "one"
[[robot.recordings]]
files = "2*.csv"
date_in_name = "%Y-%m-%d"
temperature = 25
"""
DRY, WORN = 0.15, 0.22  # [N m] friction before and after; nominal 0.02


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> SimpleNamespace:
    """The nominal servo, and what a healthy one showed on a minute of motion."""
    folder = tmp_path_factory.mktemp("servo")
    nominal = pendulum.write_model(folder / "pendulum.xml")
    healthy = pendulum.write_model(folder / "healthy.xml", friction=DRY)
    worn = pendulum.write_model(folder / "worn.xml", friction=WORN)
    robot = load_any(str(nominal))
    first = pendulum.record(healthy, 60.0, seed=0)
    found, tracked = calibrated_servos([first], robot, Make("servo", str(nominal)), [1.0], 0)
    return SimpleNamespace(
        folder=folder, robot=robot, healthy=healthy, worn=worn, found=found, set=tracked, first=first
    )


def friction(bench: SimpleNamespace, model: Path, seed: int):
    rows = fit_servos(pendulum.record(model, 20.0, seed=seed), bench.robot, bench.set).rows
    return next(row for row in rows if row.effect == "coulomb_friction")


def test_the_set_is_what_the_calibration_named(bench):
    assert [e.effect for e in bench.found.effects] == ["coulomb_friction"]
    assert bench.set.servos[0].effects == ("coulomb_friction",)
    assert followed_from_plain(json.loads(json.dumps(bench.set.plain()))) == bench.set


@pytest.mark.parametrize(("worn", "true"), [(False, DRY), (True, WORN)])
def test_friction_of_a_later_recording_is_recovered_with_its_interval(bench, worn, true):
    found = friction(bench, bench.worn if worn else bench.healthy, seed=5)
    assert (found.parameter, found.unit) == ("Fc/kp", "rad")  # a balanced load does not tell the scale of torques
    assert found.value == pytest.approx(true / pendulum.NOMINAL["kp"], rel=0.03)
    assert found.lower <= true / pendulum.NOMINAL["kp"] <= found.upper


def test_a_gain_of_the_controller_is_taken_into_account(bench):
    twice = pendulum.write_model(bench.folder / "twice.xml", friction=DRY, kp=16.0, kv=0.4)
    recording = pendulum.record(twice, 20.0, seed=7)
    told, silent = (fit_servos(recording, bench.robot, bench.set, gain) for gain in (2.0, 1.0))
    assert told.left[0] < 0.5 * silent.left[0]


def test_a_worn_servo_is_unusual_beside_the_fixed_laws(bench):
    assert not bench.set.is_unusual(np.array(bench.set.left))
    assert bench.set.is_unusual(2.0 * np.array(bench.set.left))


@pytest.mark.slow
def test_a_growing_friction_is_told_from_the_recording_on_that_shows_it(bench, scheduler):
    folder = bench.folder / "fleet"
    write_recording(bench.first, folder / "calibration.csv")
    for week in range(8):
        recording = pendulum.record(bench.worn if week >= 4 else bench.healthy, 20.0, seed=20 + week)
        write_recording(recording, folder / f"{START + timedelta(days=7 * week):%Y-%m-%d}.csv")
    (folder / "fleet.toml").write_text(MANIFEST)
    found = track(folder / "fleet.toml", folder / "out", EngineSettings(scheduler=scheduler))
    assert not found.failed
    assert [(e.effect, e.joint, e.kind) for e in found.analysis.events] == [("coulomb_friction", "servo", "step")]
    assert found.analysis.events[0].date == START + timedelta(days=28)


@pytest.mark.slow
def test_a_fault_that_the_calibration_did_not_show_is_followed_from_its_first_recording_on(bench, scheduler):
    folder = bench.folder / "delayed"
    write_recording(bench.first, folder / "calibration.csv")
    for week in range(8):
        late = {"delay": 40} if week >= 3 else {}
        write_recording(
            pendulum.record(bench.healthy, 20.0, seed=40 + week, **late),
            folder / f"{START + timedelta(days=7 * week):%Y-%m-%d}.csv",
        )
    (folder / "fleet.toml").write_text(MANIFEST)
    found = track(folder / "fleet.toml", folder / "out", EngineSettings(scheduler=scheduler))
    assert [(e.effect, e.joint, e.date) for e in found.analysis.events] == [
        ("command_delay", "servo", START + timedelta(days=21))
    ]
    delays = [row.value for row in found.rows if row.effect == "command_delay"]
    assert delays == pytest.approx([0.0] * 3 + [0.04] * 5, abs=0.003)


def on_trial(bench: SimpleNamespace, known, effect: str, values: dict[str, float], model: Path, weeks: int = 3):
    """What becomes of an effect that searches named beyond a set, and the titles of the fits."""
    folder = bench.folder / f"trial of {effect}"
    make, tasks, titles = Make("servo", str(bench.folder / "pendulum.xml")), [], []
    for week in range(weeks):
        file, date = folder / f"{week}.csv", START + timedelta(days=7 * week)
        write_recording(pendulum.record(model, 20.0, seed=60 + week), file)
        recording = TrackedRecording("one", "servo", str(file), date)
        tasks.append(Work(recording, make, known, TrackSettings(reports=False), folder / "diagnoses" / f"{week}"))
    new = [{"effect": effect, "joint": 0, "values": values, "body": ()}]
    told = [{"rows": [], "joints": ["servo"], "new": new} for _ in tasks]

    def fit(title, work):
        titles.append(title)
        return [fit_one(task) for task in work]

    return (*grown(tasks, told, folder, fit), titles)


def test_an_effect_that_no_recording_tells_from_what_is_followed_does_not_join(bench):
    damped = pendulum.write_model(bench.folder / "damped.xml", friction=DRY, damping=0.4)
    servo = bench.set.servos[0]
    known = replace(bench.set, servos=(replace(servo, free=(*servo.free, ("viscous",))),))
    told, left, titles = on_trial(bench, known, "gain_error", {"kp": servo.law[INDEX["kp"]], "kd": 0.6}, damped)
    assert [(n.joint, n.effect, n.named, n.recordings) for n in left] == [("servo", "gain_error", 3, 3)]
    assert "do not tell it from what is followed" in left[0].reason or "its absence in 0 of the 3" in left[0].reason
    assert titles[-1] != "fits with new physics"
    assert all(not result["rows"] for result in told)  # as they were


def test_an_effect_of_which_the_recordings_show_nothing_does_not_join(bench):
    told, left, _ = on_trial(bench, bench.set, "command_delay", {"T": 0.02}, bench.healthy)
    assert [n.effect for n in left] == ["command_delay"]
    assert "excludes its absence in 0 of the 3" in left[0].reason
    assert all(not result["rows"] for result in told)


def fit_of(value: float, half: float, wider: float | None) -> dict:
    told = {"joint": 0, "effect": "command_delay", "values": {"delay": value}, "halves": {"delay": half}}
    return {"rows": [], "determined": [told | {"wider": wider}]}


def test_an_effect_joins_where_four_of_five_recordings_determine_it(bench):
    rows = [[{"effect": "command_delay", "joint": 0, "values": {"T": 0.02}}]] * 2
    one = candidates_of(bench.set, rows)[0]
    shown, absent = fit_of(0.021, 0.004, WIDER), fit_of(0.0, 0.004, 1.0)
    wide, trading, blind = fit_of(0.0, 0.03, 1.0), fit_of(0.02, 0.004, 1.01 * WIDER), fit_of(0.02, 0.0, None)
    still = {"rows": [], "determined": []}  # the joint does not move
    assert why_not_shown(one, [shown, shown]) is None
    assert "in 1 of the 2" in str(why_not_shown(one, [shown, absent]))
    assert why_not_determined(one, [shown, *[absent] * 3, wide]) is None
    assert why_not_determined(one, [shown, absent, {"error": "not read"}]) is None
    assert "2 of 5 recordings do not tell it" in str(why_not_determined(one, [*[shown] * 3, trading, blind]))
    assert "2 of 5 recordings would not show it" in str(why_not_determined(one, [*[absent] * 3, wide, still]))


def test_names_that_are_told_once_or_mean_what_is_followed_stay_outside(bench):
    delay = {"effect": "command_delay", "joint": 0, "values": {"T": 0.02}}
    rub = {"effect": "static_friction", "joint": 0, "values": {"Fs": 0.02}}
    assert again_and_again(candidates_of(bench.set, [[delay], [], []]), 3) == []
    twice = candidates_of(bench.set, [[delay], [], [delay | {"values": {"T": 0.03}}]])
    assert [(c.named, c.values) for c in again_and_again(twice, 3)] == [((0, 2), {"T": 0.025})]
    larger = with_candidates(bench.set, [*twice, *candidates_of(bench.set, [[rub]])])
    assert larger.servos[0].effects == ("coulomb_friction", "command_delay")
    assert ("delay",) in larger.servos[0].free
    assert [(a.effect, a.groups) for a in larger.added] == [("command_delay", (("delay",),)), ("static_friction", ())]
    assert larger.laws[0, INDEX["delay"]] == 0.025
    assert followed_from_plain(json.loads(json.dumps(larger.plain()))) == larger


def test_a_payload_is_followed_by_its_share(bench):
    body = 0.5 * bench.robot.inertial_parameters()[-1]
    loaded = replace(bench.set, body=tuple(map(float, body)))
    heavier = pendulum.write_model(bench.folder / "heavier.xml", friction=DRY, mass=0.75)
    for model, share in ((bench.healthy, 0.0), (heavier, 1.0)):
        fit = fit_servos(pendulum.record(model, 20.0, seed=9), bench.robot, loaded)
        row = next(r for r in fit.rows if r.effect == "payload")
        assert (row.joint, row.parameter) == (None, "share")
        assert row.value == pytest.approx(share, abs=0.1)
        assert row.upper - row.lower < 0.3
    assert followed_from_plain(json.loads(json.dumps(loaded.plain()))) == loaded


def test_a_payload_that_is_found_again_and_again_is_followed(bench):
    found = [{"effect": "payload", "body": [m, *[0.0] * 9]} for m in (0.1, 0.3, 0.2)]
    larger = with_new_payload(bench.set, [[e] for e in found])
    assert larger.body[0] == 0.2
    assert with_new_payload(bench.set, [[found[0]], [], []]) is bench.set


def test_robots_without_calibration_share_what_half_of_them_show(bench):
    plain = replace(bench.set, servos=(replace(bench.set.servos[0], effects=(), free=()),))
    common = common_followed([bench.set, bench.set, plain], "servo")
    assert common.servos[0].free == bench.set.servos[0].free
    assert common_followed([bench.set, plain, plain], "servo").servos[0].free == ()
    loaded = [replace(bench.set, body=(m, x, *[0.0] * 8)) for m, x in ((0.1, 0.3), (0.2, 0.1), (0.3, 0.2))]
    assert common_followed(loaded, "servo").body == loaded[1].body  # mass and centre of one robot
    assert common_followed([loaded[0], plain, plain], "servo").body == ()


def test_recordings_of_two_kinds_are_told(bench):
    torque = replace(bench.first, tau=np.zeros_like(bench.first.q), path="other.csv")
    assert on_motion([bench.first])
    with pytest.raises(LagnetError, match=r"other\.csv: holds torque, where"):
        on_motion([bench.first, torque])


def test_laws_of_both_catalogues_are_known():
    owners = (owner_of("viscous", ()), owner_of("coulomb", ("stribeck_friction",)), owner_of("stiffness", ()))
    expected = [("viscous_friction", "Fv"), ("stribeck_friction", "Fc"), ("joint_elasticity", "K")]
    assert [(o[0], o[1].name) for o in owners if o] == expected
    assert owner_of("voltage_share", ()) is None
    assert [stage_of(e) for e in ("payload", "static_friction", "dead_band")] == ["body", "torque", "signal"]
    assert lower_bound("static_friction", "Fs/kp") == 0.0
    assert lower_bound("torque_offset", "b") == -np.inf
    with pytest.raises(EffectError, match="unknown effect 'wear'"):
        stage_of("wear")
