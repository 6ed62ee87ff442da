"""A description in lines for a terminal."""

from __future__ import annotations

from collections.abc import Iterator

from lagnet.recordings.inspection.describe import Description


def sentences(found: Description) -> Iterator[str]:
    """What was recognised, joints, signals, clock, gaps and warnings, a line each."""
    yield f"{found.path}: {found.origin.format}, recognised by {found.origin.recognised_by}"
    yield f"joints: {', '.join(found.joints) or 'not named'}"
    yield from _match(found)
    if found.guessed:
        yield f"columns: foreign names, {len(found.guessed)} were guessed; the mapping file holds the guess"
    if found.refused:
        yield f"refused as it stands: {found.refused}"
    recording = found.recording
    if recording is None:
        yield f"columns: {', '.join(found.columns[:40])}"
        return
    n = len(recording.trajectory_names)
    yield f"samples: {len(recording)} in {n} motion{'s' * (n > 1)}, {recording.duration:.4g} s, {recording.rate:.4g} Hz"
    for signal in found.signals:
        yield f"signal: {signal.kind} [{signal.unit}], {signal.least:.4g} to {signal.largest:.4g}"
    made = "recorded" if found.origin.clock_recorded else "made, not recorded"
    low, high = found.jitter
    yield f"clock: {made}, {found.origin.clock}; steps of {low:.3g} to {high:.3g} medians"
    for start, length in found.gaps:
        yield f"gap: {length:.4g} s after t = {start:.6g} s"
    for warning in recording.warnings:
        yield f"note: {warning}"


def _match(found: Description) -> Iterator[str]:
    match = found.match
    if match is None:
        return
    if match.ambiguous:
        yield f"robot: its joints fit {len(match.ambiguous)} sets of joints: {', '.join(match.ambiguous)}"
    elif match.complete:
        yield f"robot: all {len(match.index)} joints found by {match.how}"
    else:
        yield f"robot: {sum(k is not None for k in match.index)} of {len(match.index)} joints found"
    if match.unused:
        yield f"robot: has no joint {', '.join(match.unused)}"
