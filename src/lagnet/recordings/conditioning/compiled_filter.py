"""Second-order sections over many signals at once, compiled: one pass over time, in which each signal waits for none.

SciPy's filter takes one signal after the other, and each of its steps waits for the one before.
"""

from __future__ import annotations

from numba import njit


@njit(cache=True, error_model="numpy")
def run_sections(x, sections, settled, backwards):
    """Filter x in place along its first axis, as `scipy.signal.sosfilt` does, each signal settled on its first value.

    Args:
        x: shape (n, k), samples of k signals.
        sections: shape (s, 6), b0 b1 b2 1 a1 a2 of each second-order section.
        settled: shape (s, 2), state of the sections at rest on a signal of one.
        backwards: whether to begin with the last sample.
    """
    n, k = x.shape
    start = x[n - 1 if backwards else 0].copy()
    for s in range(len(sections)):
        b0, b1, b2, _, a1, a2 = sections[s]
        near, far = settled[s, 0] * start, settled[s, 1] * start
        for t in range(n):
            row = x[n - 1 - t if backwards else t]
            for i in range(k):
                y = b0 * row[i] + near[i]
                near[i] = b1 * row[i] - a1 * y + far[i]
                far[i] = b2 * row[i] - a2 * y
                row[i] = y
