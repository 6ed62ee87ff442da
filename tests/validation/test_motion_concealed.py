"""Plants of the concealed study on motion are the arms that the diagnosis is given, but for what is hidden."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from validation.motion_concealed.plants import ENCODER, LISTED, SERVO, UNLISTED, Cause, plant
from validation.motion_concealed.study import figures, judge, scored

from lagnet.diagnosis.verdict.verdict import EffectEvidence, EffectFound, NamedParameter
from lagnet.models.corrected.servo_driven import ServoDrivenModel

SECONDS = 20.0


def claim(effect: str, joint: str = "lower", tied: tuple[str, ...] = (), **values: float) -> EffectFound:
    parameters = tuple(NamedParameter(n, x, "", (0.9 * x, 1.1 * x)) for n, x in values.items())
    return EffectFound(effect, joint, "named", tied, parameters, EffectEvidence(1.0, 0.0, 1.0, None, None), "")


def told(cause: Cause | None, *claims: EffectFound) -> dict:
    return scored("one", cause, ("lower",), claims)


def test_a_leg_that_hides_nothing_moves_as_its_nominal_model(tmp_path):
    case = plant(3, 1, "leg", None, SECONDS, tmp_path)
    model = ServoDrivenModel(case.robot, case.servo.laws, (True, True))
    recording = case.recordings[0]
    q = model.rollout(np.array(recording.command), recording.time, recording.q[0], step=0.001)
    assert np.sqrt(np.mean((q - recording.q) ** 2)) < 3.0 * ENCODER  # two integrators and nearly rigid friction


def error_of_the_nominal_model(effect: str | None, folder: Path, index: int = 3) -> float:
    """Root mean square between a pendulum's recording and the nominal rollout [rad]."""
    case = plant(3, index, "pendulum", effect, SECONDS, folder)
    recording = case.recordings[0]
    nominal = ServoDrivenModel(case.robot, case.servo.laws, (True,))
    q = nominal.rollout(np.array(recording.command), recording.time, recording.q[0], step=0.001)
    return float(np.sqrt(np.mean((q - recording.q) ** 2)))


@pytest.fixture(scope="module")
def error_where_nothing_is_hidden(tmp_path_factory) -> float:
    return error_of_the_nominal_model(None, tmp_path_factory.mktemp("free"))


@pytest.mark.parametrize("effect", [*LISTED, *UNLISTED])
def test_every_cause_moves_the_plant_otherwise(effect, error_where_nothing_is_hidden, tmp_path, monkeypatch):
    sizes = LISTED if effect in LISTED else UNLISTED
    parameter, low, high = sizes[effect]
    large = low if effect in ("gain_error", "joint_elasticity") else high
    monkeypatch.setitem(sizes, effect, (parameter, large, large))
    assert error_of_the_nominal_model(effect, tmp_path) > 1.5 * error_where_nothing_is_hidden


def test_a_cause_is_found_by_its_name_or_by_few_ties_at_its_joint():
    cause = Cause("dead_band", 0, "b", 0.03)
    right = told(cause, claim("dead_band", b=0.033))
    assert right["found"]
    assert right["wrong"] == []
    assert right["error"] == pytest.approx(0.1)
    assert right["covered"]
    assert told(cause, claim("static_friction", tied=("dead_band",)))["found"]
    assert not told(cause, claim("a", tied=("b", "c", "dead_band")))["found"]
    assert told(cause, claim("dead_band", joint="upper", b=0.03))["wrong"] == ["dead_band at upper"]


def test_a_claim_where_nothing_listed_is_hidden_is_wrong():
    rows = [told(None, claim("dead_band", b=SERVO["kp"])), told(Cause("joint_spring", 0, "k", 1.0))]
    found = figures(rows)
    assert found["claims_where_nothing_is_hidden"] == found["wrong_claims"] == 1
    assert found["claims_of_unlisted_physics"] == 0
    assert not judge(found)["claims_where_nothing_is_hidden"]
