"""What a verdict says of its inputs: the nominal model and each recording."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from lagnet.recordings.recording import Recording

KINDS = ("urdf", "mjcf", "named_robot", "learned", "corrected")


def nominal_entry(model: Any, joints: Sequence[str]) -> dict[str, Any]:
    """Kind, source, checksum and joints of the nominal model."""
    kind = str(getattr(model, "kind", ""))
    return {
        "kind": kind if kind in KINDS else "learned",
        "source": str(getattr(model, "source", "") or type(model).__name__),
        "sha256": str(getattr(model, "sha256", "")),
        "joints": list(joints),
    }


def recording_entries(fit: Sequence[Recording], held: Sequence[Recording]) -> tuple[dict[str, Any], ...]:
    """Path, role, checksum, size and rate of each recording, fitted ones first."""
    roles = (*((r, "fit") for r in fit), *((r, "holdout") for r in held))
    return tuple(
        {
            "path": recording.path,
            "role": role,
            "sha256": recording.sha256,
            "n_samples": len(recording),
            "duration_s": recording.duration,
            "rate_hz": recording.rate,
        }
        for recording, role in roles
    )
