"""The complete law of a joint: all that predicts unfitted motion better, named or not.

A name needs evidence; a prediction needs the law of the best score. All plain effects are in it; friction models of as
many parameters take each other's place where they predict better, and further effects are added where that is
significant. Friction per torque of motor and load with a share for each direction of power is the model of Duclusaud
et al. 2025; the others are special cases of it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lagnet.diagnosis.motion.joint.block_scores import advantage
from lagnet.diagnosis.motion.joint.fitting import JointData, fit_law, free_coordinates, huber, robust_scale
from lagnet.diagnosis.motion.joint.joint_case import JointCase, sizes_of
from lagnet.diagnosis.motion.joint.refitting import Selection, groups_of, refit, starts_with
from lagnet.diagnosis.motion.joint.selection import PLAIN
from lagnet.servos.catalogue import servo_effect
from lagnet.servos.parameters import KP

IDENTIFIED = (*PLAIN, "quadratic_drag", "stribeck_friction")  # effects of the complete law, named or not
INSTEAD = (
    ("position_bias", "torque_offset"),
    ("load_dependent_friction", "gear_friction"),
    ("load_dependent_friction", "quadratic_load_friction"),
)  # laws of as many parameters
LIMITS = ("duty_saturation", "torque_saturation")  # of the motor: before laws of friction by its torque are compared
DRIVE = ("gear_friction", "torque_saturation", "load_stribeck_friction")  # of a motor and its gear
GEAR = (*(e for e in PLAIN if e not in ("load_dependent_friction", "position_bias")), *DRIVE)
FURTHER = (
    *LIMITS,
    "gear_friction",
    "directional_load_friction",
    "quadratic_load_friction",
    "static_friction",
    "dead_band",
    "load_stribeck_friction",
)


def refit_to(case: JointCase, chosen: Selection, data: JointData) -> Selection:
    """The chosen effects fitted to every window of the fitted recordings."""
    scale = robust_scale(data.errors(chosen.law), case.floor)
    coordinates = free_coordinates(groups_of(case, chosen.effects), chosen.law, sizes_of(case.scales))
    fitted = fit_law(data, chosen.law, coordinates, scale=scale, iterations=40, patient=True)
    return replace(chosen, fitted=fitted)


def complete_law(case: JointCase, chosen: Selection, named: Selection, data: JointData) -> np.ndarray:
    """The law with all plain effects beside the named ones, where its validation score is better: for prediction.

    Args:
        case: the joint, with long windows.
        chosen: the named effects, as they were selected.
        named: the same, fitted to every window.
        data: every long window of the fitted recordings.
    """
    scale = robust_scale(chosen.fitted.residual, case.floor)
    chosen = refit(case, chosen.effects, chosen.law, scale)
    best = _plain(case, chosen, scale)
    for effect in FURTHER:
        best = _with_further(case, best, effect)
        if effect == LIMITS[-1]:
            best = _with_equals(case, best, chosen.effects)
    best = _against_gear(case, best, chosen, scale)
    if advantage(chosen.blocks, best.blocks)[0] <= 0.0:
        return named.law
    return refit_to(case, best, data).law


def _against_gear(case: JointCase, best: Selection, chosen: Selection, scale: float) -> Selection:
    """The selection, or the whole law of a motor and its gear where that predicts better.

    Friction per load, its fall with speed and a motor that saturates make up for each other: any one beside the wrong
    values of the others gains nothing, so that they are fitted at once.
    """
    bias = "position_bias" if "position_bias" in case.excited else "torque_offset"
    whole = tuple(e for e in (*GEAR, bias) if e in case.excited and (case.scale_is_set or e != "gain_error"))
    if not set(DRIVE) <= set(whole):
        return best
    found = []
    for law in (best.law, chosen.law, _merged(case.law, case)):
        fit = refit(case, whole, _with_drive(law, case), scale, patient=True)
        found.append(refit(case, whole, fit.law, robust_scale(fit.fitted.residual, case.floor), patient=True))
    new = min(found, key=lambda s: s.blocks.mean())
    return new if advantage(best.blocks, new.blocks)[0] > case.limits.gain else best


def _with_drive(law: np.ndarray, case: JointCase) -> np.ndarray:
    """The law with the first start of every effect of motor and gear that it does not have."""
    for effect in map(servo_effect, DRIVE):
        if not any(effect.read(law).values()):
            values = effect.starts(replace(case.scales, kp=float(law[KP])))[0]
            law = effect.apply(law, dict(zip([p.name for p in effect.parameters], values, strict=True)))
    return law


def _plain(case: JointCase, chosen: Selection, scale: float) -> Selection:
    """The named and all plain effects; dry friction that falls with speed where that predicts better."""
    contained = {c for e in chosen.effects for c in servo_effect(e).contains}
    more = [e for e in IDENTIFIED if e in case.excited and e not in {*chosen.effects, *contained}]
    more = [e for e in more if case.scale_is_set or e != "gain_error"]
    if "position_bias" not in case.excited and "torque_offset" in case.excited:  # a recorded duty shows the bias
        more.append("torque_offset")
    tries = [[e for e in more if e != "stribeck_friction"]]
    if "stribeck_friction" in more:
        tries.append([e for e in more if e != "coulomb_friction"])
    found = [_best_of(case, chosen.law, (*chosen.effects, *effects), scale) for effects in tries]
    return min(found, key=lambda s: s.blocks.mean())


def _with_equals(case: JointCase, best: Selection, kept: tuple[str, ...]) -> Selection:
    """The selection with effects replaced by others of as many parameters that fit better.

    Those kept, the named ones, give way to laws alone of which they are special cases. Of laws of equal size the
    likelihood decides, where validation does not speak against it.
    """
    for effect, other in INSTEAD:
        free = effect not in kept or effect in servo_effect(other).contains
        if effect in best.effects and free and other in case.excited:
            scale = robust_scale(best.fitted.residual, case.floor)
            found = min(_fits_with(case, _less(case, best, effect), other, scale), key=lambda s: s.fitted.cost)
            fits_better = found.fitted.cost < np.mean(huber(best.fitted.residual, scale))
            if fits_better and advantage(best.blocks, found.blocks)[1] > -case.limits.tie:
                best = found
    return best


def _less(case: JointCase, selected: Selection, effect: str) -> Selection:
    """The selection without an effect, whose parameters are nominal; the others keep their values."""
    law, own = selected.law.copy(), servo_effect(effect)
    law = own.apply(law, own.read(case.law))
    kept = tuple(e for e in selected.effects if e != effect)
    return replace(selected, effects=kept, fitted=replace(selected.fitted, law=law))


def _with_further(case: JointCase, best: Selection, effect: str) -> Selection:
    """The selection with one more effect, where that predicts significantly better."""
    if effect not in case.excited or effect in best.effects or not servo_effect(effect).acts_beside(best.effects):
        return best
    scale = robust_scale(best.fitted.residual, case.floor)
    found = min(_fits_with(case, best, effect, scale), key=lambda s: s.blocks.mean())
    gain, errors = advantage(best.blocks, found.blocks)
    return found if gain > case.limits.gain and errors > case.limits.tie else best


def _fits_with(case: JointCase, best: Selection, effect: str, scale: float) -> list[Selection]:
    """Fits from an effect's starts, without the effects that it contains."""
    effects = (*(e for e in best.effects if e not in servo_effect(effect).contains), effect)
    return [refit(case, effects, start, scale) for start in starts_with(case, best, effect)]


def _best_of(case: JointCase, law: np.ndarray, effects: tuple[str, ...], scale: float) -> Selection:
    """The better fit of two starts: the named law, with and without the plain effects of the equation error."""
    starts = [_with_stribeck_speed(start, case, effects) for start in (law, _merged(law, case))]
    return min((refit(case, effects, start, scale) for start in starts), key=lambda s: s.blocks.mean())


def _with_stribeck_speed(law: np.ndarray, case: JointCase, effects: tuple[str, ...]) -> np.ndarray:
    """The law with vs > 0 where it is free: at vs = 0 its derivative is zero."""
    out = law.copy()
    if "stribeck_friction" in effects:
        shape = servo_effect("stribeck_friction")
        values = shape.read(out)
        if values["vs"] == 0.0:
            out = shape.apply(out, values | {"vs": 0.3 * case.scales.speed})
    return out


def _merged(law: np.ndarray, case: JointCase) -> np.ndarray:
    """The law with the plain effects of the equation error where it is nominal."""
    return np.where(law == case.law, case.start, law) if case.scale_is_set else law
