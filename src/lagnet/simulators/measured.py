"""Errors of round trips that the package carries: how far an exported effect moves an engine off its model."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from importlib.resources import files

FILE = "measured.json"


@cache
def _table() -> dict:
    return json.loads(files("lagnet.simulators").joinpath(FILE).read_text(encoding="utf-8"))


def measured_errors(exporter: str, effect: str) -> Mapping[str, float]:
    """Error in shares of the effect's own contribution, by engine; empty where no engine here runs the format."""
    return _table()["shares"].get(exporter, {}).get(effect, {})


def measured_servo_errors(exporter: str, effect: str) -> Mapping[str, float]:
    """The same for a cause of an arm driven by position commands."""
    return _table()["servo_shares"].get(exporter, {}).get(effect, {})


def engine_versions() -> Mapping[str, str]:
    """Versions of the engines that were measured."""
    return _table()["engines"]
