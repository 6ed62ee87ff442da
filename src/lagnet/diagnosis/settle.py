"""The last word before parameters are refitted: what does nothing for held-out motion goes, what is canonical stays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lagnet.diagnosis.arm_search import Found, refit_found
from lagnet.diagnosis.evidence_of import HARMLESS, held_out_evidence
from lagnet.diagnosis.fitting import Workbench
from lagnet.diagnosis.search import LEAST_SHARE

ROUNDS = 20


def settle_on(bench: Workbench, unseen: Workbench, found: Found, scale: np.ndarray) -> Found:
    """Drops effects that do not help on held-out recordings, one by one, the most useless first."""
    found = prefer_plain(bench, found)
    for _ in range(ROUNDS):
        sigma = found.sigma(bench)
        parts = held_out_evidence(bench, unseen, found, scale, sigma)
        ratios = {i: p.without / max(p.with_it, 1e-300) for i, p in parts.items()}
        useless = [i for i, r in ratios.items() if r <= HARMLESS]
        if not useless:
            return found
        found = without(bench, found, min(useless, key=lambda i: ratios[i]))
    return found


def without(bench: Workbench, found: Found, index: int) -> Found:
    """The selection less one hypothesis, refitted."""
    far = tuple(i for i in found.far if i != index)
    local = tuple(tuple(i for i in own if i != index) for own in found.local)
    return refit_found(bench, replace(found, far=far, local=local))


def prefer_plain(bench: Workbench, found: Found) -> Found:
    """Tells asymmetric friction as Coulomb friction and an offset, where both say the same.

    The two are one torque while the joint moves. The pair has parameters that identification papers print, and the
    contest reports the tie.
    """
    library = bench.library
    for joint, own in enumerate(found.local):
        by_name = {library.hypotheses[i].effect: i for i in library.local[joint] if not library.hypotheses[i].shape}
        pair = tuple(by_name[n] for n in ("coulomb_friction", "torque_offset") if n in by_name)
        asymmetric = by_name.get("asymmetric_friction")
        if asymmetric not in own or len(pair) < 2 or any("torque_offset" in _names(library, i) for i in own):
            continue
        local = (*(i for i in own if i != asymmetric), *pair)
        other = refit_found(bench, replace(found, local=(*found.local[:joint], local, *found.local[joint + 1 :])))
        if other.fit.sse[joint] < (1.0 + LEAST_SHARE) * found.fit.sse[joint]:
            found = other
    return found


def _names(library, index: int) -> tuple[str, ...]:
    law = library.hypotheses[index].law
    return (law.name, *law.contains)
