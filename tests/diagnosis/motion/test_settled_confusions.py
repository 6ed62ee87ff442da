"""Plants of another engine that were once told wrongly or not at all: each is now told as what it is, or not."""

from __future__ import annotations

from pathlib import Path

import pytest
from validation.motion_concealed.plants import plant

from lagnet.diagnosis.motion.diagnose import diagnose_motion

LONG = 16.0  # [s] of a recording


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "index", "kind", "effect", "told"),
    [
        (3301, 34, "leg", "joint_elasticity", [("joint_elasticity", "lower")]),
        (2601, 101, "pendulum", "static_friction", [("static_friction", "lower")]),
        (2701, 35, "leg", "static_friction", [("static_friction", "upper")]),
        (2601, 27, "leg", "torque_ripple", []),
        (2701, 47, "leg", "fading_gain", []),
    ],
    ids=[
        "elasticity, not at the joint before it",
        "a held-out event of stick and slip",
        "a slope of stick and slip that promises a trend",
        "a ripple over one joint's angle, no surface",
        "a gain that fades, beside a drag",
    ],
)
def test_it_is_told_as_what_it_is(seed: int, index: int, kind: str, effect: str, told: list, tmp_path: Path):
    case = plant(seed, index, kind, effect, LONG, tmp_path)
    found = diagnose_motion(case.recordings[:2], case.robot, case.recordings[2:], servo=case.servo)
    assert [(e.effect, e.joint) for e in found.effects] == told
