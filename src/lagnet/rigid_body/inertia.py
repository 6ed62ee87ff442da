"""Which ten numbers can be a body: pseudo-inertia, log-Cholesky coordinates, and the best body for a quadratic cost.

A body's parameters π = (m, m c_x, m c_y, m c_z, I_xx, I_xy, I_yy, I_xz, I_yz, I_zz), the tensor about the frame's
origin, make the pseudo-inertia J = [[Σ, m c], [(m c)ᵀ, m]] with Σ = ½ tr(I) 1 - I, the second moment of its mass. A
distribution of positive mass has these parameters exactly if J is positive definite; that holds the triangle inequality
of the principal moments as well. Sources: Wensing 2018; Rucker 2022.
"""

from __future__ import annotations

import numpy as np

PARAMETER_NAMES = ("m", "mc_x", "mc_y", "mc_z", "I_xx", "I_xy", "I_yy", "I_xz", "I_yz", "I_zz")
BODY = len(PARAMETER_NAMES)  # numbers that a body is
_TENSOR = np.tril_indices(3)  # I_xx, I_xy, I_yy, I_xz, I_yz, I_zz: the lower triangle by rows


def tensor_about_origin(parameters: np.ndarray) -> np.ndarray:
    """Rotational inertia about the frame's origin, shape (…, 3, 3), from parameters (…, 10)."""
    parameters = _ten(parameters)
    tensor = np.empty((*parameters.shape[:-1], 3, 3))
    tensor[..., _TENSOR[0], _TENSOR[1]] = parameters[..., 4:]
    tensor[..., _TENSOR[1], _TENSOR[0]] = parameters[..., 4:]
    return tensor


def tensor_about_com(parameters: np.ndarray) -> np.ndarray:
    """Rotational inertia about the centre of mass, shape (…, 3, 3); the mass must not be zero."""
    parameters = _ten(parameters)
    mass, moment = parameters[..., :1, None], parameters[..., 1:4]
    square = np.sum(moment**2, axis=-1)[..., None, None] * np.eye(3)
    return tensor_about_origin(parameters) - (square - moment[..., :, None] * moment[..., None, :]) / mass


def parameters_of_body(mass: float, com: np.ndarray, tensor: np.ndarray) -> np.ndarray:
    """Ten parameters of a body from its mass [kg], centre of mass (3,) [m] and tensor (3, 3) about it [kg m²]."""
    com = np.asarray(com, dtype=float)
    about_origin = np.asarray(tensor, dtype=float) + mass * (com @ com * np.eye(3) - np.outer(com, com))
    return np.array([mass, *(mass * com), *about_origin[_TENSOR]])


def pseudo_inertia(parameters: np.ndarray) -> np.ndarray:
    """Pseudo-inertia J, shape (…, 4, 4), from parameters (…, 10)."""
    parameters = _ten(parameters)
    tensor = tensor_about_origin(parameters)
    matrix = np.empty((*parameters.shape[:-1], 4, 4))
    matrix[..., :3, :3] = 0.5 * np.trace(tensor, axis1=-2, axis2=-1)[..., None, None] * np.eye(3) - tensor
    matrix[..., :3, 3] = matrix[..., 3, :3] = parameters[..., 1:4]
    matrix[..., 3, 3] = parameters[..., 0]
    return matrix


def from_pseudo_inertia(matrix: np.ndarray) -> np.ndarray:
    """Parameters (…, 10) of a pseudo-inertia (…, 4, 4)."""
    matrix = np.asarray(matrix, dtype=float)
    if matrix.shape[-2:] != (4, 4):
        raise ValueError(f"pseudo-inertia has shape {matrix.shape}, expected (…, 4, 4)")
    second = matrix[..., :3, :3]
    tensor = np.trace(second, axis1=-2, axis2=-1)[..., None, None] * np.eye(3) - second
    return np.concatenate([matrix[..., 3, 3:], matrix[..., :3, 3], tensor[..., _TENSOR[0], _TENSOR[1]]], axis=-1)


def principal_moments(parameters: np.ndarray) -> np.ndarray:
    """Principal moments about the centre of mass, ascending, shape (…, 3), [kg m²]; the mass must not be zero."""
    return np.linalg.eigvalsh(tensor_about_com(parameters))


def triangle_inequality(parameters: np.ndarray) -> np.ndarray:
    """(I_1 + I_2 - I_3) / I_3 of the ascending principal moments, shape (…,): negative where no mass can be so laid."""
    moments = principal_moments(parameters)
    return (moments[..., 0] + moments[..., 1] - moments[..., 2]) / np.maximum(moments[..., 2], np.finfo(float).tiny)


def least_density(parameters: np.ndarray) -> np.ndarray:
    """Density [kg/m³] that a body must reach somewhere to have these parameters, shape (…,); inf for a point mass.

    Of all bodies of one mass and no more than one density a ball has the smallest moments about its centre: the density
    is that of the ball of the same mass m and the same ½ tr I = ⅗ m R².
    """
    mass = _ten(parameters)[..., 0]
    spread = 0.5 * np.trace(tensor_about_com(parameters), axis1=-2, axis2=-1) / mass
    with np.errstate(divide="ignore"):
        return mass / (4.0 / 3.0 * np.pi * np.maximum(5.0 / 3.0 * spread, 0.0) ** 1.5)


def smallest_eigenvalue(parameters: np.ndarray) -> np.ndarray:
    """Smallest eigenvalue of the pseudo-inertia, over its trace, shape (…,): positive exactly for a real body.

    The ratio is in the units given (m in kg, lengths in m); its sign alone is free of them.
    """
    matrix = pseudo_inertia(parameters)
    scale = np.maximum(np.abs(np.trace(matrix, axis1=-2, axis2=-1)), np.finfo(float).tiny)
    return np.linalg.eigvalsh(matrix)[..., 0] / scale


def is_physically_consistent(parameters: np.ndarray, margin: float = 0.0) -> np.ndarray:
    """Whether some distribution of positive mass has these parameters, shape (…,).

    Args:
        parameters: shape (…, 10).
        margin: least eigenvalue asked of J after scaling it to a unit diagonal, which makes it free of units; a small
            negative one lets rounded flat or thin bodies pass.
    """
    matrix = pseudo_inertia(parameters)
    diagonal = np.diagonal(matrix, axis1=-2, axis2=-1)
    positive = np.all(diagonal > 0, axis=-1) if margin >= 0 else np.all(diagonal >= 0, axis=-1)
    scale = np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
    least = np.linalg.eigvalsh(matrix / (scale[..., :, None] * scale[..., None, :]))[..., 0]
    return positive & (least > margin)


def from_log_cholesky(theta: np.ndarray) -> np.ndarray:
    """Parameters (10,) of log-Cholesky coordinates θ = (α, d_1, d_2, d_3, s_12, s_23, s_13, t_1, t_2, t_3).

    Every θ is a body and every body has one θ, so that a fit in θ needs no constraint. Source: Rucker 2022.
    """
    factor = _factor(theta)
    return from_pseudo_inertia(factor @ factor.T)


def to_log_cholesky(parameters: np.ndarray) -> np.ndarray:
    """Log-Cholesky coordinates (10,) of a physically consistent body.

    Raises:
        ValueError: the pseudo-inertia is not positive definite.
    """
    matrix = pseudo_inertia(parameters)
    try:
        factor = np.linalg.cholesky(matrix[::-1, ::-1])[::-1, ::-1]  # the upper factor U with J = U Uᵀ
    except np.linalg.LinAlgError:
        raise ValueError("not a physically consistent body: its pseudo-inertia is not positive definite") from None
    u = factor / factor[3, 3]
    return np.array(
        [np.log(factor[3, 3]), *np.log(np.diag(u)[:3]), u[0, 1], u[1, 2], u[0, 2], u[0, 3], u[1, 3], u[2, 3]]
    )


def log_cholesky_jacobian(theta: np.ndarray) -> np.ndarray:
    """∂π/∂θ, shape (10, 10)."""
    factor, columns = _factor(theta), []
    scale = np.exp(theta[0])
    places = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
    changes = [factor]
    for k, (row, column) in enumerate(places):
        change = np.zeros((4, 4))
        change[row, column] = factor[row, column] if k < 3 else scale
        changes.append(change)
    for change in changes:
        half = change @ factor.T
        columns.append(from_pseudo_inertia(half + half.T))
    return np.stack(columns, axis=1)


def _factor(theta: np.ndarray) -> np.ndarray:
    theta = _ten(theta)
    alpha, d1, d2, d3, s12, s23, s13, t1, t2, t3 = theta
    rows = [[np.exp(d1), s12, s13, t1], [0, np.exp(d2), s23, t2], [0, 0, np.exp(d3), t3], [0, 0, 0, 1.0]]
    return np.exp(alpha) * np.array(rows)


def _ten(values: np.ndarray) -> np.ndarray:
    values = np.asarray(values, dtype=float)
    if values.ndim == 0 or values.shape[-1] != 10:
        raise ValueError(f"parameters have shape {values.shape}, expected (…, 10)")
    return values
