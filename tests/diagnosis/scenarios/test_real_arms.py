"""Three real arms: the lines of validation/real_arms that hold, so that they go on holding."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from scipy.signal import butter, sosfiltfilt
from tests.reports.diagnosis_report.figures import assert_figures_agree
from validation.real_arms.loaded import held_apart, lines, read_halves, unseen_errors

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.rules.value_at_bound import distance_to_bound
from lagnet.diagnosis.writing import holdout_table, write_diagnosis
from lagnet.effects.catalogue import effect_named
from lagnet.models.files.loading import load_any
from lagnet.recordings.loading.load import load_recording
from lagnet.rigid_body.inertia import is_physically_consistent
from lagnet.rigid_body.robot import load_description

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("real arms")]  # what they share is made once

TORQUE_CONSTANT = (14.87, 13.26, 11.13, 10.62, 11.03, 11.47)  # [N m/A], the authors' identification
DRY = {"coulomb_friction", "asymmetric_friction", "stribeck_friction", "presliding_hysteresis"}


def diagnosed(folder, urdf: str, fit: list[str], constants=None):
    robot = load_description(folder / urdf)
    read = [load_recording(folder / f, robot=robot, torque_constant=constants) for f in [*fit, "holdout.csv.gz"]]
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)  # of NumPy, which users would see on the terminal
        return diagnose(read[:-1], robot, read[-1:])


def nmse_at_5_hz(result) -> np.ndarray:
    table = holdout_table(result).to_pydict()
    time = np.array(table["time"])
    clock = np.arange(time[0], time[-1], np.median(np.diff(time)))
    filter_ = butter(4, 5.0, fs=1.0 / (clock[1] - clock[0]), output="sos")

    def slow(name: str) -> np.ndarray:
        return sosfiltfilt(filter_, np.interp(clock, time, np.array(table[name])))

    joints = range(len(result.verdict.joints))
    errors = [np.mean((slow(f"tau_measured_{j}") - slow(f"tau_corrected_{j}")) ** 2) for j in joints]
    return np.array([e / np.var(slow(f"tau_measured_{j}")) for j, e in enumerate(errors)])


@pytest.fixture(scope="module")
def ur10e(shared_data):
    files = [f"fit_{k}.csv.gz" for k in range(4)]
    return diagnosed(shared_data / "ur10e", "ur10e.urdf", files, TORQUE_CONSTANT)


@pytest.fixture(scope="module")
def tx40(shared_data):
    return diagnosed(shared_data / "staubli_tx40", "tx40.urdf", ["fit.csv.gz"])


@pytest.fixture(scope="module")
def emps(shared_data):
    return diagnosed(shared_data / "emps", "emps.urdf", ["fit.csv.gz"])


def named(result, joint: str) -> set[str]:
    return {e.effect for e in result.effects if e.joint == joint}


@pytest.mark.shared_data
def test_ur10e_has_friction_on_every_joint_and_no_payload(ur10e) -> None:
    for joint in ur10e.corrected.joints:
        assert "viscous_friction" in named(ur10e, joint), joint
        assert DRY & named(ur10e, joint), joint
    masses = [e.value("m") for e in ur10e.effects if e.effect == "payload"]
    assert all(abs(m) < 0.15 for m in masses)


@pytest.mark.shared_data
def test_ur10e_torque_is_predicted_on_motion_not_seen(ur10e) -> None:
    bounds = [0.010, 0.0013, 0.0013, 0.0062, 0.05]  # the second to fourth: with all but a network
    assert np.all(nmse_at_5_hz(ur10e)[:5] <= bounds)


@pytest.mark.shared_data
def test_a_load_mounted_in_two_ways_is_told_in_each_recording(ur10e, shared_data, tmp_path) -> None:
    write_diagnosis(ur10e, tmp_path)
    calibrated = load_any(tmp_path / "corrected")
    first, later = read_halves(calibrated, shared_data / "ur10e_loaded")
    result = diagnose(first, calibrated, seed=0)
    unseen, _ = unseen_errors(result, result.corrected.with_layers("named"), later)
    found = lines(result, unseen)
    assert all(found.values()), found


@pytest.mark.shared_data
def test_loads_of_all_recordings_are_named_against_a_model_that_was_never_calibrated(shared_data) -> None:
    found = held_apart(load_description(shared_data / "ur10e" / "ur10e.urdf"), shared_data / "ur10e_loaded")["lines"]
    assert all(found.values()), found


@pytest.mark.shared_data
def test_tx40_has_friction_and_rotors_on_its_uncoupled_joints(tx40) -> None:
    for joint in tx40.corrected.joints[:4]:
        assert {"viscous_friction", "rotor_inertia"} <= named(tx40, joint), joint


@pytest.mark.shared_data
def test_tx40_s_coupled_wrist_is_unexplained_and_not_misnamed(tx40) -> None:
    own = {"viscous_friction", "rotor_inertia", "torque_offset", "quadratic_drag", "coupled_transmission"} | DRY
    for left in tx40.verdict.unexplained[4:]:
        assert left.above_noise
        assert named(tx40, left.joint) <= own


@pytest.mark.shared_data
def test_emps_has_the_printed_dry_friction_and_the_right_mass(emps) -> None:
    found = {e.effect: e for e in emps.effects}
    assert {"viscous_friction", "coulomb_friction", "torque_offset"} <= set(found)
    assert found["coulomb_friction"].value("Fc") == pytest.approx(20.4, rel=0.03)
    assert not {"rotor_inertia", "link_inertia", "payload"} & set(found)


@pytest.mark.shared_data
@pytest.mark.parametrize("arm", ["ur10e", "tx40", "emps"])
def test_figures_agree_in_words_report_verdict_and_table(arm, request, tmp_path) -> None:
    assert_figures_agree(request.getfixturevalue(arm), tmp_path)


@pytest.mark.shared_data
@pytest.mark.parametrize("arm", ["ur10e", "tx40", "emps"])
def test_no_claim_rests_on_a_bound_or_on_an_open_interval(arm, request) -> None:
    result = request.getfixturevalue(arm)
    for effect in result.state.effects:
        for parameter in effect_named(effect.effect).parameters:
            assert distance_to_bound(effect, parameter)[0] > 1e-3, (effect, parameter.name)
    for effect in result.effects:
        intervals = {p.name: p.ci95 for p in effect.parameters}
        assert np.all(np.isfinite(list(intervals.values()))), effect
        assert effect_named(effect.effect).is_determined(intervals), effect  # does not hold the value of its absence


@pytest.mark.shared_data
@pytest.mark.parametrize("arm", ["ur10e", "tx40", "emps"])
def test_no_ripple_beyond_the_band_and_no_limit_that_samples_exceed(arm, request) -> None:
    result = request.getfixturevalue(arm)
    for effect in result.effects:
        joint = result.corrected.joints.index(effect.joint) if effect.joint in result.corrected.joints else None
        if effect.effect == "torque_ripple":
            speed = np.median(np.concatenate([np.abs(s.v[:, joint]) for s in result.state.fit.stretches]))
            assert effect.value("N") * speed / (2.0 * np.pi) < result.state.fit.bandwidth
        if effect.effect == "torque_saturation":
            torque = np.concatenate([np.abs(r.tau[:, joint]) for r in result.fit_recordings])
            assert np.mean(torque > 1.05 * effect.value("tau_max")) < 0.01


@pytest.mark.shared_data
@pytest.mark.parametrize("arm", ["ur10e", "tx40", "emps"])
def test_corrected_bodies_could_be_built(arm, request) -> None:
    corrected = request.getfixturevalue(arm).corrected
    before, after = corrected.nominal.inertial_parameters(), corrected.bodies().inertial_parameters()
    assert np.all(after[:, 0] < 1.1 * before[:, 0].sum()), "a link heavier than the arm"
    sound = is_physically_consistent(before)
    assert np.all(is_physically_consistent(after)[sound])


@pytest.mark.shared_data
@pytest.mark.parametrize("arm", ["ur10e", "tx40", "emps"])
def test_no_joint_is_worse_for_its_names_in_the_written_torque(arm, request) -> None:
    result = request.getfixturevalue(arm)
    table = holdout_table(result).to_pydict()
    for j, joint in enumerate(result.corrected.joints):
        measured = np.array(table[f"tau_measured_{j}"])
        nominal, corrected = (measured - np.array(table[f"tau_{kind}_{j}"]) for kind in ("nominal", "corrected"))
        assert np.mean(corrected**2) < np.mean(nominal**2), joint
        fit = result.verdict.fit[j]
        assert fit.nmse_named <= fit.nmse_nominal, joint


@pytest.mark.shared_data
@pytest.mark.parametrize("arm", ["ur10e", "tx40", "emps"])
def test_hum_is_told_once_at_most(arm, request) -> None:
    assert sum("hum" in w for w in request.getfixturevalue(arm).verdict.warnings) <= 1


@pytest.mark.shared_data
def test_no_sensor_of_a_panda_is_given_a_gain_for_links_that_differ(shared_data) -> None:
    """Five seconds of motion against a URDF whose links are not the arm's; the longer log is held out."""
    robot = load_description("panda")
    longer, shorter = (load_recording(shared_data / "panda" / f"{f}.csv.gz", robot=robot) for f in ("fit", "holdout"))
    result = diagnose([shorter], robot, [longer])
    assert "torque_gain" not in {e.effect for e in result.effects}
    assert result.state.judged is not None  # beside free links
    assert max(fit.nmse_identified for fit in result.verdict.fit) < 0.03  # with gains .15 at joint 5
