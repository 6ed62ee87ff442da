"""The sets of robots whose searches named more than is followed on their make: what joins them, and what does not.

Where torque is recorded, what is named again and again joins. Where commands alone are, effects of single joints are
put to trial: fitted together with the set to the recordings that name them, then to all recordings of the robot, then
together with all others that passed. Only what the recordings determine beside the set joins it.
"""

from __future__ import annotations

import hashlib
import json
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from lagnet.tracking.servos.judgement import cost, why_not_determined, why_not_shown
from lagnet.tracking.servos.new_physics import (
    Candidate,
    again_and_again,
    candidates_of,
    with_candidates,
    with_new_payload,
)
from lagnet.tracking.servos.tracked import Followed, TrackedServos
from lagnet.tracking.tracked_set import effect_from_plain, new_physics
from lagnet.tracking.work import Work

Told = dict[str, Any]
Fit = Callable[[str, Sequence[Work]], list[Told]]  # a title and work of `fit_one` → what each told, in order
TRIALS, FITS = "trials of new effects", "fits with new physics"
ONCE, RARER = "a single search named it", "searches name another effect of the joint far more often"


@dataclass(frozen=True)
class NotFollowed:
    """An effect that searches named beyond the set and that is not followed.

    Args:
        robot, make, joint, effect: what it is.
        named: number of recordings whose searches named it.
        recordings: number of recordings of the robot.
        reason: why it is not followed.
    """

    robot: str
    make: str
    joint: str
    effect: str
    named: int
    recordings: int
    reason: str


@dataclass(eq=False)
class _Robot:
    """One robot while its set grows.

    Args:
        tasks: its recordings that were fitted, in order of time; told: of each of them.
        base: the set of its make, with new physics that needs no trial.
        open: effects that may still join; refused: those that do not, with the reason.
    """

    tasks: list[Work]
    told: list[Told]
    base: Followed
    open: list[Candidate] = field(default_factory=list)
    refused: list[tuple[Candidate, str]] = field(default_factory=list)

    def refuse(self, one: Candidate, reason: str | None) -> None:
        """Closes an effect that has a reason."""
        if reason is not None:
            self.open.remove(one)
            self.refused.append((one, reason))

    def set_with(self, new: Sequence[Candidate]) -> Followed:
        """The base with further effects."""
        return with_candidates(self.base, new) if isinstance(self.base, TrackedServos) and new else self.base


def grown(tasks: Sequence[Work], told: Sequence[Told], out: Path, fit: Fit) -> tuple[list[Told], list[NotFollowed]]:
    """What was told, with the recordings of robots that show new physics fitted again with it, from their first on.

    Args:
        tasks: one a recording, sorted by robot and date; told: what became of each.
        out: folder of the track.
        fit: does the work.
    """
    rows: dict[str, list[int]] = defaultdict(list)
    for i, result in enumerate(told):
        if "rows" in result:
            rows[tasks[i].recording.robot].append(i)
    robots = [_robot([tasks[i] for i in at], [told[i] for i in at]) for at in rows.values()]
    _alone(robots, out, fit)
    _together(robots, out, fit)
    jobs = [(at, robot) for at, robot in zip(rows.values(), robots, strict=True) if robot.open or _has_grown(robot)]
    fits = _fitted(FITS, [(robot.tasks, robot.set_with(robot.open)) for _, robot in jobs], out, fit)
    merged = list(told)
    for (at, _), results in zip(jobs, fits, strict=True):
        for i, result in zip(at, results, strict=True):
            merged[i] = {**told[i], **result} if "rows" in result else told[i]
    return merged, [row for robot in robots for row in _not_followed(robot)]


def _has_grown(robot: _Robot) -> bool:
    return robot.base is not robot.tasks[0].tracked


def _robot(tasks: list[Work], told: list[Told]) -> _Robot:
    known, found = tasks[0].tracked, [t["new"] for t in told]
    if not isinstance(known, TrackedServos):
        new = new_physics(known, [[effect_from_plain(e) for e in effects] for effects in found])
        return _Robot(tasks, told, known.with_new(new) if new else known)
    named = candidates_of(known, found)
    robot = _Robot(tasks, told, with_new_payload(known, found), list(named))
    often = again_and_again(named, len(found))
    for one in named:
        robot.refuse(one, None if one in often else ONCE if len(one.named) == 1 else RARER)
    return robot


def _alone(robots: Sequence[_Robot], out: Path, fit: Fit) -> None:
    """Each effect alone with the set: to the recordings that name it, which should show it best, then to all."""
    asked = [(robot, one) for robot in robots for one in robot.open]
    jobs = [([robot.tasks[i] for i in one.named], robot.set_with([one])) for robot, one in asked]
    for (robot, one), fits in zip(asked, _fitted(TRIALS, jobs, out, fit), strict=True):
        robot.refuse(one, why_not_shown(one, fits) or why_not_determined(one, fits, "recordings that name it"))
    asked = [(robot, one) for robot in robots for one in robot.open]
    jobs = [(robot.tasks, robot.set_with([one])) for robot, one in asked]
    for (robot, one), fits in zip(asked, _fitted(TRIALS, jobs, out, fit), strict=True):
        robot.refuse(one, why_not_determined(one, fits))


def _together(robots: Sequence[_Robot], out: Path, fit: Fit) -> None:
    """All that passed together, less the one that costs the others most, until the recordings determine all."""
    crowded = [robot for robot in robots if len(robot.open) > 1]
    while crowded:
        fits = _fitted(TRIALS, [(robot.tasks, robot.set_with(robot.open)) for robot in crowded], out, fit)
        dropped = [_drops(robot, found) for robot, found in zip(crowded, fits, strict=True)]
        crowded = [robot for robot, less in zip(crowded, dropped, strict=True) if less and len(robot.open) > 1]


def _drops(robot: _Robot, fits: Sequence[Told]) -> bool:
    """Refuses the worst of the effects that recordings do not determine together; False if there is none."""
    reasons = [(one, why) for one in robot.open if (why := why_not_determined(one, fits))]
    if not reasons:
        return False
    one, why = max(reasons, key=lambda pair: cost(pair[0], fits))
    robot.refuse(one, f"beside other new effects, {why}")
    return True


def _fitted(title: str, jobs: Sequence[tuple[Sequence[Work], Followed]], out: Path, fit: Fit) -> list[list[Told]]:
    """What the fits of each set to its recordings told; all are handed out at once."""
    work = [[_task(task, tracked, out) for task in tasks] for tasks, tracked in jobs]
    results = iter(fit(title, [task for tasks in work for task in tasks]) if any(work) else ())
    return [[next(results) for _ in tasks] for tasks in work]


def _task(task: Work, tracked: Followed, out: Path) -> Work:
    added = tracked.added if isinstance(tracked, TrackedServos) else ()
    room = out / "fits"
    if added:
        room = out / "trials" / hashlib.sha256(json.dumps([asdict(a) for a in added]).encode()).hexdigest()[:8]
    return replace(task, tracked=tracked, folder=room / task.recording.robot / task.folder.name)


def _not_followed(robot: _Robot) -> Iterable[NotFollowed]:
    one, joints = robot.tasks[0].recording, robot.told[0]["joints"]
    for found, why in robot.refused:
        yield NotFollowed(
            one.robot, one.make, joints[found.joint], found.effect, len(found.named), len(robot.tasks), why
        )
