"""A payload in the verdict on motion: its entry among the effects, or why it was not judged."""

from __future__ import annotations

from math import exp

from lagnet.diagnosis.motion.joint.block_scores import log10_odds
from lagnet.diagnosis.motion.payload.found import PayloadFound
from lagnet.diagnosis.verdict.verdict import Abstained, EffectEvidence, EffectFound, NamedParameter
from lagnet.percent import percent
from lagnet.servos.nominal import NominalServo

UNITS = {"m": "kg", "cx": "m", "cy": "m", "cz": "m"}


def payload_effect(payload: PayloadFound) -> EffectFound:
    """One effect of the whole arm, with mass and centre in the last joint's frame."""
    parameters = tuple(NamedParameter(n, v, UNITS[n], payload.intervals[n]) for n, v in payload.values.items())
    rival = payload.tied[0] if payload.tied else None
    evidence = EffectEvidence(*payload.power, 1.0, rival, log10_odds(payload.lead_errors))
    shown = ", ".join(f"{p.name} = {p.value:.4g} {p.unit}" for p in parameters)
    text = f"Payload on the last link, a point mass with {shown}: without it errors of position on motion that was not "
    text += f"fitted are {percent(exp(payload.gain) - 1.0)} larger."
    if payload.tied:
        names = " or ".join(t.replace("_", " ") for t in payload.tied)
        text += (
            f" One joint shows only m c and m |c|², and cannot tell it from {names}. What would: motion of a second "
        )
        text += "joint that carries it."
    status = "tied" if payload.tied else "named"
    return EffectFound("payload", None, status, payload.tied, parameters, evidence, text)


def payload_abstention(servo: NominalServo) -> tuple[Abstained, ...]:
    """Where a gain is not given, a load of another size and another gain give the same motion."""
    if all(servo.known):
        return ()
    why = "gains of the servos are not given: another mass and another gain move the arm alike"
    return (Abstained("payload", None, why, "give the servos' gains, or record with and without a known payload"),)
