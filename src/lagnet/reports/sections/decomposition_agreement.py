"""nMSE of each term and joint, with 95 % intervals."""

from __future__ import annotations

from typing import Any

import numpy as np

from lagnet.decomposition.agreement import Agreement
from lagnet.decomposition.decompose import Decomposition
from lagnet.reports.page import Section, section
from lagnet.reports.wording import effect_words, number


def build(parts: Decomposition) -> Section:
    """One row a joint: the total against what was measured, each term against the reference."""
    columns = [("total", parts.total_error)]
    columns += [(effect_words(name), error) for name, error in parts.term_errors.items()]
    rows = [
        {"joint": joint, "cells": [_cell(error, i) for _, error in columns]} for i, joint in enumerate(parts.joints)
    ]
    headings = [("joint", False), *((words, True) for words, _ in columns)]
    groups = [("", 1), ("against measured", 1), ("against the reference", len(parts.term_errors))]
    return section("decomposition_agreement", "Agreement", rows=rows, headings=headings, groups=groups)


def _cell(error: Agreement, i: int) -> dict[str, Any]:
    interval = "" if np.isnan(error.low[i]) else f"{number(float(error.low[i]), 2)} … {number(float(error.high[i]), 2)}"
    return {"value": float(error.nmse[i]), "interval": interval}
