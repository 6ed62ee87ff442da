"""Sentences of a verdict, and what they are told from."""

from __future__ import annotations

from dataclasses import replace

from lagnet.diagnosis.verdict.verdict import EffectEvidence, EffectFound, JointFit, NamedParameter
from lagnet.diagnosis.verdict.wording import SELDOM_MET, values, whole_error_words


def test_a_sentence_tells_what_the_recordings_determine() -> None:
    open_, told = NamedParameter("dm", 1.5, "kg", (-2e6, 2e6)), NamedParameter("dmcx", 0.25, "kg m", (0.2, 0.3))
    assert values([open_, told]) == "dmcx = 0.25 kg m"
    assert values([open_]) == "dm not determined"


def test_a_mass_that_may_be_tons_either_way_is_no_value() -> None:
    tons, told = NamedParameter("dm", 1242.0, "kg", (-3e5, 3e5)), NamedParameter("dmcx", 0.25, "kg m", (0.2, 0.3))
    assert values([tons, told]) == "dmcx = 0.25 kg m"


def test_values_that_are_known_roughly_or_near_zero_are_told() -> None:
    rough, zero = NamedParameter("dm", 2.0, "kg", (-1.0, 5.0)), NamedParameter("theta", 1e-5, "rad", (-1e-3, 1e-3))
    assert values([rough, zero]) == "dm = 2 kg, theta = 1e-05 rad"


def effect_at(joint: str | None, left: float, interval: tuple[float, float] | None = None) -> EffectFound:
    return EffectFound("payload", joint, "named", (), (), EffectEvidence(0.5, left, 0.5, None, None), "", interval)


FITS = (JointFit("base", 0.5, 0.08, None, 1e-6), JointFit("elbow", 0.6, 0.9, None, 1e-6))


def test_the_error_over_all_samples_is_told_where_rest_changes_it() -> None:
    assert whole_error_words(effect_at("base", 0.0801), FITS) == ""
    assert whole_error_words(effect_at("base", 0.06), FITS) == whole_error_words(effect_at("base", 0.11), FITS) == ""
    assert whole_error_words(effect_at("base", 0.05), FITS) != ""
    assert whole_error_words(effect_at("base", 0.13), FITS) != ""
    assert whole_error_words(effect_at("base", 0.005), FITS).endswith("rest included, named physics leaves 8 % there.")


def test_an_effect_of_the_whole_arm_names_the_worst_joint() -> None:
    assert whole_error_words(effect_at(None, 0.005), FITS).endswith("leaves most at elbow: 90 %.")


def test_what_is_judged_on_other_samples_says_so_alone() -> None:
    assert whole_error_words(effect_at(None, 0.005, (1.0, 2.0)), FITS) == ""
    assert whole_error_words(replace(effect_at("base", 0.005), explanation=f"Sentence.{SELDOM_MET}"), FITS) == ""
