"""Pinocchio as an untyped module: it is compiled, and comes without type stubs. All of its uses go through here."""

from __future__ import annotations

from typing import Any

import pinocchio  # pyright: ignore[reportMissingImports]

pin: Any = pinocchio
Model = Any  # pinocchio.Model
Data = Any  # pinocchio.Data
Frame = Any  # pinocchio.Frame
Inertia = Any  # pinocchio.Inertia
JointModel = Any  # pinocchio.JointModel
SE3 = Any  # pinocchio.SE3, a rotation and a translation
