"""What makes the torque, and how much of it is left to the residual, in one sentence and four figures."""

from __future__ import annotations

import numpy as np

from lagnet.decomposition.decompose import Decomposition
from lagnet.reports.page import Section, section
from lagnet.reports.wording import effect_words, percent


def build(parts: Decomposition) -> Section:
    """The largest part, the residual, and the worst agreement."""
    shares = {name: float(np.mean(share)) for name, share in parts.shares.items()}
    largest = max(shares, key=lambda name: shares[name])
    residual, error = parts.shares["residual"], parts.total_error.nmse
    most, worst = int(np.argmax(residual)), int(np.argmax(error))
    tiles = [
        (percent(shares[largest]), f"of the torque is {effect_words(largest)} torque, on average over the joints"),
        (percent(max(float(residual[most]), 0.0)), f"is residual on {parts.joints[most]}, the joint with most of it"),
        (
            percent(float(error[worst])),
            f"error (nMSE) of {parts.joints[worst]} against what was measured, the largest",
        ),
    ]
    if parts.term_errors:
        name, joint = max(
            ((n, int(np.argmax(e.nmse))) for n, e in parts.term_errors.items() if n != "total"),
            key=lambda found: parts.term_errors[found[0]].nmse[found[1]],
        )
        value = float(parts.term_errors[name].nmse[joint])
        tiles.append(
            (
                percent(value),
                f"error (nMSE) of {effect_words(name)} torque of {parts.joints[joint]} against the reference",
            )
        )
    return section("decomposition_headline", "", tiles=tiles, differentiated=parts.motion_from != "recorded")
