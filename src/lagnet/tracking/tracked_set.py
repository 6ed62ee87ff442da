"""The physics that is followed over time: the same set of parameters in every recording of a make.

A search names what its recording shows, and near its limit another name in each of two recordings of one arm. To follow
a parameter, the set is therefore fixed beforehand, by the calibration or by the first recordings, and every recording
is fitted with all of it. The search serves to notice what the set does not hold.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import NamedEffect

HELD = ("link_inertia",)  # bodies of the arm itself do not change from day to day: they stay as calibrated
SHARE = 0.5  # of the robots of a make whose first recording must show an effect that is followed
SUPPORT = 2  # recordings of a robot in which new physics must be named before it is followed there
UNUSUAL = 1.5  # times the residual of the calibration from which a recording is searched for more
RIVALRY = 0.5  # of the recordings that name the most frequent new effect, below which another is taken for its misnomer

Place = tuple[str, int | None]


@dataclass(frozen=True)
class TrackedSet:
    """What is fitted to each recording of a make or robot.

    Args:
        effects: whose parameters are followed, with values from which to start.
        held: effects of the calibrated model that keep their values.
        slow: for each joint, ε of s(v) [rad/s].
        straight: for each joint, whether s(v) rises in a straight line; None: nowhere.
        rest: for each joint, share of the dry friction that stays at rest; None: none.
        bandwidth: of the low-pass on torques [Hz].
        nominal_sha256: checksum of the nominal model.
        left: for each joint, residual of the set where it was found, root mean square [N m]; empty: not known.
    """

    effects: tuple[NamedEffect, ...]
    held: tuple[NamedEffect, ...]
    slow: tuple[float, ...]
    straight: tuple[bool, ...] | None
    rest: tuple[float, ...] | None
    bandwidth: float
    nominal_sha256: str = ""
    left: tuple[float, ...] = ()

    def is_unusual(self, left: np.ndarray) -> bool:
        """Whether a residual is clearly larger than where the set was found, at any joint; True if it is not known."""
        return not self.left or bool(np.any(left > UNUSUAL * np.array(self.left)))

    @property
    def places(self) -> tuple[Place, ...]:
        """Effect and joint of each that is followed."""
        return tuple((e.effect, e.joint) for e in self.effects)

    def with_new(self, effects: Iterable[NamedEffect]) -> TrackedSet:
        """The set with further effects."""
        return replace(self, effects=(*self.effects, *effects))

    def plain(self) -> dict[str, Any]:
        """Plain values, for files and checksums."""
        return asdict(self)


def set_from_plain(plain: Mapping[str, Any]) -> TrackedSet:
    """Inverse of `TrackedSet.plain` after a way through JSON."""

    def row(name: str, kind: type) -> tuple[Any, ...] | None:
        return None if plain[name] is None else tuple(kind(x) for x in plain[name])

    effects, held = (tuple(effect_from_plain(e) for e in plain[name]) for name in ("effects", "held"))
    slow = tuple(map(float, plain["slow"]))
    known = (row("straight", bool), row("rest", float), float(plain["bandwidth"]), str(plain["nominal_sha256"]))
    left = tuple(map(float, plain["left"]))
    return TrackedSet(effects, held, slow, *known, left)


def effect_from_plain(plain: Mapping[str, Any]) -> NamedEffect:
    """An effect without an interval, from plain values."""
    law, joint = effect_named(str(plain["effect"])), plain["joint"]
    held = law.with_names_of_today(plain["values"])
    values = {p.name: float(held[p.name]) for p in law.parameters}
    return NamedEffect(law.name, None if joint is None else int(joint), values)


def lasting(effects: Sequence[NamedEffect]) -> tuple[NamedEffect, ...]:
    """Effects that act all the time and in every recording."""
    return tuple(e for e in effects if e.interval is None and e.recording is None)


def set_of_calibration(model: Any, bandwidth: float) -> TrackedSet:
    """The set that a calibration named.

    Args:
        model: its corrected model.
        bandwidth: at which it was fitted [Hz].
    """
    effects = lasting(model.effects)
    return TrackedSet(
        tuple(e for e in effects if e.effect not in HELD),
        tuple(e for e in effects if e.effect in HELD),
        tuple(map(float, model.slow)),
        None if model.straight is None else tuple(map(bool, model.straight)),
        None if model.held is None else tuple(map(float, model.held)),
        float(bandwidth),
        str(getattr(model.nominal, "sha256", "")),
    )


def common_set(sets: Sequence[TrackedSet]) -> TrackedSet:
    """What at least half of the robots of a make show, with the medians of their values."""
    counts = Counter(place for s in sets for place in s.places)
    kept = sorted(
        (p for p, n in counts.items() if n >= SHARE * len(sets)), key=lambda p: (p[0], -1 if p[1] is None else p[1])
    )
    effects = tuple(_median([e for s in sets for e in s.effects if (e.effect, e.joint) == place]) for place in kept)
    slow = np.median([s.slow for s in sets], axis=0)
    straight = np.mean([s.straight or [False] * slow.size for s in sets], axis=0) > 0.5
    rest = np.median([s.rest or [0.0] * slow.size for s in sets], axis=0)
    return TrackedSet(
        effects,
        (),
        tuple(map(float, slow)),
        tuple(map(bool, straight)) if straight.any() else None,
        tuple(map(float, rest)) if rest.any() else None,
        float(np.median([s.bandwidth for s in sets])),
        sets[0].nominal_sha256,
        tuple(map(float, np.median([s.left for s in sets], axis=0))),
    )


def _median(effects: Sequence[NamedEffect]) -> NamedEffect:
    """The effect whose first parameter lies in the middle: medians of each parameter alone need not go together."""
    first = effect_named(effects[0].effect).parameters[0].name
    return sorted(effects, key=lambda e: e.values[first])[len(effects) // 2]


def beyond(known: TrackedSet, found: Sequence[NamedEffect]) -> tuple[NamedEffect, ...]:
    """What a search named that is neither followed already nor another name of what is.

    Laws that the catalogue says are confused with, hold, or are held by a followed effect of the same joint are taken
    for it: near the limit of what a recording shows, Coulomb friction is named as Stribeck friction, for example.
    """
    return tuple(e for e in found if not any(_stands_for(e, k) for k in known.effects))


def _stands_for(found: NamedEffect, known: NamedEffect) -> bool:
    if found.joint != known.joint:
        return False
    one, other = effect_named(found.effect), effect_named(known.effect)
    alike = one.name in other.contains or other.name in one.contains or (one.is_friction and other.is_friction)
    return one.name == other.name or alike


def new_physics(known: TrackedSet, found: Sequence[Sequence[NamedEffect]]) -> tuple[NamedEffect, ...]:
    """Effects to follow on one robot beyond the set of its make.

    Args:
        known: the set of the make.
        found: effects named beyond it by the search, for each recording of the robot in order of time.

    Returns:
        Those named in several recordings or, where none is, in the last one; a name that is far rarer than the most
        frequent one, in the same recordings' place, is most likely a misnomer of it.
    """
    places = [{(e.effect, e.joint): e for e in effects} for effects in found]
    kept = repeated([[p for p in row if p not in known.places] for row in places])
    return tuple(_median([row[p] for row in places if p in row]) for p in kept)


def repeated(found: Sequence[Sequence[Place]]) -> list[Place]:
    """Places named in several recordings of a robot or, where none is, one of the last; those far rarer left out.

    Args:
        found: what the search named beyond the set, for each recording in order of time.
    """
    counts = Counter(p for row in found for p in dict.fromkeys(row))
    if not counts:
        return []
    most = max(counts.values())
    kept = [p for p, n in counts.items() if n >= max(SUPPORT, RIVALRY * most)]
    kept = kept or [p for p in counts if p in found[-1]][:1]
    return sorted(kept, key=lambda p: (p[0], -1 if p[1] is None else p[1]))
