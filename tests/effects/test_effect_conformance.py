"""What every effect of the catalogue promises; a new entry of CATALOGUE is tested without a change here."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagnet.effects.catalogue import CATALOGUE, effect_named
from lagnet.effects.effect import STAGES, Effect
from lagnet.effects.motion import Motion
from lagnet.errors import EffectError
from lagnet.models.corrected.model import NamedEffect, torque_with

EXACT = 1e-9  # relative: rounding of one law computed in two ways
NOTHING = 1e-6  # of the torque: what an effect without size may add (an elastic joint is never infinitely stiff)
SMALL = 1e-4  # size of coefficients at which the linearised law must stand for the exact one
SLOPE = 0.05  # relative error of the linearised law at that size: curvature, and finite differences in columns

NAMES = [  # the words that stand in verdicts
    "viscous_friction",
    "coulomb_friction",
    "asymmetric_friction",
    "stribeck_friction",
    "load_dependent_friction",
    "quadratic_drag",
    "rotor_inertia",
    "payload",
    "link_inertia",
    "gravity_tilt",
    "joint_spring",
    "torque_ripple",
    "torque_gain",
    "torque_offset",
    "encoder_offset",
    "time_delay",
    "joint_elasticity",
    "backlash",
    "presliding_hysteresis",
    "contact_force",
    "saturation",
    "coupled_transmission",
]
UNIT = re.compile(r"–|(1/)?(N|kg|m|s|rad|N m|kg m)[²³]?( (m|s|rad)[²³]?)*(/(N|kg|m|s|rad)[²³]?( (m|s)[²³]?)*)?")
EFFECTS = [pytest.param(effect, id=name) for name, effect in CATALOGUE.items()]
every_effect = pytest.mark.parametrize("effect", EFFECTS)
seeds = st.integers(0, 2**31)
few = settings(max_examples=8, deadline=None)


def joints_of(effect: Effect, n_dof: int) -> list[int | None]:
    return [None] if effect.whole_arm else list(range(n_dof))


def pick_joint(effect: Effect, n_dof: int, seed: int) -> int | None:
    joints = joints_of(effect, n_dof)
    return joints[seed % len(joints)]


def coefficients_inside(effect: Effect, shape: dict, size: float, rng: np.random.Generator) -> np.ndarray:
    """Random coefficients of `columns`, of a given size or as near to it as the bounds allow."""
    lower, upper = effect.bounds(shape)
    if holds_its_coefficients(effect, shape):
        return np.array([shape[p.name] for p in effect.free_parameters])
    drawn = size * rng.uniform(0.2, 1.0, lower.size) * np.where(lower < 0, rng.choice([-1.0, 1.0], lower.size), 1.0)
    return np.clip(drawn, lower, upper)


def holds_its_coefficients(effect: Effect, shape: dict) -> bool:
    """Whether a law is made linear about the values of its coefficients, which are then no further numbers."""
    free = effect.free_parameters
    return bool(shape) and effect.free_numbers(shape) == 0 and effect.bounds(shape)[0].size == len(free)


def only_size_one(effect: Effect, shape: dict) -> bool:
    """Whether zero is no coefficient: the law is known by its shape alone, with coefficient one."""
    lower, upper = effect.bounds(shape)
    return bool(np.any(lower > 0) or np.any(upper < 0)) and not holds_its_coefficients(effect, shape)


@every_effect
def test_says_what_it_is(effect: Effect) -> None:
    assert CATALOGUE[effect.name] is effect
    assert effect.name in NAMES
    assert type(effect).__module__.rsplit(".", 1)[1] == effect.name
    assert type(effect).__name__ == "".join(word.capitalize() for word in effect.name.split("_"))
    for text in (effect.title, effect.formula, effect.shown_by, type(effect).__doc__ or ""):
        assert text.strip()
    assert effect.title[0].isupper()
    assert re.fullmatch(r"[a-z]+\d{4}", effect.source)
    assert effect.stage in STAGES


@every_effect
def test_names_its_relatives_by_names_of_the_catalogue(effect: Effect) -> None:
    assert set(effect.confused_with) <= set(NAMES) - {effect.name}
    assert set(effect.contains) <= set(NAMES) - {effect.name}


@every_effect
def test_parameters_are_documented(effect: Effect) -> None:
    names = [p.name for p in effect.parameters]
    assert names
    former = [p.formerly for p in effect.parameters if p.formerly]
    assert len({*names, *former}) == len(names) + len(former)
    for parameter in effect.parameters:
        assert parameter.symbol
        assert parameter.meaning
        assert UNIT.fullmatch(parameter.unit), parameter.unit
        assert parameter.lower < parameter.upper
        assert "rad" not in parameter.unit_for(prismatic=True)
        assert "N m" not in parameter.unit_for(prismatic=True)


@every_effect
@given(seed=seeds)
@few
def test_columns_are_finite_and_of_the_right_shape(effect: Effect, ur5, sweep, shapes_of, seed: int) -> None:
    joint = pick_joint(effect, ur5.n_dof, seed)
    motion, shapes = shapes_of(effect, sweep(ur5, seed).motion, joint)
    for shape in shapes:
        columns = effect.columns(motion, joint, shape)
        lower, upper = effect.bounds(shape)
        reach = (ur5.n_dof,) if effect.reaches_all else ()
        assert columns.shape == (motion.time.size, *reach, lower.size)
        assert np.isfinite(columns).all()
        assert upper.shape == lower.shape
        assert np.all(lower <= upper)


@every_effect
def test_a_special_case_is_a_shape_of_the_same_law_and_has_none_itself(effect: Effect, ur5, sweep, shapes_of) -> None:
    _, shapes = shapes_of(effect, sweep(ur5, 1).motion, pick_joint(effect, ur5.n_dof, 1))
    for shape in shapes:
        case = effect.special_case(shape)
        assert case is None or case.keys() == shape.keys()
        assert case is None or effect.special_case(case) is None


@every_effect
def test_what_is_never_negative_may_be_absent(effect: Effect, ur5, sweep, shapes_of) -> None:
    _, shapes = shapes_of(effect, sweep(ur5, 1).motion, pick_joint(effect, ur5.n_dof, 1))
    assert not effect.nonnegative or all(np.all(effect.bounds(shape)[0] == 0.0) for shape in shapes)


@every_effect
def test_some_motion_has_shapes(effect: Effect, ur5, sweep, shapes_of) -> None:
    found = [shapes_of(effect, sweep(ur5, seed).motion, pick_joint(effect, 6, seed))[1] for seed in range(6)]
    assert any(found)


@every_effect
@given(seed=seeds)
@few
def test_columns_times_coefficients_are_the_torque_to_first_order(effect, ur5, sweep, shapes_of, seed: int) -> None:
    rng = np.random.default_rng(seed)
    joint = pick_joint(effect, ur5.n_dof, seed)
    motion, shapes = shapes_of(effect, sweep(ur5, seed).motion, joint)
    for shape in shapes[:3]:
        alone = only_size_one(effect, shape)
        size = 1.0 if alone else SMALL
        coefficients = np.ones(1) if alone else coefficients_inside(effect, shape, size, rng)
        linear = effect.columns(motion, joint, shape) @ coefficients
        exact = effect.torque(motion, joint, effect.values(coefficients, shape))
        assert exact.shape == linear.shape
        inside = slice(5, -5) if not effect.instantaneous else slice(None)  # one-sided differences at the ends
        error = np.sqrt(np.mean((linear - exact)[inside] ** 2))
        usual = np.sqrt(np.mean(exact[inside] ** 2))
        assert error <= SLOPE * usual + EXACT * size


@every_effect
@given(seed=seeds)
@few
def test_values_and_coordinates_round_trip(effect: Effect, ur5, sweep, shapes_of, seed: int) -> None:
    rng = np.random.default_rng(seed)
    joint = pick_joint(effect, ur5.n_dof, seed)
    motion, shapes = shapes_of(effect, sweep(ur5, seed).motion, joint)
    for shape in shapes[:3]:
        coefficients = coefficients_inside(effect, shape, 0.3, rng)
        values = effect.values(coefficients, shape)
        assert list(values) == [p.name for p in effect.parameters]
        assert all(type(x) is float and np.isfinite(x) for x in values.values())
        assert set(effect.settled) <= set(values)
        back = effect.moved(values, effect.coordinates(values))
        assert back == pytest.approx(values, rel=1e-7, abs=1e-10)
        again = effect.torque(motion, joint, back) - effect.torque(motion, joint, values)
        assert np.abs(again).max() <= 1e-7 * max(1.0, np.abs(motion.load).max())


@every_effect
@given(seed=seeds)
@few
def test_bounds_agree_with_one_another(effect: Effect, ur5, sweep, shapes_of, seed: int) -> None:
    rng = np.random.default_rng(seed)
    joint = pick_joint(effect, ur5.n_dof, seed)
    _, shapes = shapes_of(effect, sweep(ur5, seed).motion, joint)
    for shape in shapes[:3]:
        values = effect.values(coefficients_inside(effect, shape, 0.2, rng), shape)
        lower, upper = effect.coordinate_bounds(values)
        assert lower.shape == upper.shape
        assert np.all(lower < upper)
        coordinates = effect.coordinates(values)
        assert coordinates.shape == lower.shape
        assert np.all(coordinates >= lower)
        assert np.all(coordinates <= upper)
        assert all(p.lower <= values[p.name] <= p.upper for p in effect.parameters)


@every_effect
def test_says_whether_it_follows_the_load_of_its_joint(effect: Effect, ur5, sweep, shapes_of) -> None:
    """After the bodies: the load of other joints never matters, that of its own only where the effect says so."""
    if effect.stage == "body":
        return
    rng, joint = np.random.default_rng(3), pick_joint(effect, ur5.n_dof, 2)
    motion, shapes = shapes_of(effect, sweep(ur5, 3).motion, joint)
    motion = replace(motion, recorded=None)
    values = effect.values(coefficients_inside(effect, shapes[0], 0.3, rng), shapes[0])
    other = np.arange(motion.n_dof) != joint
    kick = rng.normal(0.0, motion.load.std(), motion.load.shape)
    before = effect.torque(motion, joint, values)
    np.testing.assert_array_equal(effect.torque(motion.with_load(motion.load + kick * other), joint, values), before)
    moved = effect.torque(motion.with_load(motion.load + kick * ~other), joint, values)
    assert effect.uses_load == bool(np.any(moved != before))


@every_effect
@given(seed=seeds)
@few
def test_an_effect_without_size_adds_nothing(effect: Effect, ur5, sweep, shapes_of, seed: int) -> None:
    joint = pick_joint(effect, ur5.n_dof, seed)
    motion, shapes = shapes_of(effect, sweep(ur5, seed).motion, joint)
    for shape in shapes[:3]:
        if only_size_one(effect, shape):  # a limit above every torque, or a gap that is none
            beyond = 0.0 if effect.absent is None else 10.0 * float(np.abs(motion.load).max())
            values = {p.name: beyond for p in effect.parameters}
        else:
            values = effect.values(np.zeros(effect.bounds(shape)[0].size), shape)
        torque = effect.torque(motion, joint, values)
        assert np.abs(torque).max() <= NOTHING * np.abs(motion.load).max()


FRICTION = [e for e in CATALOGUE.values() if e.name.endswith("_friction") or e.name in ("quadratic_drag",)]


@pytest.mark.parametrize("effect", [pytest.param(e, id=e.name) for e in FRICTION])
@given(seed=seeds, size=st.floats(0.01, 50.0))
@few
def test_friction_takes_energy_at_every_instant(effect: Effect, ur5, sweep, seed: int, size: float) -> None:
    rng = np.random.default_rng(seed)
    joint, motion = seed % 6, sweep(ur5, seed).motion
    for shape in effect.shapes(motion, joint):
        coefficients = coefficients_inside(effect, dict(shape), size, rng)
        torque = effect.torque(motion, joint, effect.values(coefficients, shape))
        assert np.min(torque * motion.v[:, joint]) >= 0.0


@given(seed=seeds)
@few
def test_bristles_never_give_more_energy_than_they_took(ur5, sweep, seed: int) -> None:
    law, motion, joint = CATALOGUE["presliding_hysteresis"], sweep(ur5, seed).motion, seed % 6
    for shape in law.shapes(motion, joint):
        torque = law.torque(motion, joint, law.values(np.array([3.0]), shape))
        steps = np.diff(motion.q[:, joint])
        work = np.cumsum(torque[1:] * steps)  # the end of a step has bent further than its middle
        assert work.min() >= 0.0 or work.min() >= -1e-2 * np.abs(work).max()


WITH_BODIES = ("gravity_tilt", "encoder_offset")  # weigh changed bodies anew: those products are tested with the models


@given(seed=seeds)
@few
def test_effects_of_one_stage_add_up(ur5, sweep, shapes_of, seed: int) -> None:
    rng, motion = np.random.default_rng(seed), sweep(ur5, seed).motion
    named: list[NamedEffect] = []
    for effect in CATALOGUE.values():
        joint = pick_joint(effect, ur5.n_dof, int(rng.integers(100)))
        _, shapes = shapes_of(effect, motion, joint)
        if shapes:
            values = effect.values(coefficients_inside(effect, shapes[0], 0.01, rng), shapes[0])
            named.append(NamedEffect(effect.name, joint, values))
    for stage in ("body", "transmission", "torque"):
        group = [e for e in named if effect_named(e.effect).stage == stage and e.effect not in WITH_BODIES]
        together = torque_with(motion, group) - motion.load
        apart = sum((torque_with(motion, [e]) - motion.load for e in group), np.zeros_like(motion.load))
        np.testing.assert_allclose(together, apart, rtol=0, atol=1e-9 * np.abs(together).max())


def test_a_gain_multiplies_what_friction_added(ur5, sweep) -> None:
    motion = sweep(ur5, 5).motion
    gain = NamedEffect("torque_gain", 2, {"g": 1.2})
    friction = NamedEffect("viscous_friction", 2, {"Fv": 3.0})
    offset = NamedEffect("torque_offset", 2, {"b": 4.0})
    expected = motion.load.copy()
    expected[:, 2] = 1.2 * (motion.load[:, 2] + 3.0 * motion.v[:, 2]) + 4.0
    np.testing.assert_allclose(torque_with(motion, [gain, offset, friction]), expected, rtol=1e-12)


def at_rest(model, n: int = 300) -> Motion:
    q = np.tile(np.linspace(-0.4, 0.9, model.n_dof), (n, 1))
    zero = np.zeros_like(q)
    load = model.inverse_dynamics(q, zero, zero)
    return Motion(np.arange(n) / 100.0, q, zero, zero, load, np.full(model.n_dof, 0.01), model, recorded=load)


@every_effect
def test_an_arm_at_rest_shows_nothing_and_says_why(effect: Effect, ur5) -> None:
    motion = at_rest(ur5)
    for joint in joints_of(effect, ur5.n_dof):
        reason = effect.excitation(motion, joint)
        assert isinstance(reason, str)
        assert len(reason) > 10


@every_effect
def test_a_rich_motion_shows_it_somewhere(effect: Effect, ur5, sweep) -> None:
    motion = sweep(ur5, 11).motion
    reasons = [effect.excitation(motion, joint) for joint in joints_of(effect, ur5.n_dof)]
    assert None in reasons, reasons


@every_effect
def test_a_model_without_bodies_will_do_where_none_are_needed(effect: Effect, springs, sweep, shapes_of) -> None:
    joint = None if effect.whole_arm else 1
    motion, shapes = shapes_of(effect, sweep(springs, 4).motion, joint)
    for shape in shapes[:2]:
        if effect.needs_bodies:
            with pytest.raises(AttributeError):
                effect.columns(motion, joint, shape)
            continue
        columns = effect.columns(motion, joint, shape)
        values = effect.values(coefficients_inside(effect, shape, 0.1, np.random.default_rng(3)), shape)
        assert np.isfinite(columns).all()
        assert np.isfinite(effect.torque(motion, joint, values)).all()


def test_an_unknown_name_is_refused_with_the_nearest_one() -> None:
    with pytest.raises(EffectError, match="viscous_friction") as caught:
        effect_named("viscus_friction")
    assert "did you mean viscous_friction" in str(caught.value)


def test_a_corrected_model_refuses_missing_parameters(ur5) -> None:
    from lagnet.models.corrected.model import CorrectedModel

    with pytest.raises(EffectError, match="q0"):
        CorrectedModel(ur5, (NamedEffect("joint_spring", 1, {"k": 3.0}),), np.ones(6))
