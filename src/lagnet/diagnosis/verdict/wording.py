"""Sentences of a verdict."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from lagnet.diagnosis.estimation.gauss_newton import NOT_SAID
from lagnet.diagnosis.identifiability.recording_advice import recording_against
from lagnet.diagnosis.verdict.verdict import EffectEvidence, EffectFound, JointFit, NamedParameter
from lagnet.effects.effect import Effect
from lagnet.percent import percent
from lagnet.recordings.conditioning.condition import Conditioned

MOST_PARAMETERS = 4  # that a sentence lists
WIDEST = 30.0  # half widths of an interval that holds zero, over the value: beyond, the value says nothing
LEAST_VALUE = 0.1  # in any unit: a value near zero with a narrow interval is told, too
ALIKE = 1.5  # times one error that another is at most, to be told as the same
BESIDE_FREE_LINKS = (
    "several links differ from the model: no few bodies that can exist explain this motion. Causes were judged beside "
    "the inertial parameters of all links as these recordings determine them; these parameters stand in the identified "
    "layer, and the error of the named layer is without them"
)
SELDOM_MET = (
    " The held-out recordings hardly meet it:"
    " these are errors on parts of the fitted ones, each predicted from the others."
)


def explain(
    law: Effect, joint: str | None, parameters: Sequence[NamedParameter], tied: Sequence[str], evidence: EffectEvidence
) -> str:
    """One or two sentences: effect, joint, parameters, held-out error with and without it, and ties."""
    where = f"at {joint}" if joint else "on the whole arm"
    found = {p.name: p.value for p in parameters}
    shown = values([p for p in parameters if p.name in law.told(found)])
    remark = law.remark(found)
    shown += f" ({remark})" if remark else ""
    title = f"{law.title}, less than modelled," if law.is_less(found) else law.title
    first = f"{title} {where}, {law.formula_with(found)} with {shown}: without it the held-out error is "
    first += f"{percent(evidence.holdout_nmse_without)} of the torque's variance, with it "
    first += f"{percent(evidence.holdout_nmse_with)}."
    if tied:
        first += f" These recordings cannot tell it from {' or '.join(t.replace('_', ' ') for t in tied)}. "
        advised = (word for t in tied for word in recording_against([law.name], [t]).split("; "))
        first += f"What would: {'; '.join(dict.fromkeys(advised))}."
    return first


def alike_words(joints: Sequence[str]) -> str:
    """Which other links would do, as where a mass lies on the axis of the joint between two."""
    return f" The link behind {' or '.join(joints)}, changed in its place, would explain it as well." if joints else ""


def values(parameters: Sequence[NamedParameter]) -> str:
    """The first few parameters that the recordings determine, with their values; none of what they leave open."""
    told = [p for p in parameters if is_told(p)]
    if not told:
        return f"{' and '.join(p.name for p in parameters[:MOST_PARAMETERS])} not determined"
    return ", ".join(f"{p.name} = {p.value:.4g} {p.unit}".rstrip(" –") for p in told[:MOST_PARAMETERS])


def is_told(parameter: NamedParameter) -> bool:
    """Whether the half width of the 95 % interval is below NOT_SAID, and, where it holds zero, below 30 |value|.

    A mass of 1,242 kg that may as well be minus or plus thirty tons is no value.
    """
    low, high = parameter.ci95
    half = 0.5 * (high - low)
    return half < NOT_SAID and (low > 0.0 or high < 0.0 or half <= WIDEST * max(abs(parameter.value), LEAST_VALUE))


def explain_transient(
    law: Effect,
    interval: tuple[float, float],
    recording: str,
    parameters: Sequence[NamedParameter],
    tied: Sequence[str],
    evidence: EffectEvidence,
    throughout: bool = False,
) -> str:
    """Effect, interval, recording, parameters, and the cross-validated error with and without it on that interval.

    Args:
        throughout: whether the interval is the whole recording.
    """
    shown = values(parameters)
    when = "throughout" if throughout else f"from {interval[0]:.4g} s to {interval[1]:.4g} s of"
    first = f"{law.title} {when} {recording}, {law.formula} with {shown}: "
    first += f"in that time the error is {percent(evidence.holdout_nmse_without)} of the torque's variance without it, "
    first += f"{percent(evidence.holdout_nmse_with)} with it, each part predicted from the others. "
    first += f"The corrected model has it in {'' if throughout else 'that time of '}that recording only."
    if tied:
        first += f" This time cannot tell it from {' or '.join(t.replace('_', ' ') for t in tied)}."
    return first


def whole_error_words(effect: EffectFound, fits: Sequence[JointFit], beside_links: bool = False) -> str:
    """What the named physics leaves over all held-out samples, where the effect's own figures do not say it.

    The evidence on an effect leaves out samples at rest, and is a mean over the joints that an effect of the whole arm
    reaches; `nmse_named` counts all samples, at its joint or, of the whole arm, at the worst one.

    Args:
        beside_links: whether names were judged beside parameters of all links, which `nmse_named` is without.
    """
    named = "named physics without the links that differ" if beside_links else "named physics"
    apart = effect.interval_s is not None or effect.explanation.endswith(
        SELDOM_MET
    )  # judged on other samples, and said
    if apart or not fits:
        return ""
    own = [fit for fit in fits if fit.joint == effect.joint] or fits
    worst = max(own, key=lambda fit: fit.nmse_named)
    left = percent(worst.nmse_named)
    if len(own) > 1:
        return f" Over all held-out samples, {named} leaves most at {worst.joint}: {left}."
    told = effect.evidence.holdout_nmse_with
    if left == percent(told) or told < ALIKE * worst.nmse_named < ALIKE**2 * told:
        return ""
    return f" Over all held-out samples, rest included, {named} leaves {left} there."


def advice(law: Effect, joint: str | None) -> str:
    """The motion that determines an effect."""
    where = f"{joint}: " if joint else ""
    return f"{where}record {law.shown_by}"


def clock_shift_words(fit: Conditioned) -> Iterator[str]:
    """A sentence where torques were shifted against their time stamps."""
    if fit.torque_shift:
        way = "later" if fit.torque_shift > 0 else "earlier"
        yield (
            f"at every joint the torque is stamped {1e3 * abs(fit.torque_shift):.2g} ms {way} than the motion that it "
            f"belongs to ({abs(fit.torque_shift) * fit.rate:.2g} of a sample), as when it is held from one sample to "
            "the next: torques were shifted by that before all else"
        )
