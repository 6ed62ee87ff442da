"""How claims of the concealed study are held against the joints of what was hidden."""

from __future__ import annotations

from types import SimpleNamespace as Some

import pytest
from validation.concealed.fair_names import Claim
from validation.concealed.scoring import _joints


def claim(effect: str, joint: str, *tied: str) -> Claim:
    return Claim(effect, joint, tied, {})


PLAN = Some(hidden=(Some(effect="asymmetric_friction", joint="elbow"),))
HALVES = [
    claim("coulomb_friction", "elbow", "asymmetric_friction"),
    claim("torque_offset", "elbow", "asymmetric_friction"),
]


@pytest.mark.parametrize(
    ("claims", "pairs", "expected"),
    [
        (HALVES, {0: (0, "tied")}, (2, 2)),  # both halves of a tie stand where it was hidden
        ([claim("asymmetric_friction", "wrist")], {}, (0, 1)),
        ([*HALVES, claim("asymmetric_friction", "wrist")], {0: (0, "tied")}, (2, 3)),
        ([claim("payload", "wrist")], {}, (0, 0)),  # names nothing that was hidden: no matter of joints
    ],
)
def test_a_claim_that_names_what_was_hidden_must_stand_on_its_joint(claims, pairs, expected) -> None:
    assert _joints(PLAN, claims, pairs) == expected  # pyright: ignore[reportArgumentType]
