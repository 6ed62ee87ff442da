"""One clock for torque and motion.

A torque that is held between samples acts, on average, half a sample later than its stamp, and a log may stamp the
torque of one control cycle beside the motion of the next. Such a shift is shared by all joints and says how the log was
made, not what an arm lacks. Where delays of half a sample are found and the joints without one agree, torques are read
that much later or earlier and all is judged again. A shift that other joints deny stays what it is: a delay.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from lagnet.diagnosis.search import PRICE
from lagnet.recordings.conditioning import Conditioned

if TYPE_CHECKING:
    from lagnet.diagnosis.inquiry import Inquiry

HELD = 0.6  # of a sample: delays up to this may come of torques that are held, or stamped a half cycle off
ALIKE = 0.25  # of the shift by which delays of single joints may differ from it
DELAY = "time_delay"


def on_one_clock(first: Inquiry, shifted: Callable[[float], Inquiry]) -> Inquiry:
    """The inquiry, or the one with torques read at other times where all joints share a shift within a sample.

    Args:
        shifted: an inquiry into the same recordings, torques read that much later [s].
    """
    delays = {e.joint: e.values["T"] for e in first.effects if e.effect == DELAY and e.joint is not None}
    small = [t for t in delays.values() if abs(t) <= HELD / first.fit.rate]
    if not small:
        return first
    shift = float(np.median(small))
    if any(abs(t - shift) > ALIKE * abs(shift) for t in small):
        return first
    second = shifted(shift)
    others = [j for j in range(first.problem.n_dof) if j not in delays]
    asked = PRICE * (2 - len(small))  # one shift in the place of many delays is worth what each of them cost
    return second if not others or _gain(first, second, others) > asked else first


def _gain(first: Inquiry, second: Inquiry, joints: list[int]) -> float:
    """Log evidence [nats] of joints that needed no delay for the second inquiry, on held-out motion."""
    samples = first.unseen.samples / first.found.scales.memory
    before, after = (
        np.maximum([left.power for left in one.leftovers], np.maximum(first.noise, 1e-12) ** 2 / 4)
        for one in (first, second)
    )
    return float(0.5 * np.sum((samples * np.log(before / after))[joints]))


def told_of_clock(fit: Conditioned) -> Iterator[str]:
    """A sentence where torques were read at other times than they are stamped with."""
    if fit.torque_shift:
        way = "later" if fit.torque_shift > 0 else "earlier"
        yield (
            f"at every joint the torque is stamped {1e3 * abs(fit.torque_shift):.2g} ms {way} than the motion that it "
            f"belongs to ({abs(fit.torque_shift) * fit.rate:.2g} of a sample), as when it is held from one sample to "
            "the next: torques were shifted by that before all else"
        )
