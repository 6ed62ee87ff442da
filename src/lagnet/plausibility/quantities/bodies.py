"""Bodies of a model that has any: masses, centres of mass, moments of inertia, and how far the arm reaches."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.plausibility.check import NotApplicable
from lagnet.plausibility.subject import Subject
from lagnet.rigid_body.inertia import tensor_about_com, tensor_about_origin

LEAST_INERTIA = 1e-14  # [kg m²] a hundredth of a gram square millimetre: less than any link that moves has


@dataclass(frozen=True, eq=False)
class Body:
    """One rigid body.

    Args:
        name: of the link.
        joint: name of the joint that moves it, None for a link as the file gives it.
        mass: [kg].
        com: shape (3,), centre of mass from the origin of its frame [m].
        inertia: shape (3, 3), about its centre of mass [kg m²].
        parameters: shape (10,), m, m c, and moments about the origin: xx, xy, yy, xz, yz, zz.
    """

    name: str
    joint: str | None
    mass: float
    com: np.ndarray
    inertia: np.ndarray
    parameters: np.ndarray

    @property
    def moments(self) -> np.ndarray:
        """Principal moments about the centre of mass, ascending, shape (3,), [kg m²]."""
        return np.linalg.eigvalsh(self.inertia)

    @property
    def has_inertia(self) -> bool:
        """Whether its moments of inertia were given at all."""
        return bool(np.abs(self.inertia).max() > LEAST_INERTIA)

    @property
    def radius_of_gyration(self) -> float:
        """Root mean square distance of its mass from its centre of mass [m]; nan without mass."""
        if self.mass <= 0:
            return float("nan")
        return float(np.sqrt(max(np.trace(self.inertia), 0.0) / (2 * self.mass)))

    def where(self) -> dict[str, Any]:
        """The place in words."""
        return {"link": self.name} | ({"joint": self.joint} if self.joint else {})


def moving_bodies(subject: Subject) -> list[Body]:
    """The body behind each joint, with what is welded to it.

    Raises:
        NotApplicable: the model is not made of bodies.
    """
    if not subject.offers("inertial_parameters"):
        raise NotApplicable("the model is not made of bodies (URDF or MJCF)")
    links = getattr(subject.model, "links", subject.joints)
    rows = np.asarray(subject.model.inertial_parameters(), dtype=float)
    return [body(str(n), str(j), row) for n, j, row in zip(links, subject.joints, rows, strict=True)]


def file_links(subject: Subject) -> list[Body]:
    """The links as the file gives them; the moving bodies where the model has no file."""
    given = getattr(subject.model, "link_inertials", None)
    return [body(str(n), None, row) for n, row in given] if given else moving_bodies(subject)


def every_body(subject: Subject) -> Iterator[Body]:
    """The links of the file, then the moving bodies."""
    moving = moving_bodies(subject)
    if getattr(subject.model, "link_inertials", None):
        yield from file_links(subject)
    yield from moving


def body(name: str, joint: str | None, parameters: np.ndarray) -> Body:
    """A body from ten parameters about the origin of its frame."""
    mass, first = float(parameters[0]), np.asarray(parameters[1:4], dtype=float)
    about_com = tensor_about_com(parameters) if mass else tensor_about_origin(parameters)
    return Body(
        name, joint, mass, first / mass if mass else np.zeros(3), about_com, np.asarray(parameters, dtype=float)
    )


def reach(subject: Subject) -> float:
    """Length of the arm, joint by joint to the tip [m]; nan where the model has no geometry."""
    if not subject.offers("skeleton"):
        return float("nan")
    points = np.asarray(subject.model.skeleton(np.zeros(subject.n_dof)), dtype=float)
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
