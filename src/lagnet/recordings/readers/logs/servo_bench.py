"""Logs of one servo on a test bench: JSON with `kp` and `entries` of goal and measured position.

Source: Robotis e-Manual (XL330: PWM counts from -885 to 885, sent as 16 bits).
"""

from __future__ import annotations

import json

import numpy as np

from lagnet.errors import RecordingError
from lagnet.recordings.readers.logs.log_source import LogSource, Origin
from lagnet.recordings.sampling import median_step

ORIGIN = Origin("servo-bench log", "JSON with the keys kp and entries", "the timestamps of its entries", effort="")
FULL_PWM = {"xl330": 885.0}  # counts of full voltage, by motor
SIGNALS = {
    "timestamp": "time",
    "position": "q_0",
    "speed": "v_0",
    "goal_position": "command_0",
    "torque_enable": "enabled_0",
    "temp": "temperature_0",
    "input_volts": "voltage_0",
    "load": "duty_0",
}
NEEDED = ("timestamp", "position", "goal_position")
MAX_BYTES = 128 * 1024**2
WORD = 65536  # of 16 bits
LONGEST_STEP = 10.0  # [s] a median step beyond it counts microseconds


def open_servo_bench(data: bytes, where: str) -> LogSource:
    """Read one servo's log.

    Raises:
        RecordingError: no JSON, other keys, or entries that are no numbers.
    """
    if len(data) > MAX_BYTES:
        raise RecordingError("is too long for a JSON log", where=where, next_step="split it into shorter recordings")
    try:
        content = json.loads(data)
    except (ValueError, RecursionError, UnicodeDecodeError) as error:
        raise RecordingError(
            f"is no valid JSON ({str(error)[:80]})", where=where, next_step="copy it again or record again"
        ) from None
    entries = content.get("entries") if isinstance(content, dict) else None
    if not isinstance(entries, list) or "kp" not in content or not entries:
        raise RecordingError(
            "is JSON without the keys kp and entries", where=where, next_step="give a servo-bench log or a table"
        )
    raw = {name: _column(entries, name, where) for name in SIGNALS if name in (entries[0] or {})}
    lacking = [name for name in NEEDED if name not in raw]
    if lacking:
        raise RecordingError(f"its entries have no {lacking[0]}", where=where)
    columns = {SIGNALS[name]: values for name, values in raw.items()}
    told = _mend(columns, str(content.get("motor", "")).lower())
    return LogSource(ORIGIN, columns, None, where, warnings=told)


def _column(entries: list, name: str, where: str) -> np.ndarray:
    found = np.empty(len(entries))
    for k, entry in enumerate(entries):
        value = entry.get(name) if isinstance(entry, dict) else None
        if not isinstance(value, (bool, int, float)) or abs(value) > 1e300:
            raise RecordingError(
                f"entry {k + 1}: {name} is {_short(value)}, not a number", where=where, next_step="correct or remove it"
            )
        found[k] = value
    return found


def _short(value: object) -> str:
    return "missing" if value is None else repr(value)[:40]


def _mend(columns: dict[str, np.ndarray], motor: str) -> tuple[str, ...]:
    """Microseconds to seconds, words of 16 bits to signed numbers, counts to duty; what must be told."""
    told = []
    time = columns["time"]
    if time.size > 1 and median_step(time) > LONGEST_STEP:
        columns["time"] = time / 1e6
        told.append("the clock counts microseconds")
    for name in ("v_0", "duty_0"):
        values = columns.get(name)
        if values is not None and values.max() >= WORD / 2 and np.all(values == np.round(values)):
            columns[name] = np.where(values >= WORD / 2, values - WORD, values)
            told.append(f"{name} was sent as 16 bits without sign: 65535 is -1")
    if "duty_0" in columns:
        full = next((counts for name, counts in FULL_PWM.items() if name in motor), None)
        if full is None:
            columns["load_counts"] = columns.pop("duty_0")
            told.append(
                f"the scale of load is not known for the motor {motor or 'that is not stated'}: not read as duty"
            )
        else:
            columns["duty_0"] = columns["duty_0"] / full
    return tuple(told)
