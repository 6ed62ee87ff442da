"""`lagnet diagnose --replay ENGINE`: held-out recordings through the user's simulator, before and after correction."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from lagnet.errors import LagnetError

if TYPE_CHECKING:
    from lagnet.diagnosis.diagnose import Diagnosis
    from lagnet.diagnosis.motion.diagnose import MotionDiagnosis
    from lagnet.reports.contents.replay_data import ReplayData
    from lagnet.simulators.replay import ReplaySettings

TOTAL, LONGEST, SHORTEST = 60.0, 30.0, 2.0  # [s] replayed of all recordings together; of one, at most and at least


def replay_settings(
    engine: str | None, model: Any, kp: str | None, kd: str | None, on_motion: bool
) -> ReplaySettings | None:
    """How held-out recordings are replayed, once the engine has taken the nominal model; None where none is given.

    Raises:
        LagnetError: an unknown engine, a model without bodies, only one of the gains, gains without an engine, or gains
            for a diagnosis on motion, which finds them.
        MissingExtraError: the engine is not installed.
    """
    if engine is None:
        if kp or kd:
            raise LagnetError("gains are those of a replay", where="--kp, --kd", next_step="give --replay too")
        return None
    if on_motion and (kp or kd):
        what = "a diagnosis on motion finds the gains of servos"
        raise LagnetError(what, where="--kp, --kd", next_step="give nominal ones with --actuator")
    from lagnet.cli.shared.replays import servo_of
    from lagnet.models.corrected.servo_driven import ServoDrivenModel
    from lagnet.simulators.replay import ReplaySettings, started

    settings = ReplaySettings(engine=engine, servo=servo_of(kp, kd))
    with started(model.nominal if isinstance(model, ServoDrivenModel) else model, settings):
        return settings


def replay_held_out(result: Diagnosis | MotionDiagnosis, settings: ReplaySettings, out: Path) -> ReplayData:
    """Replays, writes `replay.json` and `replay.parquet`, and says errors and horizons.

    Raises:
        LagnetError: no held-out recording is long enough, or commands without the servo's gains.
    """
    from dataclasses import replace

    from lagnet.cli.shared.console import say
    from lagnet.cli.shared.replays import say_replay
    from lagnet.reports.contents.replay_data import ReplayData
    from lagnet.simulators.before_after import before_and_after, columns_of, write_replay

    held = list(result.holdout_recordings)
    say(f"replaying held-out recordings in {settings.engine}")
    longest = min(LONGEST, max(SHORTEST, TOTAL / len(held)))
    nominal: Any = result.corrected.nominal  # the engine took it before the diagnosis
    replayed = before_and_after(result.corrected, held, replace(settings, longest=longest), nominal)
    write_replay(replayed, out)
    say_replay(replayed)
    return ReplayData(replayed.to_json(), columns_of(replayed))
