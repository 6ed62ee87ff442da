"""Hold a model against physics, check by check."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from lagnet.errors import LagnetError, closest
from lagnet.plausibility.calling import NotFinite
from lagnet.plausibility.check import FAIL, CheckResult
from lagnet.plausibility.checks import CHECK_NAMES, CHECKS
from lagnet.plausibility.checks.finite_output import FiniteOutput, not_finite
from lagnet.plausibility.report import PlausibilityReport
from lagnet.plausibility.settings import CheckSettings
from lagnet.plausibility.subject import Subject
from lagnet.recordings.recording import Recording


def check(
    model: Any,
    reference: Any | None = None,
    recordings: Sequence[Recording] = (),
    seed: int = 0,
    settings: CheckSettings | None = None,
    progress: Callable[[str], None] | None = None,
) -> PlausibilityReport:
    """Says whether a dynamics model can be that of a real arm, and where it cannot.

    Args:
        model: anything with the calls of lagnet.types.InverseDynamics: a Robot, a learned or corrected model, your own.
            Further calls are checked where offered: residual_torque, forward_dynamics, coriolis_matrix, kinetic_energy,
            potential_energy, inertial_parameters. A plain function goes in as a `TorqueFunction`.
        reference: a model that is believed, term by term.
        recordings: what the robot did: sets the range of motion, and is held against the description's limits.
        seed: of every random draw; the same seed gives the same report.
        settings: limits and effort.
        progress: called with the name of each check before it runs.

    Raises:
        ModelError: the model lacks a call, or a call fails.
        LagnetError: a limit or a skip names no check.
    """
    settings = settings or CheckSettings()
    refuse_unknown([*settings.limits, *settings.skip])
    subject = Subject(model, reference, tuple(recordings), settings, seed)
    results: list[CheckResult] = []
    broken: NotFinite | None = None
    for kind in CHECKS:
        if kind.name in settings.skip:
            continue
        if progress is not None:
            progress(kind.name)
        result, found = run_one(kind.name, subject)
        broken = broken or found
        results.append(result)
    return PlausibilityReport(_with_what_broke(results, broken), tuple(subject.joints))


def run_one(name: str, subject: Subject) -> tuple[CheckResult, NotFinite | None]:
    """One check, and the number that is not finite if one stopped it."""
    kind = next(kind for kind in CHECKS if kind.name == name)()
    try:
        return kind.run(subject), None
    except NotFinite as found:
        reason = f"{found.call} gives a number that is not finite"
        return kind.not_applicable(reason), found


def refuse_unknown(names: Sequence[str]) -> None:
    """Refuse names that are no check.

    Raises:
        LagnetError: with the valid names.
    """
    for name in names:
        if name not in CHECK_NAMES:
            near = closest(name, CHECK_NAMES)
            hint = f"did you mean {near}?" if near else None
            raise LagnetError(f"no check is named {name!r}", choices=CHECK_NAMES, next_step=hint)


def _with_what_broke(results: list[CheckResult], broken: NotFinite | None) -> tuple[CheckResult, ...]:
    """A number that is not finite, found by any check, fails the check meant for it."""
    if broken is None:
        return tuple(results)
    found = not_finite(broken)
    return tuple(
        replace(r, status=FAIL, value=found.value, where=dict(found.where), detail=found.detail)
        if r.name == FiniteOutput.name and r.status != FAIL
        else r
        for r in results
    )
