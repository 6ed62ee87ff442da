"""What commands that replay recordings share: gains from their options, and errors and horizons on the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lagnet.errors import LagnetError

if TYPE_CHECKING:
    from lagnet.simulators.before_after import BeforeAfter
    from lagnet.simulators.replay import Servo


def say_replay(result: BeforeAfter) -> None:
    """Errors by joint and horizons, a line each."""
    from lagnet.cli.shared.console import say

    before, after = result.before, result.after
    for i, joint in enumerate(result.joints):
        mended = "" if after is None else f" before, {after.rmse()[i]:.3g} after"
        say(f"{joint}: error {before.rmse()[i]:.3g} {result.units[i]}{mended}")
    if before.horizon is None:
        return
    drive = "commands" if before.runs[0].commanded else "torques"
    unit = " or ".join(sorted(set(result.units), reverse=True))
    mended = "" if after is None or after.horizon is None else f" before, {after.horizon.median:.2f} s after"
    within = f"{before.settings.tolerance:g} {unit}"
    say(f"{drive} alone stay within {within} for {before.horizon.median:.2f} s{mended} (median)")


def servo_of(kp: str | None, kd: str | None) -> Servo | None:
    """Gains of a position controller, or None where none are given.

    Raises:
        LagnetError: only one of the two.
    """
    from lagnet.cli.shared.console import numbers
    from lagnet.simulators.replay import Servo

    if (kp is None) != (kd is None):
        raise LagnetError("a servo has both gains", where="--kp, --kd", next_step="give both, comma-separated")
    if kp is None or kd is None:
        return None
    return Servo(tuple(numbers(kp, "--kp")), tuple(numbers(kd, "--kd")))
