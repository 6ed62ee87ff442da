"""`--holdout a b` holds both recordings out; neither slips in among those that are fitted."""

from __future__ import annotations

import pytest

from lagnet.cli.shared.many_values import repeat_options


@pytest.mark.parametrize(
    ("given", "meant"),
    [
        (
            "diagnose a b --robot ur5 --holdout c d --out o",
            "diagnose a b --robot ur5 --holdout c --holdout d --out o",
        ),
        ("diagnose a --holdout c --holdout d", "diagnose a --holdout c --holdout d"),
        ("diagnose a --simulated s t --holdout c", "diagnose a --simulated s --simulated t --holdout c"),
        ("diagnose --holdout c a --robot ur5", "diagnose --holdout c a --robot ur5"),
        ("check m --recording a b --out o", "check m --recording a --recording b --out o"),
        ("diagnose a --holdout=c b", "diagnose a --holdout=c b"),
        ("", ""),
    ],
)
def test_values_after_an_option_are_its_own(given, meant):
    assert repeat_options(given.split()) == meant.split()
