"""For any two names there are words on what to record."""

from __future__ import annotations

import pytest

from lagnet.diagnosis.identifiability.equivalent_laws import observationally_equivalent
from lagnet.diagnosis.identifiability.recording_advice import NEVER, RECORDINGS, recording_against
from lagnet.effects.catalogue import CATALOGUE


@pytest.mark.parametrize("first", CATALOGUE)
def test_there_are_words_for_every_pair_whichever_comes_first(first: str) -> None:
    for second in set(CATALOGUE) - {first}:
        words = recording_against([first], [second])
        assert len(words) > 15
        if frozenset((first, second)) in RECORDINGS:
            assert words == recording_against([second], [first])


def test_only_known_names_have_words_of_their_own() -> None:
    assert all(set(pair) <= set(CATALOGUE) and len(pair) == 2 for pair in RECORDINGS)


def test_uneven_friction_is_friction_and_offset_while_it_moves() -> None:
    uneven, both = ["asymmetric_friction"], ["torque_offset", "coulomb_friction"]
    assert observationally_equivalent(uneven, both)
    assert observationally_equivalent(both, uneven)
    assert recording_against(uneven, both) == NEVER
    assert not observationally_equivalent(["torque_offset"], ["torque_gain"])
