"""Every sabotage is caught by the check meant for it, and the published table is that of today's checks."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import pytest
from validation.mutants.mutants import MUTANTS, Mutant
from validation.mutants.study import HERE, examine

from lagnet.plausibility.checks import CHECK_NAMES, CHECKS


def _cases() -> Iterator[Any]:
    seen: set[str] = set()
    for mutant in MUTANTS:
        marks = [pytest.mark.slow] if mutant.meant_for in seen else []
        seen.add(mutant.meant_for)
        yield pytest.param(mutant, id=mutant.name, marks=marks)


ONE_A_CHECK_IS_QUICK = tuple(_cases())


@pytest.fixture(scope="module")
def table() -> dict:
    return json.loads((HERE / "result.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("mutant", ONE_A_CHECK_IS_QUICK)
def test_caught_by_the_check_meant_for_it(mutant: Mutant, table: dict):
    row = examine(mutant)
    assert mutant.meant_for in row["caught_by"], row
    published = next(r for r in table["rows"] if r["mutant"] == mutant.name)
    assert row["caught_by"] == published["caught_by"], "run python -m validation.mutants.study"


def test_there_are_mutants_enough():
    assert len(MUTANTS) >= 25
    assert len({m.name for m in MUTANTS}) == len(MUTANTS)
    assert {m.meant_for for m in MUTANTS} <= set(CHECK_NAMES)


def test_every_check_is_needed_or_says_why_it_stays(table: dict):
    alone = table["caught_by_this_check_alone"]
    for kind in CHECKS:
        assert alone[kind.name] or kind.stays_because, kind.name
    assert table["pass"]
    assert table["false_alarms"] == []
    assert table["random_arms"] >= 50
