"""1 − E(plain terms)/E(0): predictable share of a residual by a few terms, which need less data than a forest."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lagnet.recordings.sampling import spread_rows

TERMS = 3  # that are taken together at most
ROWS = 3_000  # samples that they are chosen on
BETTER = 0.02  # of the residual's power that a term must explain


def sparse_share(
    names: tuple[str, ...], seen: np.ndarray, rest: np.ndarray, unseen: np.ndarray, test: np.ndarray
) -> tuple[float, tuple[str, ...]]:
    """1 − Σ (r − X w)² / Σ r² on unseen samples, for terms chosen and weighted on the seen ones, and their signals.

    A term is a signal, its size, square, sine or cosine, or one of these with the direction in which some joint moves.

    Args:
        names: of the columns, such as q_0 or v_3.
        seen, unseen: shape (n, k), (m, k), signals.
        rest, test: shape (n,), (m,), residual of one joint [N m].
    """
    rows = spread_rows(len(rest), ROWS)
    scale = np.maximum(np.abs(seen).max(axis=0), 1e-12)
    labels, table = _table(names, seen[rows] / scale)
    chosen = _chosen(table, rest[rows])
    if not chosen:
        return 0.0, ()
    weights, *_ = np.linalg.lstsq(table[:, chosen], rest[rows], rcond=1e-10)
    _, there = _table(names, unseen / scale)
    error = float(np.mean((test - there[:, chosen] @ weights) ** 2))
    signals = dict.fromkeys(s for i in chosen for s in labels[i])
    return float(np.clip(1.0 - error / max(float(np.mean(test**2)), 1e-300), 0.0, 1.0)), tuple(signals)


def _chosen(table: np.ndarray, rest: np.ndarray) -> list[int]:
    """Greedy forward selection: the column that explains most of the residual, again and again, while it is enough."""
    size = np.sqrt(np.sum(table**2, axis=0))
    usable, power = size > 0, float(np.sum(rest**2))
    chosen: list[int] = []
    left = rest
    for _ in range(TERMS):
        fit = np.where(usable, np.abs(table.T @ left) / np.where(usable, size, 1.0), 0.0)
        candidate = [*chosen, int(np.argmax(fit))]
        weights, *_ = np.linalg.lstsq(table[:, candidate], rest, rcond=1e-10)
        after = rest - table[:, candidate] @ weights
        if np.sum(left**2) - np.sum(after**2) <= BETTER * power:
            break
        chosen, left = candidate, after
    return chosen


def _table(names: tuple[str, ...], signals: np.ndarray) -> tuple[list[tuple[str, ...]], np.ndarray]:
    """Labels and columns of all terms, shape (n, n_terms); signals are at most one in size."""
    plain = [(label, column) for label, column in _plain(names, signals)]
    signs = [(n, np.sign(signals[:, k])) for k, n in enumerate(names) if n.startswith("v_")]
    directed = [((name, *label), sign * column) for name, sign in signs for label, column in plain]
    return [label for label, _ in (*plain, *directed)], np.column_stack([c for _, c in (*plain, *directed)])


def _plain(names: tuple[str, ...], signals: np.ndarray) -> Iterator[tuple[tuple[str, ...], np.ndarray]]:
    yield (), np.ones(len(signals))
    for k, name in enumerate(names):
        x = signals[:, k]
        if name.startswith("history") or name == "time":
            continue
        yield (name,), x
        yield (name,), np.abs(x)
        yield (name,), x**2
        if name.startswith("q_"):
            yield (name,), np.sin(np.pi * x)
            yield (name,), np.cos(np.pi * x)
