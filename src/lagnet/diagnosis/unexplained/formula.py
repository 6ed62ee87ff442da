"""r ≈ Σ_k c_k f_k(q, v, a, …): a formula of at most three readable terms for physics that is in no catalogue."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from lagnet.diagnosis.unexplained.predictability import Signals

MOST_TERMS = 3
LEAST_GAIN = 0.1  # of the residual's power on unseen motion, that a term must explain
SIMPLE = 0.5  # of the residual's power on unseen motion, that a formula must explain to be reported
NEGLIGIBLE = 0.02  # of the residual's scatter: a smaller constant is not written
BINS = 24  # of the median curve
FEW = 8  # samples below which a bin draws no point
ANGLES = (1.0, 2.0)  # of q, whose sine and cosine are tried


@dataclass(frozen=True, eq=False)
class RemainderShape:
    """A residual against the signal that predicts it best.

    Args:
        signal: its name, such as v_4.
        value, residual: shape (n,), on held-out samples; the residual in [N m or N].
        curve: shape (m, 2), median residual over bins of the signal.
        formula: a few terms that predict the residual, in SI units; None where no simple one does.
        share: of the residual's power that the formula predicts on held-out motion, 0 to 1.
    """

    signal: str
    value: np.ndarray
    residual: np.ndarray
    curve: np.ndarray
    formula: str | None
    share: float


@dataclass(frozen=True, eq=False)
class _Term:
    words: str
    seen: np.ndarray
    unseen: np.ndarray


def find_shape(
    signals: tuple[Signals, Signals],
    residuals: tuple[np.ndarray, np.ndarray],
    depends_on: tuple[str, ...],
    slow: np.ndarray,
) -> RemainderShape:
    """The shape of a joint's residual and, where a few terms hold it, a formula.

    Args:
        signals, residuals: on fit and on held-out samples that count.
        depends_on: names of the signals that predict the residual, strongest first.
        slow: shape (dof,), speed below which the sign of a velocity is blurred [rad/s].
    """
    value = signals[1].of(depends_on[0])
    formula, share = _formula(_terms(signals, depends_on, slow), *residuals)
    return RemainderShape(depends_on[0], value, residuals[1], _median_curve(value, residuals[1]), formula, share)


def _terms(signals: tuple[Signals, Signals], names: tuple[str, ...], slow: np.ndarray) -> list[_Term]:
    """Readable functions of one signal, and products of two."""
    plain = [_Term(n, *(s.of(n) for s in signals)) for n in names]
    terms = [term for base in plain for term in _of_one(base, slow)]
    terms += [_product(a, b) for a, b in combinations(plain, 2)]
    signs = [_sign(base, slow) for base in plain if base.words.startswith("v_")]
    return terms + signs + [_product(s, b) for s in signs for b in plain if b.words not in s.words]


def _of_one(base: _Term, slow: np.ndarray) -> list[_Term]:
    x, y, name = base.seen, base.unseen, base.words
    out = [base, _Term(f"{name}²", x**2, y**2), _Term(f"{name}³", x**3, y**3), _Term(f"|{name}|", np.abs(x), np.abs(y))]
    out.append(_Term(f"{name}·|{name}|", x * np.abs(x), y * np.abs(y)))
    if name.startswith("q_"):
        for n in ANGLES:
            times = "" if n == 1.0 else f"{n:g}"
            out.append(_Term(f"sin({times}{name})", np.sin(n * x), np.sin(n * y)))
            out.append(_Term(f"cos({times}{name})", np.cos(n * x), np.cos(n * y)))
    return out


def _sign(base: _Term, slow: np.ndarray) -> _Term:
    blur = slow[int(base.words.split("_")[1])]
    return _Term(f"sign({base.words})", np.tanh(base.seen / blur), np.tanh(base.unseen / blur))


def _product(one: _Term, other: _Term) -> _Term:
    return _Term(f"{one.words}·{other.words}", one.seen * other.seen, one.unseen * other.unseen)


def _formula(terms: list[_Term], seen: np.ndarray, unseen: np.ndarray) -> tuple[str | None, float]:
    """Greedy forward selection of terms, while each explains enough of the residual on unseen motion."""
    chosen: list[_Term] = []
    share, power = 0.0, max(float(np.mean(unseen**2)), 1e-300)
    for _ in range(MOST_TERMS):
        shares = [1.0 - _error([*chosen, t], seen, unseen) / power for t in terms]
        best = int(np.argmax(shares))
        if shares[best] < share + LEAST_GAIN:
            break
        chosen, share = [*chosen, terms[best]], shares[best]
    if share < SIMPLE:
        return None, max(share, 0.0)
    return _written(chosen, _fitted(chosen, seen), NEGLIGIBLE * float(np.std(seen))), share


def _fitted(terms: list[_Term], seen: np.ndarray) -> np.ndarray:
    table = np.column_stack([*(t.seen for t in terms), np.ones_like(seen)])
    return np.linalg.lstsq(table, seen, rcond=1e-10)[0]


def _error(terms: list[_Term], seen: np.ndarray, unseen: np.ndarray) -> float:
    table = np.column_stack([*(t.unseen for t in terms), np.ones_like(unseen)])
    return float(np.mean((unseen - table @ _fitted(terms, seen)) ** 2))


def _written(terms: list[_Term], factors: np.ndarray, least: float) -> str:
    parts = [(f, t.words) for f, t in zip(factors[:-1], terms, strict=True)]
    if abs(factors[-1]) > least:
        parts.append((factors[-1], ""))
    text = ""
    for factor, words in parts:
        sign = ("−" if factor < 0 else "") if not text else (" − " if factor < 0 else " + ")
        text += f"{sign}{abs(factor):.3g}{' ' if words else ''}{words}"
    return text


def _median_curve(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Median residual over bins of equal width of the signal, shape (m, 2)."""
    edges = np.linspace(float(np.min(x)), float(np.max(x)) + 1e-12, BINS + 1)
    bins = np.digitize(x, edges) - 1
    rows = [bins == k for k in range(BINS)]
    points = [(np.median(x[r]), np.median(y[r])) for r in rows if np.count_nonzero(r) >= FEW]
    return np.array(points).reshape(-1, 2)
