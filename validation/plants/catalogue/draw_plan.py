"""Draw a plan from a seed and a number: what it is drawn for goes by the number, everything else by the seed."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from validation.plants.body import arm_joints, joint_names
from validation.plants.catalogue.calibrate import calibrated
from validation.plants.catalogue.listed import DRY, GEARS, LISTED, NAMED, PASSING
from validation.plants.catalogue.plan import Plan
from validation.plants.catalogue.scale import RIGID_RATE, OwnScale, own_scale, wanted_motions
from validation.plants.catalogue.unlisted import UNLISTED
from validation.plants.draw import FRICTION_LEVELS, WHOLE_ARM, _clipped_size
from validation.plants.spec import Hidden

ROBOTS = ("ur5", "panda", "ur10", "xarm7", "kinova", "z1")
GROUPS = (
    "listed",
    "listed",
    "unlisted",
    "listed",
    "empty",
    "listed",
    "behind",
    "listed",
    "unlisted",
    "listed",
    "empty",
    "listed",
)
SMALLEST, LARGEST = 0.03, 0.40  # share of the joint's torque
MOST_NOISE = 0.02
BEHIND = ("viscous_friction", "coulomb_friction", "joint_spring", "rotor_inertia", "torque_gain")  # the large one
FRONT = (  # the small one behind it
    "viscous_friction",
    "coulomb_friction",
    "stribeck_friction",
    "quadratic_drag",
    "load_dependent_friction",
    "joint_spring",
    "torque_ripple",
    "torque_offset",
    "time_delay",
    "rotor_inertia",
    "presliding_hysteresis",
)
SHAPES = (("waypoints", "fourier", "sweeps"),) * 3 + (
    ("fourier", "waypoints", "fourier"),
    ("waypoints", "sweeps", "waypoints"),
)
ALIKE = {  # on one joint, these are hardly two things
    frozenset({"viscous_friction", "quadratic_drag"}),
    frozenset({"encoder_offset", "joint_elasticity"}),
    frozenset({"torque_gain", "saturation"}),
}
TRIES = 60
GEAR_TRIES = 6  # each takes up to five runs of a stiff plant


def draw_plan(seed: int, number: int, robots: tuple[str, ...] = ROBOTS) -> Plan:
    """The plan of that number; the same seed and number draw the same plan."""
    rng = np.random.default_rng([seed, number, 5])
    group, rank = GROUPS[number % len(GROUPS)], _rank(number)
    frame = _frame(number, group, robots[(number + number // len(GROUPS)) % len(robots)], rng)
    hidden: tuple[Hidden, ...] = ()
    if group == "listed":
        hidden = _listed(frame, rank, 1 + int(rng.choice(3, p=[0.4, 0.4, 0.2])), rng)
    elif group == "behind":
        hidden = _behind(frame, rng)
    elif group == "unlisted":
        hidden = _unlisted(frame, rank, rng)
    passing = any("t0" in h.values for h in hidden)  # PyBullet's copy of the bodies knows of no events
    return replace(frame, hidden=hidden, engine="pinocchio" if passing else frame.engine)


def _rank(number: int) -> int:
    """How many plants of the same group come before it."""
    whole, part = divmod(number, len(GROUPS))
    group = GROUPS[part]
    return whole * GROUPS.count(group) + GROUPS[:part].count(group)


def _frame(number: int, group: str, robot: str, rng: np.random.Generator) -> Plan:
    """A plan with nothing hidden yet."""
    top = MOST_NOISE / 2 if group == "behind" else MOST_NOISE
    bits = int(rng.choice([0, 18, 20]))
    return Plan(
        number=number,
        seed=int(rng.integers(2**31)),
        group=group,
        robot=robot,
        hidden=(),
        noise=float(np.exp(rng.uniform(np.log(0.005), np.log(top)))),
        encoder_bits=bits,
        angle_noise=0.0 if bits else float(rng.choice([0.0, 5e-6, 2e-5])),
        current_filter=float(rng.choice([0.0, 0.0, 150.0, 300.0])),
        velocity=bool(rng.random() < 0.3),
        controller=str(rng.choice(["computed_torque", "pd_with_gravity", "pd_with_integral"])),
        engine=str(rng.choice(["pinocchio", "pinocchio", "pybullet"])),
        shapes=(*SHAPES[rng.integers(len(SHAPES))], str(rng.choice(["fourier", "waypoints"]))),
        speed_share=float(rng.uniform(0.5, 0.9)),
    )


@lru_cache(maxsize=4)
def _scale_of(robot: str, shapes: tuple[str, ...], seed: int, speed_share: float, duration: float) -> OwnScale:
    return own_scale(robot, wanted_motions(robot, shapes, seed, speed_share, duration, RIGID_RATE))


def scale_of_plan(plan: Plan) -> OwnScale:
    """Sizes on the motions that are fitted."""
    return _scale_of(plan.robot, plan.shapes[:-1], plan.seed, plan.speed_share, plan.duration)


def _listed(plan: Plan, rank: int, count: int, rng: np.random.Generator) -> tuple[Hidden, ...]:
    """The first kind goes round the catalogue, so that every kind comes up; the others are drawn.

    Where the plant's motions cannot show a kind, the next one comes first.
    """
    kinds = tuple(LISTED)
    hidden: list[Hidden] = []
    while len(hidden) < count:
        kind = kinds[rank % len(kinds)] if not hidden else str(rng.choice(list(kinds)))
        entry = draw_hidden(plan, kind, rng)
        if entry is None and not hidden:
            rank += 1
        elif entry is not None and not any(_clash(entry, other) for other in hidden):
            hidden.append(entry)
    return tuple(hidden)


def _behind(plan: Plan, rng: np.random.Generator) -> tuple[Hidden, ...]:
    """The largest size, and the smallest of another kind on the same joint."""
    while True:
        large = draw_hidden(plan, str(rng.choice(BEHIND)), rng, size=LARGEST)
        if large is None:
            continue
        joint = joint_names(plan.robot).index(str(large.joint))
        small = draw_hidden(plan, str(rng.choice(FRONT)), rng, size=SMALLEST, joint=joint)
        if small is not None and not _clash(small, large):
            return large, small


def _unlisted(plan: Plan, rank: int, rng: np.random.Generator) -> tuple[Hidden, ...]:
    """Alone, or in every other plant beside a listed cause elsewhere."""
    kind = tuple(UNLISTED)[rank % len(UNLISTED)]
    scale, joints = scale_of_plan(plan), arm_joints(plan.robot)
    joint = int(rng.choice(joints[:-1] if UNLISTED[kind].partner else joints))
    size = _log_uniform(rng, 0.06, LARGEST)
    values = {k: float(x) for k, x in UNLISTED[kind].draw(scale, joint, size, rng).items()}
    strange = Hidden(f"unlisted:{kind}", joint_names(plan.robot)[joint], values, size)
    while (rank // len(UNLISTED)) % 2:
        beside = draw_hidden(plan, str(rng.choice(list(LISTED))), rng)
        if beside is not None and beside.joint is not None and abs(joint - _index(plan, beside)) > 1:
            return strange, beside
    return (strange,)


def _index(plan: Plan, hidden: Hidden) -> int:
    return joint_names(plan.robot).index(str(hidden.joint))


def _log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def draw_hidden(
    plan: Plan,
    kind: str,
    rng: np.random.Generator,
    size: float | None = None,
    joint: int | None = None,
    least: float = SMALLEST,
) -> Hidden | None:
    """One listed cause, of at least a size, at a joint that can show it; None where no try found one."""
    scale = scale_of_plan(plan)
    for _ in range(GEAR_TRIES if kind in GEARS else TRIES):
        j = int(rng.choice(arm_joints(plan.robot))) if joint is None else joint
        wanted = _log_uniform(rng, SMALLEST, LARGEST) if size is None else size
        values = LISTED[kind](scale, j, wanted, rng)
        if values is None:
            continue
        got = _clipped_size(kind, scale, j, wanted, values)
        if got < 0.99 * least:
            continue
        name = None if kind in WHOLE_ARM | PASSING else joint_names(plan.robot)[j]
        hidden = Hidden(NAMED.get(kind, kind), name, {k: float(x) for k, x in values.items()}, got)
        sized = calibrated(plan, hidden, wanted) if kind in GEARS else hidden
        if sized is not None and sized.size >= 0.99 * least:
            return sized
    return None


def _clash(one: Hidden, other: Hidden) -> bool:
    """Whether two causes would be one under two names, or cannot be built together."""
    both = {one.effect, other.effect}
    passing = "t0" in one.values or "t0" in other.values
    if both <= GEARS or (passing and both & GEARS):
        return True
    if one.joint != other.joint:
        return False
    levels = both <= FRICTION_LEVELS or both <= DRY
    return one.effect == other.effect or levels or frozenset(both) in ALIKE
