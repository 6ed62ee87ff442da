"""The pictures of "how a diagnosis works" can be drawn by what the diagnosis gives today."""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path

import pytest

from lagnet.diagnosis.diagnose import diagnose

DOCS = Path(__file__).resolve().parents[1] / "docs"


@pytest.mark.slow
def test_every_picture_and_table_of_the_walkthrough_is_made(monkeypatch, tmp_path) -> None:
    monkeypatch.syspath_prepend(str(DOCS))
    make_walkthrough = import_module("make_walkthrough")
    monkeypatch.setattr(make_walkthrough, "PICTURES", tmp_path)
    case = make_walkthrough.make_case()
    result = diagnose(case.fit, case.robot, case.holdout)
    make_walkthrough.pictures(case, result)
    drawn = {path.name for path in tmp_path.glob("*.png")}
    assert drawn == {path.name for path in (DOCS / "images" / "walkthrough").glob("*.png")}
    named = make_walkthrough.tables(case, result)["named"]
    assert all(word in named for word in ("Payload", "Coulomb friction", "Contact force"))
    sys.modules.pop("make_walkthrough", None)
