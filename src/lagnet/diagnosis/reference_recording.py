"""Loads beyond what one recording carries, where the links of the model differ as well: τ = Y (π + Δπ) + Y_last δ_k.

Every recording is left unexplained by links that are wrong, so that none stands out, and links as all recordings
together determine them explain none, as loads differ. The links are identified on one recording, the reference, then
on all of them without the torque by which the others differ from it: a change δ_k of the last link in recording k. What
the reference carries itself is a part of its links.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.free_bodies import against_links, with_all_that_links_can_have
from lagnet.diagnosis.identified.fit import Identified, identify
from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.diagnosis.problem.residuals import log_of_powers
from lagnet.diagnosis.transients.detection import detect_events
from lagnet.diagnosis.transients.differing_recordings import FALLS, MANY, Differing, loads_of_whole, with_origins_of
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.model import CorrectedModel
from lagnet.types import is_robot_model

ROUNDS = 2  # of links beside loads, and loads beside links
DIFFERS = 0.9  # of a recording's squared error beside shared links, that a change of its last link leaves at most
RIDGE = 1e-8  # of the largest singular value: directions of a load that the motion does not show


@dataclass(frozen=True, eq=False)
class _Reference:
    """Links of all recordings beside the loads by which they differ from one.

    Args:
        found: links and functions of motion.
        loads: by recording, change of the last link, shape (10,).
        error: Σ_j ln mean r_j² of the fitted recordings.
    """

    found: Identified
    loads: dict[int, np.ndarray]
    error: float


def beyond_one_recording(problem: Problem, noise: np.ndarray, shared: Identified | None) -> Differing | None:
    """Loads of whole recordings against the links as they are beside these; None where they explain no recording.

    Args:
        problem: recordings and nominal model as given.
        noise: shape (dof,), noise floor [N m].
        shared: links and functions of motion that all recordings share; None: none explain anything.
    """
    recordings = sorted({p.recording for p in problem.fit})
    if not is_robot_model(problem.nominal) or not 2 <= len(recordings) <= MANY:
        return None
    if not _recordings_differ(problem, noise, shared):
        return None
    tried = [one for n in recordings if (one := _referred_to(problem, n, noise)) is not None]
    best = min(tried, key=lambda one: one.error, default=None)
    if best is None:
        return None
    for _ in range(ROUNDS):
        refined = _beside(problem, best.loads, noise)
        best = refined or best
    return _differing(problem, best, noise)


def _recordings_differ(problem: Problem, noise: np.ndarray, shared: Identified | None) -> bool:
    """Whether a change of the last link explains some recording better than links that all of them share.

    Shared links stand between loads that differ: what each recording lacks is then a body on its last link.
    """
    if shared is None or shared.layer.bodies is None:
        return True
    model = _corrected(problem, shared.layer)
    for n in {p.recording for p in problem.fit}:
        residual = _residual(problem, model, n)
        _, left = _change_of_last_link(problem, n, residual)
        if _share(left, residual, noise) < DIFFERS:
            return True
    return False


def _referred_to(problem: Problem, reference: int, noise: np.ndarray) -> _Reference | None:
    """Links of one recording, and the loads of the others; None where these are no loads beyond its own."""
    others = sorted({p.recording for p in problem.fit} - {reference})
    alone = replace(problem, fit=tuple(p for p in problem.fit if p.recording == reference))
    found = identify(alone, ())
    if found is None or found.layer.bodies is None:
        return None
    return _with_loads(problem, found, others, noise)


def _beside(problem: Problem, loads: Mapping[int, np.ndarray], noise: np.ndarray) -> _Reference | None:
    """Links of all recordings without the torque of the loads, then the loads beside these links."""
    found = identify(_without(problem, loads), ())
    if found is None or found.layer.bodies is None:
        return None
    return _with_loads(problem, found, loads, noise)


def _with_loads(problem: Problem, found: Identified, others: Iterable[int], noise: np.ndarray) -> _Reference | None:
    """The loads that halve a recording's error beside the links; None where there is none, or one is no load."""
    model = _corrected(problem, found.layer)
    residuals = {n: _residual(problem, model, n) for n in sorted({p.recording for p in problem.fit})}
    loads = {}
    for n in others:
        load, left = _change_of_last_link(problem, n, residuals[n])
        if _share(left, residuals[n], noise) < FALLS:
            loads[n], residuals[n] = load, left
    if not loads or any(load[0] <= 0.0 for load in loads.values()):
        return None
    power = np.mean(np.concatenate([*residuals.values()]) ** 2, axis=0)
    return _Reference(found, loads, log_of_powers(power, noise))


def _corrected(problem: Problem, layer: IdentifiedLayer) -> CorrectedModel:
    return CorrectedModel(problem.nominal, (), problem.slow, problem.held, problem.straight, identified=layer)


def _residual(problem: Problem, model: CorrectedModel, recording: int) -> np.ndarray:
    own = [p for p in problem.fit if p.recording == recording]
    left = [problem.reduce(p, p.tau - model.torque_along(p.time, p.q, p.v, p.a)) * p.counts for p in own]
    return np.concatenate(left)


def _change_of_last_link(problem: Problem, recording: int, residual: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """δ of least squares, joints weighted by their residuals, and what it leaves."""
    own = [p for p in problem.fit if p.recording == recording]
    rows = [problem.reduce(p, _last_link(problem, p)) * p.counts[:, :, None] for p in own]
    columns = np.concatenate(rows)
    weights = 1.0 / np.sqrt(np.maximum(np.mean(residual**2, axis=0), 1e-300))
    equations = (columns * weights[None, :, None]).reshape(-1, columns.shape[2])
    change = np.linalg.lstsq(equations, (residual * weights).ravel(), rcond=RIDGE)[0]
    return change, residual - columns @ change


def _share(left: np.ndarray, residual: np.ndarray, noise: np.ndarray) -> float:
    """exp mean_j ln(mean left_j² / mean r_j²), powers at least σ_j²: the geometric mean over joints.

    A joint that does not carry the load lacks as much as before, which may be more than all others lack.
    """
    after, before = (log_of_powers(np.mean(r**2, axis=0), noise) for r in (left, residual))
    return float(np.exp((after - before) / noise.size))


def _last_link(problem: Problem, piece: Segment) -> np.ndarray:
    return piece.motion(problem).link_regressor(problem.n_dof - 1)


def _without(problem: Problem, loads: Mapping[int, np.ndarray]) -> Problem:
    """The problem less the torque of the loads, fitted recordings alone."""
    return replace(problem, fit=tuple(_less(problem, p, loads) for p in problem.fit))


def _less(problem: Problem, piece: Segment, loads: Mapping[int, np.ndarray]) -> Segment:
    if piece.recording not in loads:
        return piece
    return replace(piece, tau=piece.tau - _last_link(problem, piece) @ loads[piece.recording])


def _differing(problem: Problem, found: _Reference, noise: np.ndarray) -> Differing | None:
    """The same loads as real bodies, and the problem against the real links; None where these are none."""
    layer = with_all_that_links_can_have(_without(problem, found.loads), found.found)
    free = None if layer.bodies is None else against_links(problem, layer.bodies)
    if free is None:
        return None
    of_links = _without_functions(problem, free, layer)
    scan = detect_events(_without(of_links, found.loads), (), noise)
    loads = loads_of_whole(of_links, [*found.loads], scan)
    return None if loads is None else replace(loads, problem=with_origins_of(free, loads.problem))


def _without_functions(problem: Problem, free: Problem, layer: IdentifiedLayer) -> Problem:
    """The problem against other links, its torque less that of the layer's functions of motion."""
    model = _corrected(problem, layer)

    def less(piece: Segment) -> Segment:
        return replace(piece, tau=piece.tau - model.torque_along(piece.time, piece.q, piece.v, piece.a) + piece.load)

    return replace(free, fit=tuple(map(less, free.fit)), holdout=tuple(map(less, free.holdout)))
