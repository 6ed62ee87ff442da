"""A run beside the loads by which single recordings differ."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.state import DiagnosisState
from lagnet.diagnosis.transients.detection import Scan
from lagnet.diagnosis.transients.differing_recordings import Differing, lasting_loads, without_loads
from lagnet.diagnosis.transients.separation import separate


def beside_loads(
    state: DiagnosisState, found: Differing | None, again: Callable[[Problem], DiagnosisState]
) -> DiagnosisState | None:
    """Persistent effects beside the loads of single recordings; None where there are none."""
    if found is None:
        return None
    problem = found.problem
    clean = again(without_loads(problem, found.loads))
    whole = replace(clean.problem, fit=problem.fit, holdout=problem.holdout)
    parts = separated(replace(clean, problem=whole), _usual_beside(clean, found.scan))
    return replace(parts, transients=lasting_loads(whole, parts.transients), events=())


def _usual_beside(clean: DiagnosisState, scan: Scan) -> Scan:
    """The scan with what names leave of recordings less their loads as the usual power: no load explains that."""
    return replace(scan, power=np.maximum(scan.power, clean.sigma**2))


def separated(clean: DiagnosisState, scan: Scan) -> DiagnosisState:
    """A run without the intervals of a scan, with what acts there for a while only apart from what lasts.

    Args:
        clean: the run, all samples valid again.
        scan: the intervals.
    """
    parts = separate(clean.problem, clean.refit.effects, clean.sigma, scan)
    return replace(clean, refit=parts.refit, transients=parts.transients, events=parts.unnamed)
