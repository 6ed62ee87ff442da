"""Permutation of columns: joints in another order than the model's, such as messages that sort joints by name."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations, permutations

import numpy as np

from lagnet.diagnosis.data_quality.check import Evidence, Reading, ReadingCheck
from lagnet.diagnosis.data_quality.misfit import geometric_mean, joint_misfits, misfits_of, nuisance_terms
from lagnet.diagnosis.data_quality.samples import Samples, thinned

MOST_JOINTS = 6  # up to which all orders are tested: 720; beyond, the common ones
BEST = 3  # that are compared on many samples
FEWEST = 48  # samples on which all orders are tested
SORTED = 0.7  # prior of the alphabetical order, by far the most common

Order = tuple[int, ...]


class JointOrder(ReadingCheck):
    """Positions, speeds and torques that fit the model after a permutation of columns.

    All orders of up to six joints are tested; of more the alphabetical one, the reversed one, and exchanges one by one.
    """

    name = "joint_order"
    title = "columns are in another order than the joints"

    def readings(self, evidence: Evidence) -> Iterator[Reading]:
        joints = evidence.model.joints
        for kinds in (("q", "tau"), ("q",)):
            tried = tuple(orders(joints))
            if not tried:
                return
            best = _best(evidence, tried, kinds)
            if len(joints) > MOST_JOINTS:
                best = tuple(dict.fromkeys(self._exchanged(evidence, order, kinds) for order in best))
            for order in best:
                misfits = misfits_of(evidence.model, reordered(evidence.many, order, kinds))
                yield reading_of(self.name, joints, order, kinds, misfits)

    def _exchanged(self, evidence: Evidence, order: Order, kinds: tuple[str, ...]) -> Order:
        """The order after exchanges of two columns, each time that of least misfit, until none is better."""
        for _ in range(len(order)):
            swaps = tuple(swapped(order, i, j) for i, j in combinations(range(len(order)), 2))
            best = _best(evidence, (order, *swaps), kinds)[0]
            if best == order:
                break
            order = best
        return order


def reading_of(
    name: str, joints: tuple[str, ...], order: Order, kinds: tuple[str, ...], misfits: np.ndarray
) -> Reading:
    """A reading of the columns in another order, with the lines that map them."""
    moved = [i for i, k in enumerate(order) if i != k]
    is_sorted = order == alphabetical(joints)
    what = "alphabetical order" if is_sorted else "another order"
    columns = "positions and torques" if len(kinds) > 1 else "positions"
    listed = ", ".join(f"q_{order[i]} is {joints[i]}" for i in moved)
    mend = "; ".join(f'[columns] "{kind}_{i}" = "{kind}_{order[i]}"' for kind in ("q", "v", *kinds[1:]) for i in moved)
    return Reading(
        name,
        " ".join(kinds),
        misfits,
        f"the columns of {columns} are in {what}, not in that of the model's joints: {listed}",
        f"map them with --columns: {mend}",
        SORTED if is_sorted else 1.0,
    )


def _best(evidence: Evidence, tried: tuple[Order, ...], kinds: tuple[str, ...]) -> tuple[Order, ...]:
    """The few orders of least misfit; the motion of all orders goes through the model in one call."""
    samples = thinned(evidence.series, FEWEST)
    n, dof = samples.q.shape
    picks = np.array(tried)
    motion = (np.moveaxis(x[:, picks], 1, 0).reshape(-1, dof) for x in (samples.q, samples.v, samples.a))
    modelled = np.moveaxis(np.asarray(evidence.model.inverse_dynamics(*motion)).reshape(len(tried), n, dof), 1, 2)
    nuisance = nuisance_terms(samples.v.T, samples.a.T)[picks]
    recorded = samples.tau.T[picks] if "tau" in kinds else np.broadcast_to(samples.tau.T, modelled.shape)
    misfit = joint_misfits(recorded, modelled, nuisance)
    prior = np.array([SORTED if order == alphabetical(evidence.model.joints) else 1.0 for order in tried])
    return tuple(tried[i] for i in np.argsort(geometric_mean(misfit) * prior)[:BEST])


def alphabetical(joints: tuple[str, ...]) -> Order:
    """Column of each joint in a file that sorts joints by name."""
    names = sorted(joints)
    return tuple(names.index(name) for name in joints)


def orders(joints: tuple[str, ...]) -> Iterator[Order]:
    """The orders that are tested, without that of the model."""
    n = len(joints)
    same = tuple(range(n))
    if n <= MOST_JOINTS:
        found = permutations(range(n))
    else:
        swaps = (swapped(same, i, j) for i, j in combinations(range(n), 2))
        turned = (tuple((i + k) % n for i in range(n)) for k in range(1, n))
        found = (alphabetical(joints), same[::-1], *swaps, *turned)
    return (order for order in dict.fromkeys(found) if order != same)


def reordered(samples: Samples, order: Order, kinds: tuple[str, ...]) -> Samples:
    """The samples with column order[i] as joint i."""
    pick = list(order)
    moved = replace(samples, q=samples.q[:, pick], v=samples.v[:, pick], a=samples.a[:, pick])
    return replace(moved, tau=samples.tau[:, pick]) if "tau" in kinds else moved


def swapped(order: Order, i: int, j: int) -> Order:
    out = list(order)
    out[i], out[j] = out[j], out[i]
    return tuple(out)
