"""What each hidden cause costs in torque along a true run, apart from the others."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.signal import butter, sosfiltfilt

from validation.plants.arm.bodies import PinocchioBodies
from validation.plants.arm.loop import TrueRun
from validation.plants.body import BodySettings
from validation.plants.catalogue.assemble import Parts
from validation.plants.catalogue.measure import late, shown_torque
from validation.plants.catalogue.plan import Plan
from validation.plants.catalogue.scale import LEAD

SEEN_BEHIND_A_GEAR = 15.0  # [Hz]: impacts of a gap are faster than any recording at 100 Hz resolves


@dataclass(frozen=True, eq=False)
class Costs:
    """Samples of one recording without noise, shape (n, dof) each.

    Args:
        q, v, a: as the encoders have them.
        shown: torque signal [N m].
        beyond: what of it the nominal bodies do not explain [N m].
        each: the part of `beyond` of every hidden cause, in the plan's order [N m].
    """

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    shown: np.ndarray
    beyond: np.ndarray
    each: tuple[np.ndarray, ...]


def costs_of(plan: Plan, parts: Parts, run: TrueRun, nominal: PinocchioBodies) -> Costs:
    """Costs along one run, at the recorded samples."""
    every = round(plan.step_rate / plan.rate)
    run = _resolvable(plan, run) if parts.gears else run
    shown = shown_torque(plan, parts, run.tau)
    q, v, a, tau = (x[::every] for x in (run.q, run.v, run.a, run.tau))
    seen = q - parts.angle_offset
    rigid = nominal.torque(seen, v, a)
    each = [np.zeros_like(q) for _ in plan.hidden]
    gear = None
    for i, hidden in enumerate(plan.hidden):
        j = -1 if hidden.joint is None else nominal.joints.index(hidden.joint)
        if "t0" in hidden.values and hidden.effect == "payload":
            each[i] = _carried(plan, parts, (q, v, a), nominal)
        elif "t0" in hidden.values and i not in run.own:
            continue  # in another recording
        elif i in run.own:
            each[i] = run.own[i][::every]
        elif hidden.effect in ("joint_elasticity", "backlash"):
            gear = i
        else:
            each[i] = _cost(plan, parts, hidden.effect, j, (q, v, a), run.tau, nominal, every)
    if gear is not None:
        signals = ("torque_gain", "torque_offset", "saturation", "time_delay")
        others = (c for h, c in zip(plan.hidden, each, strict=True) if h.effect not in signals)
        each[gear] = tau - rigid - sum(others, np.zeros_like(q))
    return Costs(seen, v, a, shown[::every], shown[::every] - rigid, tuple(each))


def _resolvable(plan: Plan, run: TrueRun) -> TrueRun:
    """The run as a recording behind a gear can resolve it."""
    sections = butter(4, SEEN_BEHIND_A_GEAR / (plan.step_rate / 2), output="sos")

    def smooth(signal: np.ndarray) -> np.ndarray:
        return np.asarray(sosfiltfilt(sections, signal, axis=0))

    own = {number: smooth(cost) for number, cost in run.own.items()}
    return replace(run, q=smooth(run.q), v=smooth(run.v), a=smooth(run.a), tau=smooth(run.tau), own=own)


def _cost(
    plan: Plan,
    parts: Parts,
    effect: str,
    j: int,
    motion: tuple[np.ndarray, np.ndarray, np.ndarray],
    tau: np.ndarray,
    nominal: PinocchioBodies,
    every: int,
) -> np.ndarray:
    """Of causes in the bodies and in the signal."""
    q, v, a = motion
    match effect:
        case "payload":
            return _bodies(plan, BodySettings(payload=parts.payload), motion, nominal)
        case "gravity_tilt":
            return _bodies(plan, BodySettings(tilt=parts.tilt), motion, nominal)
        case "link_inertia":
            change = next(c for c in parts.links if c[0] == nominal.joints[j])
            return _bodies(plan, BodySettings(link_changes=(change,)), motion, nominal)
        case "encoder_offset":
            moved = q.copy()
            moved[:, j] -= parts.angle_offset[j]
            return nominal.torque(q, v, a) - nominal.torque(moved, v, a)
        case "rotor_inertia":
            return _only(q, j, parts.armature[j] * a[:, j])
        case "torque_gain":
            return _only(q, j, (parts.gain[j] - 1) * tau[::every, j])
        case "torque_offset":
            return _only(q, j, np.full(q.shape[0], parts.offset[j]))
        case "saturation":
            whole = tau[::every, j] * parts.gain[j] + parts.offset[j]
            return _only(q, j, np.clip(whole, -parts.ceiling[j], parts.ceiling[j]) - whole)
        case "time_delay":
            return _only(q, j, (late(tau, parts.delay, plan.step_rate) - tau)[::every, j] * parts.gain[j])
    raise ValueError(f"no cost for {effect}")


def _carried(plan: Plan, parts: Parts, motion: tuple, nominal: PinocchioBodies) -> np.ndarray:
    """Of a load that is carried for a while."""
    time = np.arange(motion[0].shape[0]) / plan.rate + LEAD
    cost = np.zeros_like(motion[0])
    for grasp in parts.grasps:
        on = (grasp.start <= time) & (time < grasp.end)
        without = PinocchioBodies(plan.robot, parts.body)
        cost[on] = grasp.bodies.torque(*(x[on] for x in motion)) - without.torque(*(x[on] for x in motion))
    return cost


def _bodies(plan: Plan, settings: BodySettings, motion: tuple, nominal: PinocchioBodies) -> np.ndarray:
    return PinocchioBodies(plan.robot, settings).torque(*motion) - nominal.torque(*motion)


def _only(like: np.ndarray, j: int, column: np.ndarray) -> np.ndarray:
    out = np.zeros_like(like)
    out[:, j] = column
    return out
