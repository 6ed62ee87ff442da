"""The one-minute verdict on motion: how far, what for, and what stays open."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from lagnet.diagnosis.motion.diagnose import MotionDiagnosis
from lagnet.diagnosis.motion.surface.entry import NAME
from lagnet.reports.contents.findings import WHOLE_ARM
from lagnet.reports.page import Section, section


def build(verdict: Mapping[str, Any], diagnosis: MotionDiagnosis) -> Section:
    """Errors before and after, and the named causes by joint."""
    fits = verdict["fit"]
    before, after = (float(np.sqrt(np.mean([f[k] ** 2 for f in fits]))) for k in ("rmse_nominal", "rmse_corrected"))
    worst = max(fits, key=lambda f: f["rmse_corrected"])
    causes: dict[str, list[dict[str, Any]]] = {}
    for effect in verdict["effects"]:
        causes.setdefault(effect["joint"] or WHOLE_ARM, []).append(effect)
    source = {
        "mjcf": "The nominal servos are those of the MJCF's actuators.",
        "file": "The nominal servos are those of the file that was given.",
        "estimated": "No servo was given: gain and damping are estimated, and nothing is claimed of them.",
    }[verdict["servo"]["source"]]
    unset = [row["joint"] for row in verdict["servo"]["joints"] if not row["scale_is_set"]]
    return section(
        "motion_headline",
        "",
        state="found" if verdict["effects"] else "nothing",
        before=before,
        after=after,
        worst=worst if len(fits) > 1 else None,
        recordings=len(diagnosis.holdout_recordings),
        causes=causes,
        source=source,
        unset=unset,
        warnings=verdict["warnings"],
        n_abstentions=len(verdict["abstentions"]),
        unnamed=[a["reason"] for a in verdict["abstentions"] if a["effect"] == NAME],
    )
