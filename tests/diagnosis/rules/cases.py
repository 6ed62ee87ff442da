"""For each rule of elimination a candidate that it must reject and one that it must not."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from tests.diagnosis.posed import Posed, pose

from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.selection.arm_search import refit_selection
from lagnet.rigid_body.inertia import parameters_of_body

JOINT = 1
LEAD = 0.012  # [s] by which dry friction turns before the speed
STIFFNESS = 150.0  # [N m/rad]


@dataclass(frozen=True, eq=False)
class Bench:
    """What candidates are made with; problems are posed once and kept.

    Args:
        arm: the nominal robot.
        plant, at: of the fixtures of these names.
        known: problems already posed, by name.
    """

    arm: Any
    plant: Callable
    at: Callable
    known: dict[str, Posed]

    def posed(self, name: str, record: Callable[[int], Any]) -> Posed:
        """The problem of that name: one recording fitted, one held out."""
        if name not in self.known:
            self.known[name] = pose(self.arm, record(1), record(2))
        return self.known[name]

    def candidate(
        self, name: str, record: Callable[[int], Any], effects: Sequence[str], arm_wide: Sequence[str] = ()
    ) -> Candidate:
        """Some effects at the joint and some of the whole arm, on a problem."""
        posed = self.posed(name, record)
        return posed.candidate(posed.select({JOINT: effects}, arm_wide))

    def of(self, name: str, law: Callable, *effects: str) -> Candidate:
        """Effects at the joint, on recordings with a law there."""
        return self.candidate(name, self.plant(self.at(JOINT, law)).record, effects)


def viscous(q, v, a, tau):
    return 4.0 * v


def friction_named_rightly(b: Bench) -> Candidate:
    """Viscous friction that is there."""
    return b.of("viscous", viscous, "viscous_friction")


def friction_of_a_perfect_joint(b: Bench) -> Candidate:
    """Viscous friction where nothing is left out."""
    return b.candidate("perfect", b.plant().record, ["viscous_friction"])


def uneven(q, v, a, tau):
    return 2.0 * np.tanh(v / 0.005) + 0.7


def friction_and_offset_as_uneven_friction(b: Bench) -> Candidate:
    return b.of("uneven friction", uneven, "asymmetric_friction")


def uneven_friction_beside_a_spring(b: Bench) -> Candidate:
    def law(q, v, a, tau):
        return uneven(q, v, a, tau) + 9.0 * q

    return b.of("friction and spring", law, "asymmetric_friction", "joint_spring")


def rising_friction_as_stribeck(b: Bench) -> Candidate:
    """Friction that rises with speed: what Stribeck friction has more of at rest is nothing."""
    return b.of("rising", lambda q, v, a, t: 2.0 * np.tanh(v / 1e-3) + 1.5 * v, "stribeck_friction")


def stribeck_friction(b: Bench) -> Candidate:
    def law(q, v, a, tau):
        return (2.0 + 1.5 * np.exp(-((v / 0.2) ** 2))) * np.tanh(v / 1e-3)

    return b.of("Stribeck", law, "stribeck_friction")


def noise_as_elasticity(b: Bench) -> Candidate:
    noisy = replace(b.plant(), noise=0.05)
    return b.candidate("noise", noisy.record, ["joint_elasticity"])


def elasticity(b: Bench) -> Candidate:
    def bent(q, v, a, body):
        time = np.arange(len(q)) / 100.0
        bend = CubicSpline(time, body[:, JOINT] / STIFFNESS)
        q, v, a = q.copy(), v.copy(), a.copy()
        for table, order in ((q, 0), (v, 1), (a, 2)):
            table[:, JOINT] -= bend(time, order)
        return b.arm.inverse_dynamics(q, v, a) - body

    return b.candidate("elasticity", b.plant(bent).record, ["joint_elasticity"])


def friction_of_another_form(b: Bench) -> Candidate:
    return b.of("ripple", lambda q, v, a, t: 2.0 * v + 6.0 * np.sin(4.0 * q), "viscous_friction")


def cubic_drag_as_quadratic(b: Bench) -> Candidate:
    return b.of("cubic", lambda q, v, a, t: 5.0 * v**3, "quadratic_drag")


def quadratic_drag(b: Bench) -> Candidate:
    return b.of("quadratic", lambda q, v, a, t: 5.0 * v * np.abs(v) + 0.6 * q**2, "quadratic_drag")


def mass_in_one_point(b: Bench) -> Candidate:
    """A link that would be thousands of times as heavy in one point of its axis."""

    def heavy(q, v, a, body):
        change = 5000.0 * np.asarray(b.arm.inertial_parameters())[JOINT] * (np.arange(10) == 0)
        return b.arm.link_regressor(JOINT, q, v, a) @ change

    return b.candidate("heavy", b.plant(heavy).record, ["link_inertia"])


def link_with_its_mass_far_away(b: Bench) -> Candidate:
    """A link whose centre of mass would lie five metres off."""

    def far(q, v, a, body):
        own = np.asarray(b.arm.inertial_parameters())[JOINT]
        change = parameters_of_body(own[0], np.array([5.0, 0.0, 0.0]), 0.1 * np.eye(3)) - own
        return b.arm.link_regressor(JOINT, q, v, a) @ change

    return b.candidate("far", b.plant(far).record, ["link_inertia"])


def tool_on_a_link(b: Bench) -> Candidate:
    def tool(q, v, a, body):
        change = np.array([2.0, 0.2, 0.1, 0.0, 0.06, 0.0, 0.06, 0.0, 0.0, 0.06])
        return b.arm.link_regressor(JOINT, q, v, a) @ change

    return b.candidate("tool", b.plant(tool).record, ["link_inertia"])


def _rubbing(b: Bench, lead: float) -> Any:
    size = b.plant().usual_torque()[JOINT]
    law = b.at(JOINT, lambda q, v, a, tau: size * np.tanh((v + lead * a) / 0.05))
    return replace(b.plant(law), noise=0.001)


def early_friction_as_delay(b: Bench) -> Candidate:
    return b.candidate("early friction", _rubbing(b, LEAD).record, ["coulomb_friction", "time_delay"])


def delay_beside_friction(b: Bench) -> Candidate:
    def record(seed: int) -> Any:
        one = _rubbing(b, 0.0).record(seed)
        tau = np.array(one.tau)
        tau[:, JOINT] = CubicSpline(one.time, tau[:, JOINT])(np.maximum(one.time - 2.0 * LEAD, 0.0))
        return replace(one, tau=tau)

    return b.candidate("late", record, ["coulomb_friction", "time_delay"])


def _late(b: Bench, lag: float) -> Candidate:
    """Torque of the joint logged later by a lag [s]."""

    def record(seed: int) -> Any:
        one = b.plant().record(seed)
        tau = np.array(one.tau)
        tau[:, JOINT] = CubicSpline(one.time, tau[:, JOINT])(np.maximum(one.time - lag, 0.0))
        return replace(one, tau=tau)

    return b.candidate(f"{lag} s late", record, ["time_delay"])


def later_than_is_searched(b: Bench) -> Candidate:
    return _late(b, 0.3)


def late_by_less(b: Bench) -> Candidate:
    return _late(b, 0.1)


def gain_beside_another_law(b: Bench) -> Candidate:
    return b.of("root", lambda q, v, a, t: 6.0 * np.sign(v) * np.abs(v) ** 0.7, "viscous_friction", "torque_gain")


def gain_of_heavier_links(b: Bench) -> Candidate:
    """All links are half as heavy again."""
    heavier = b.arm.with_inertial_parameters(1.5 * np.asarray(b.arm.inertial_parameters()))
    return b.candidate("heavier", b.plant(robot=heavier).record, ["torque_gain"])


def gain_of_a_sensor(b: Bench) -> Candidate:
    return b.of("gain", lambda q, v, a, tau: 0.5 * tau, "torque_gain")


def small_friction(b: Bench) -> Candidate:
    return b.of("small", lambda q, v, a, t: 6.0 * v + 0.25 * np.tanh(v / 1e-3), "viscous_friction", "coulomb_friction")


def _at_half_a_hertz(a: np.ndarray) -> np.ndarray:
    """The part of an acceleration, at 100 Hz, that is one sinusoid of time: what a joint that is shaken follows."""
    angle = 2.0 * np.pi * 0.5 * np.arange(a.size) / 100.0
    waves = np.column_stack([np.sin(angle), np.cos(angle)])
    return waves @ np.linalg.lstsq(waves, a)[0]


def hum_as_rotor(b: Bench) -> Candidate:
    return b.of("hum", lambda q, v, a, t: 4.0 * _at_half_a_hertz(a), "rotor_inertia")


def rotor_beside_unlisted_drag(b: Bench) -> Candidate:
    return b.of("rotor and drag", lambda q, v, a, t: 2.0 * a + 3.0 * v**3, "rotor_inertia")


def _beside_a_mass(b: Bench, name: str, law: Callable, joint: int = JOINT) -> Candidate:
    """An offset at a joint, and the link behind the joint of another mass, its centre as modelled."""
    posed = b.posed(name, replace(b.plant(law), noise=0.01).record)
    found = posed.select({joint: ["torque_offset"]})
    forms = [k for k in posed.library.reaching if posed.library.hypotheses[k].place == ("link_inertia", JOINT)]
    mass = next(k for k in forms if posed.library.hypotheses[k].shape)
    found = refit_selection(posed.equations, replace(found, arm_wide=(mass,)))
    return posed.candidate(refit_selection(posed.equations, found))


def offset_of_a_shifted_centre(b: Bench, joint: int = JOINT) -> Candidate:
    """A link that is half as heavy again, its centre of mass a little off."""

    def shifted(q, v, a, body):
        own = np.asarray(b.arm.inertial_parameters())[JOINT]
        change = 0.5 * own + 0.03 * own[0] * (np.arange(10) == 1)
        return b.arm.link_regressor(JOINT, q, v, a) @ change

    return _beside_a_mass(b, "shifted", shifted, joint)


def offset_beside_a_heavier_link(b: Bench) -> Candidate:
    offset = b.at(JOINT, lambda q, v, a, tau: 3.0 + 0.0 * v)

    def heavier(q, v, a, body):
        own = np.asarray(b.arm.inertial_parameters())[JOINT]
        return b.arm.link_regressor(JOINT, q, v, a) @ (0.5 * own) + offset(q, v, a, body)

    return _beside_a_mass(b, "heavier link", heavier)


Case = Callable[[Bench], Candidate]
CASES: Mapping[str, tuple[Case, str, Case]] = {  # rule → rejected in, effect that it rejects, not rejected in
    "canonical_form": (
        friction_and_offset_as_uneven_friction,
        "asymmetric_friction",
        uneven_friction_beside_a_spring,
    ),
    "freed_link": (offset_of_a_shifted_centre, "torque_offset", offset_beside_a_heavier_link),
    "contained_law": (rising_friction_as_stribeck, "stribeck_friction", stribeck_friction),
    "no_holdout_gain": (friction_of_a_perfect_joint, "viscous_friction", friction_named_rightly),
    "negligible_torque": (friction_of_a_perfect_joint, "viscous_friction", friction_named_rightly),
    "measured_torque_leakage": (noise_as_elasticity, "joint_elasticity", elasticity),
    "lack_of_fit": (friction_of_another_form, "viscous_friction", friction_named_rightly),
    "surrogate_terms": (cubic_drag_as_quadratic, "quadratic_drag", quadratic_drag),
    "impossible_density": (mass_in_one_point, "link_inertia", tool_on_a_link),
    "distant_centre": (link_with_its_mass_far_away, "link_inertia", tool_on_a_link),
    "gain_beside_free_links": (gain_of_heavier_links, "torque_gain", gain_of_a_sensor),
    "periodic_disturbance": (hum_as_rotor, "rotor_inertia", rotor_beside_unlisted_drag),
    "reversals_only": (early_friction_as_delay, "time_delay", delay_beside_friction),
    "value_at_bound": (later_than_is_searched, "time_delay", late_by_less),
    "not_significant": (gain_beside_another_law, "torque_gain", small_friction),
}
