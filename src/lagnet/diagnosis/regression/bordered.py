"""E(S ∪ {k}) of a joint for all additions k at once, from one factorisation of the system of S.

With A = G_SS + r diag G_SS = L Lᵀ, B = L⁻¹ G_Sk and a border of its own C = G_kk + r diag G_kk, the Schur complement
C − BᵀB gives φ of the added columns and θ_S = θ₀ − L⁻ᵀB φ: what a solution of the whole system gives, for the price of
a product with each column more. Source: Golub and Van Loan, Matrix Computations, section 4.2 (block Cholesky).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.regression.cross_validation import RIDGE

NOTHING = 1e-200  # power of a column without content


@dataclass(frozen=True, eq=False)
class Additions:
    """Squared errors and coefficients of a selection with each of several additions.

    Args:
        errors: shape (m,), on blocks left out of the fit, summed [N² m²].
        base: shape (m, k), coefficients of the columns of the selection, from all blocks.
        added: shape (m, w), those of the added columns.
    """

    errors: np.ndarray
    base: np.ndarray
    added: np.ndarray


class BorderedSystems:
    """The normal equations of one joint, without each fold in turn and last with all, columns scaled to unit power."""

    def __init__(self, total: np.ndarray, folds: np.ndarray):
        """Scales them once.

        Args:
            total: shape (K + 1, K + 1), with the residual last.
            folds: shape (n_folds, K + 1, K + 1).
        """
        grams = np.concatenate([total[None] - folds, total[None]])
        power = np.diagonal(grams, axis1=1, axis2=2)
        scale = np.where(
            power > NOTHING, 1.0 / np.sqrt(np.maximum(power, NOTHING)), 0.0
        )  # no content: coefficient zero
        scale[:, -1] = 1.0
        self._scale = scale[-1]
        self._systems = grams * scale[:, :, None] * scale[:, None, :]
        self._folds = folds * scale[:-1, :, None] * scale[:-1, None, :]

    def with_additions(self, base: np.ndarray, added: np.ndarray) -> Additions:
        """What `joint_loss` gives for a selection's columns with each of several additions of one width.

        Args:
            base: shape (k,), columns of the selection.
            added: shape (m, w), columns of each addition.
        """
        rows = self._systems[:, base]
        root = np.linalg.inv(np.linalg.cholesky(rows[:, :, base] + RIDGE * np.eye(base.size)))  # L⁻¹
        half = root @ rows  # L⁻¹ [G_S·, m_S]
        solved = root.transpose(0, 2, 1) @ half  # A⁻¹ [G_S·, m_S]
        parts = half.transpose(0, 2, 1)[:, added]  # Bᵀ, shape (n_folds + 1, m, w, k)
        border = self._systems[:, added[:, :, None], added[:, None, :]] + RIDGE * np.eye(added.shape[1])
        border -= parts @ parts.swapaxes(2, 3)
        wanted = self._systems[:, added, -1] - (parts @ half[:, None, :, -1:])[..., 0]
        phi = np.linalg.solve(border, wanted[..., None])[..., 0]
        way = -(phi[:, :, None, :] @ solved.transpose(0, 2, 1)[:, added])[:, :, 0]  # of θ_S, shape (n_folds + 1, m, k)
        start = solved[..., -1]
        errors = self._errors(base, added, start[:-1], way[:-1], phi[:-1])
        return Additions(errors, (start[-1] + way[-1]) * self._scale[base], phi[-1] * self._scale[added])

    def _errors(
        self, base: np.ndarray, added: np.ndarray, start: np.ndarray, way: np.ndarray, phi: np.ndarray
    ) -> np.ndarray:
        """Σ over folds of E(θ₀) + 2 dᵀ∇ + dᵀG d, for d the change of the selection's and the added coefficients."""
        folds = self._folds
        rows = folds[:, base]
        gradient = (start[:, None] @ rows)[:, 0] - folds[:, -1]  # G θ₀ − m at all columns, shape (n_folds, K + 1)
        before = folds[:, -1, -1] + np.sum(start * (gradient[:, base] - folds[:, -1, base]), axis=1)
        slope = np.sum(phi * gradient[:, added], axis=2) + (way @ gradient[:, base, None])[..., 0]
        across = (phi[:, :, None, :] @ rows.transpose(0, 2, 1)[:, added])[:, :, 0]
        own = phi[:, :, None, :] @ folds[:, added[:, :, None], added[:, None, :]] @ phi[..., None]
        bent = own[..., 0, 0] + np.sum(way * (2.0 * across + way @ rows[:, :, base]), axis=2)
        return np.sum(before[:, None] + 2.0 * slope + bent, axis=0)
