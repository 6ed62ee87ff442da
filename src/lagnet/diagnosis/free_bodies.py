"""τ_nominal + Y Δπ: names judged beside inertial parameters of all links, where no few real bodies explain the motion.

A link that is fitted alone takes over what its neighbours lack. Where several links are wrong, the fitted parameters
belong to no real body, and a real body in their place leaves far more than the noise. Friction, offsets and gains are
then judged against the nominal model with all links as the recordings determine them, and the changes of the links are
identified, not attributed to one of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, cast

import numpy as np

from lagnet.diagnosis.estimation.friction_at_rest import friction_at_rest
from lagnet.diagnosis.identified.borne_out import powers_beside
from lagnet.diagnosis.identified.fit import Identified
from lagnet.diagnosis.identified.real_inertia import columns_of, given_to_links
from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.diagnosis.problem.residuals import log_of_powers, power_of
from lagnet.diagnosis.regression.library import of_motion_alone
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.state import DiagnosisState
from lagnet.diagnosis.unexplained.remainder import Remainder, remainder_of
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.model import CorrectedModel, torque_along
from lagnet.models.corrected.motion_terms import Rest
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.rigid_body.inertia import is_physically_consistent
from lagnet.types import InverseDynamics, RobotModel, is_robot_model

FAR = 4.0  # times the mean square residual of free parameters, beyond which real bodies leave more than chance
LITTLE = 0.1  # of the nominal mean square residual that free links may leave at a joint: beyond, they are not the cause
BETTER = np.log(3.0)  # by which held-out errors of all joints together must fall: one joint's to a third
LIKE_LINKS = ("offset", "rotor")  # functions of motion that a change of links may be as well
MOST = 0.3  # of the nominal mean square residual that they may leave at a joint


def bodies_are_refuted(candidate: Candidate) -> bool:
    """Whether the selected bodies, made real, leave a joint mean r² > max(4 σ², 0.3 r²_nominal).

    σ² is the mean square residual of free parameters, or the noise.
    """
    if not any(effect_named(e.effect).is_body for e in candidate.effects):
        return False
    power, nominal = (candidate.power("fit", effects) for effects in (None, ()))
    return bool(np.any(power > np.maximum(FAR * candidate.sigma**2, MOST * nominal)))


def are_scaled_everywhere(candidate: Candidate) -> bool:
    """Whether all joints have a gain, or half of them beside a changed link, as where all links are scaled."""
    links, joints = [e for e in candidate.effects if effect_named(e.effect).changes_link], candidate.problem.n_dof
    gains = gains_among(candidate.effects)
    return joints > 1 and (gains == joints or (bool(links) and 2 * gains >= joints))


def are_scaled_widely(candidate: Candidate) -> bool:
    """Whether half of the joints or more have a gain: sensors seldom do, and links that differ may look so."""
    joints = candidate.problem.n_dof
    return joints > 1 and 2 * gains_among(candidate.effects) >= joints


def take_the_place_of_gains(beside: DiagnosisState, candidate: Candidate) -> bool:
    """Whether free links leave half of the gains or fewer, and tell more of motion that neither has seen.

    Where every joint has a gain, both are the same torque, and links, which reach all joints, need not tell more. Else
    Σ_j ln max(mean r_j², σ_j²) must fall by ln 3 on held-out motion: free links can imitate a true gain.
    """
    if 2 * gains_among(beside.effects) > gains_among(candidate.effects):
        return False
    if are_scaled_everywhere(candidate):
        return True
    at_rest = friction_at_rest(candidate.problem, candidate.effects)  # as the other run has it
    gains = remainder_of(replace(candidate.problem, held=at_rest), candidate.effects)
    return log_error(gains, candidate.noise) - log_error(beside.after, candidate.noise) > BETTER


def log_error(left: Remainder, noise: np.ndarray) -> float:
    """Σ_j ln max(mean r_j², σ_j²) on held-out motion."""
    return log_of_powers([power_of(*left.holdout, joint) for joint in range(len(noise))], noise)


def gains_among(effects: Sequence[NamedEffect]) -> int:
    """The number of torque gains."""
    return sum(e.effect == "torque_gain" for e in effects)


def beside_free_bodies(problem: Problem, noise: np.ndarray, found: Identified | None) -> Problem | None:
    """The problem with the links as the fitted recordings determine them; None where no real links explain these.

    Links that differ from one recording to the next, as under a load that is mounted anew, explain none of them.

    Args:
        problem: recordings and nominal model as given.
        noise: shape (dof,), noise floor [N m].
        found: the identified layer without names.
    """
    if not is_robot_model(problem.nominal):
        return None
    if found is None or found.layer.bodies is None:
        return None
    layer = with_all_that_links_can_have(problem, found)
    if layer.bodies is None or not explains(problem, problem.fit, (), layer, noise):
        return None
    return against_links(problem, layer.bodies)


def against_links(problem: Problem, change: np.ndarray) -> Problem | None:
    """The problem against links that differ from the given ones, shape (dof, 10); None where no matter has these."""
    robot = cast(RobotModel, problem.nominal)
    if not np.all(is_physically_consistent(robot.inertial_parameters() + change)):
        return None
    return replace(with_nominal(problem, with_changed_bodies(robot, change)), given=problem.nominal)


def with_all_that_links_can_have(problem: Problem, found: Identified) -> IdentifiedLayer:
    """The layer without offsets and rotors that are zero within their intervals beside all links."""
    weights = dict(zip(found.layer.terms, found.layer.weights, strict=True))
    open_ = [
        k
        for kind in LIKE_LINKS
        for k, term in columns_of(found.design, kind)
        if term in weights and abs(weights[term]) <= found.half_width(term)
    ]
    unknowns = np.array(open_, dtype=int)
    return given_to_links(problem, (), found.layer, found.design, found.choice, unknowns)[0]


def with_changed_bodies(model: Any, change: np.ndarray) -> Any:
    """A model whose links differ by ten parameters each, shape (dof, 10); a corrected one keeps what it corrects.

    The bodies of a corrected model are real with all its changes: one more is added to these, since the nominal
    bodies need not be real with it alone.
    """
    if not isinstance(model, CorrectedModel):
        return model.with_inertial_parameters(model.inertial_parameters() + change)
    before = model.layer or IdentifiedLayer(None, (), np.zeros(0), Rest(model.slow, np.zeros(model.n_dof)))
    layer = replace(before, bodies=change if before.bodies is None else before.bodies + change)
    return replace(model, identified=layer) if model.instead is None else replace(model, instead=layer)


def explains(
    problem: Problem,
    pieces: Sequence[Segment],
    effects: Sequence[NamedEffect],
    layer: IdentifiedLayer,
    noise: np.ndarray,
) -> bool:
    """Whether effects and an identified layer leave each joint mean r² within twice the noise or 0.1 of the nominal."""
    before, after = powers_beside(problem, pieces, effects, layer)
    floor = noise**2
    return bool(np.all((after <= FAR * floor) | (after - floor <= LITTLE * (before - floor))))


def with_nominal(problem: Problem, nominal: InverseDynamics) -> Problem:
    """The same recordings held against another nominal model."""
    if nominal is problem.nominal:
        return problem

    def posed(piece: Segment) -> Segment:
        against = replace(piece, load=torque_along(nominal, piece.time, piece.q, piece.v, piece.a))
        against.columns.update(of_motion_alone(piece.columns))
        return against

    fit, holdout = tuple(map(posed, problem.fit)), tuple(map(posed, problem.holdout))
    return replace(problem, nominal=nominal, fit=fit, holdout=holdout, known=())


def as_given(problem: Problem) -> Problem:
    """The problem against the model as it was given."""
    return problem if problem.given is None else replace(with_nominal(problem, problem.given), given=None)


def against_given(state: DiagnosisState) -> DiagnosisState:
    """The results held against the model as it was given; what remains stays that beside free links."""
    problem = state.problem
    return state if problem.given is None else replace(state, problem=as_given(problem), judged=problem)
