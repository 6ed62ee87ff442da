"""The two arms of the Unitree G1 on a fixed torso, as URDF text.

The numbers are those of `robots/g1_description/g1_dual_arm.urdf` in github.com/unitreerobotics/unitree_ros
(BSD-3-Clause), whose right arm is the left one mirrored in the plane y = 0. The hands of the recorded robot (Inspire)
are another kind than the rubber hand there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

Triple = tuple[float, float, float]
Six = tuple[float, float, float, float, float, float]


@dataclass(frozen=True)
class Body:
    """Mass [kg], centre [m] and inertia about it [kg m²] (xx, xy, xz, yy, yz, zz)."""

    mass: float
    centre: Triple
    inertia: Six


@dataclass(frozen=True)
class Segment:
    """A joint of the left arm with the link behind it: place [m, rad], range [rad], limits [N m, rad/s]."""

    name: str
    axis: Triple
    xyz: Triple
    rpy: Triple
    lower: float
    upper: float
    effort: float
    velocity: float
    body: Body


X, Y, Z, NONE = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)
ARM = (
    Segment(
        "shoulder_pitch",
        Y,
        (0.0039563, 0.10022, 0.23778),
        (0.27931, 5.4949e-05, -0.00019159),
        -3.0892,
        2.6704,
        25,
        37,
        Body(0.718, (0.0, 0.035892, -0.011628), (4.291e-04, -9.2e-06, 6.4e-06, 4.53e-04, 2.26e-05, 4.23e-04)),
    ),
    Segment(
        "shoulder_roll",
        X,
        (0.0, 0.038, -0.013831),
        (-0.27925, 0.0, 0.0),
        -1.5882,
        2.2515,
        25,
        37,
        Body(0.643, (-0.000227, 0.00727, -0.063243), (6.177e-04, -1e-06, 8.7e-06, 6.912e-04, -5.3e-06, 3.894e-04)),
    ),
    Segment(
        "shoulder_yaw",
        Z,
        (0.0, 0.00624, -0.1032),
        NONE,
        -2.618,
        2.618,
        25,
        37,
        Body(
            0.734, (0.010773, -0.002949, -0.072009), (9.988e-04, 7.9e-06, 1.412e-04, 1.0605e-03, -2.86e-05, 4.354e-04)
        ),
    ),
    Segment(
        "elbow",
        Y,
        (0.015783, 0.0, -0.080518),
        NONE,
        -1.0472,
        2.0944,
        25,
        37,
        Body(0.6, (0.064956, 0.004454, -0.010062), (2.891e-04, 6.53e-05, 1.72e-05, 4.152e-04, -5.6e-06, 4.197e-04)),
    ),
    Segment(
        "wrist_roll",
        X,
        (0.1, 0.00188791, -0.01),
        NONE,
        -1.972222,
        1.972222,
        25,
        37,
        Body(
            0.08544498,
            (0.01713945, 0.00053759, 4.8864e-07),
            (4.821544e-05, -4.24511e-06, 5.10599e-09, 3.722899e-05, -1.23525e-09, 5.482107e-05),
        ),
    ),
    Segment(
        "wrist_pitch",
        Y,
        (0.038, 0.0, 0.0),
        NONE,
        -1.614430,
        1.614430,
        5,
        22,
        Body(
            0.48404956,
            (0.0229999, -0.00111685, -0.00111658),
            (1.657965e-04, -1.231207e-05, 1.231699e-05, 4.295406e-04, 8.141771e-07, 4.29537e-04),
        ),
    ),
    Segment(
        "wrist_yaw",
        Z,
        (0.046, 0.0, 0.0),
        NONE,
        -1.614430,
        1.614430,
        5,
        22,
        Body(
            0.08457647,
            (0.02200382, 0.00049485, 0.00053861),
            (4.929129e-05, -4.573549e-07, 4.458676e-06, 5.973338e-05, 4.32198e-07, 3.928084e-05),
        ),
    ),
)
HAND_AT = (0.0415, 0.003, 0.0)
HAND = Body(
    0.17,
    (0.05361311, -0.00295905, 0.00215413),
    (1.0099485e-04, 3.618591e-05, -7.430152e-07, 2.8135872e-04, 3.301897e-06, 2.189477e-04),
)


def g1_arms() -> str:
    """URDF of both arms, 14 joints, named as the maker names them."""
    return "\n".join(
        ['<robot name="g1_arms">', '<link name="torso"/>', *_side("left", 1.0), *_side("right", -1.0), "</robot>"]
    )


def _side(side: str, sign: float) -> list[str]:
    """Links and joints of one arm; a mirror turns the sign of y and of turns about x and z."""
    lines, parent = [], "torso"
    for part in ARM:
        rolls = part.axis != Y and sign < 0
        low, high = (-part.upper, -part.lower) if rolls else (part.lower, part.upper)
        turn = _text((sign * part.rpy[0], part.rpy[1], sign * part.rpy[2]))
        place = f'<origin xyz="{_mirrored(part.xyz, sign)}" rpy="{turn}"/>'
        limit = f'<limit lower="{low}" upper="{high}" effort="{part.effort}" velocity="{part.velocity}"/>'
        name = f"{side}_{part.name}"
        lines.append(f'<link name="{name}_link">{_inertial(part.body, sign)}</link>')
        ends = f'<parent link="{parent}"/><child link="{name}_link"/><axis xyz="{_text(part.axis)}"/>'
        lines.append(f'<joint name="{name}_joint" type="revolute">{place}{ends}{limit}</joint>')
        parent = f"{name}_link"
    palm = f'<origin xyz="{_mirrored(HAND_AT, sign)}"/><parent link="{parent}"/><child link="{side}_hand"/>'
    return [
        *lines,
        f'<link name="{side}_hand">{_inertial(HAND, sign)}</link>',
        f'<joint name="{side}_palm" type="fixed">{palm}</joint>',
    ]


def _inertial(body: Body, sign: float) -> str:
    xx, xy, xz, yy, yz, zz = body.inertia
    return (
        f'<inertial><origin xyz="{_mirrored(body.centre, sign)}"/><mass value="{body.mass}"/>'
        f'<inertia ixx="{xx}" ixy="{sign * xy}" ixz="{xz}" iyy="{yy}" iyz="{sign * yz}" izz="{zz}"/></inertial>'
    )


def _mirrored(vector: Triple, sign: float) -> str:
    return _text((vector[0], sign * vector[1], vector[2]))


def _text(values: Sequence[float]) -> str:
    return " ".join(f"{v:g}" for v in values)
