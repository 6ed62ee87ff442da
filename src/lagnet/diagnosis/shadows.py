"""Small names that are only the shadow of what reaches all joints.

A gain of one per cent beside a payload may do no more than take back what the fit of the payload, made beside it,
overdid. Where the far-reaching names, refitted without them, leave hardly more, small ones that may be confused with
them go.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lagnet.diagnosis.arm_search import Found, noticeable, refit_found, views_of
from lagnet.diagnosis.fitting import Workbench
from lagnet.diagnosis.search import JointView

SMALL = 0.05  # of a joint's mismatch: what explains less there may be a shadow
DOUBLED = 4.0  # squared error without them over that with them, or over the noise: more is not "hardly more"


def drop_shadows(bench: Workbench, best: Found) -> Found:
    """The selection less small names at single joints that the far-reaching ones, refitted, hardly miss."""
    local = _large(bench, best) if best.far else best.local
    while local != best.local:
        plain = refit_found(bench, replace(best, local=local))
        doubled = plain.fit.sse > DOUBLED * np.maximum(best.fit.sse, best.scales.noise_power)
        worse = doubled | noticeable(bench, plain.scales, plain.fit.sse, best.fit.sse)
        if not worse.any():
            return plain
        restored = tuple(best.local[j] if bad else local[j] for j, bad in enumerate(worse))
        if restored == local:
            break
        local = restored
    return best


def _large(bench: Workbench, found: Found) -> tuple[tuple[int, ...], ...]:
    """The names at each joint that explain more than a little of it, or look like nothing that reaches all joints."""
    laws = [bench.library.hypotheses[i].law for i in found.far]

    def confused(index: int) -> bool:
        own = bench.library.hypotheses[index].law
        return any(own.name in law.confused_with or law.name in own.confused_with for law in laws)

    def kept(view: JointView, own: tuple[int, ...]) -> tuple[int, ...]:
        least = view.loss(own)[0] + SMALL * float(bench.total[view.joint][-1, -1])
        return tuple(i for i in own if not confused(i) or view.loss([k for k in own if k != i])[0] > least)

    return tuple(kept(view, own) for view, own in zip(views_of(bench, found), found.local, strict=True))
