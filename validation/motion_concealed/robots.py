"""The nominal robots of the plants: a pendulum, a leg of two links, an arm of six joints, and the public SO-101."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

DATA = Path(os.environ.get("LAGNET_DATA_DIR", Path(__file__).parents[3] / "shared" / "data"))
SERVO = {"kp": 8.0, "kd": 0.3, "viscous": 0.15, "coulomb": 0.03, "rotor": 0.01}
STRONG = 3.0  # times SERVO, of the arm of six joints
HEAVY = 0.01  # [kg m²] of every link: behind a spring a motor feels a link that is not light beside its rotor
BODY = """<body name="{name}" pos="{at}"><joint name="{name}" type="hinge" axis="{axis}" range="-3 3"/>
<inertial pos="{centre}" mass="{mass}" diaginertia="{inertia}"/>{inner}</body>"""
MJCF = '<mujoco model="{name}"><compiler angle="radian"/><worldbody>{inner}</worldbody></mujoco>'
GROUND = """<link name="ground"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>"""
URDF_LINK = """<link name="{name}_link"><inertial><origin xyz="{centre}"/><mass value="{mass}"/>
<inertia ixx="{i[0]}" iyy="{i[1]}" izz="{i[2]}" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{name}_link"/>
<origin xyz="{at}"/><axis xyz="{axis}"/><limit lower="-3" upper="3" effort="100" velocity="100"/></joint>"""


@dataclass(frozen=True)
class Link:
    """A link and the joint that it hangs on; lengths in the frame of the link before.

    Args:
        name: of the joint.
        at: joint's place [m]; axis: of the joint.
        mass: [kg]; centre: of the mass [m]; inertia: about it, along the axes [kg m²].
    """

    name: str
    at: tuple[float, float, float]
    axis: tuple[int, int, int]
    mass: float
    centre: tuple[float, float, float]
    inertia: tuple[float, float, float]


SLIM = (4e-4, 4e-4, 5e-5)
X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
LOWER = Link("lower", (0.0, 0.0, 0.0), Y, 0.25, (0.0, 0.0, -0.08), SLIM)
CHAINS: dict[str, tuple[Link, ...]] = {
    "pendulum": (LOWER,),
    "leg": (
        Link("upper", (0.0, 0.0, 0.0), Y, 0.3, (0.0, 0.0, -0.08), SLIM),
        Link("lower", (0.0, 0.0, -0.16), Y, 0.25, (0.0, 0.0, -0.08), SLIM),
    ),
    "arm6": (
        Link("base", (0.0, 0.0, 0.05), Z, 0.6, (0.0, 0.0, 0.03), (8e-4, 8e-4, 8e-4)),
        Link("shoulder", (0.0, 0.0, 0.06), Y, 0.4, (0.0, 0.0, 0.07), (9e-4, 9e-4, 2e-4)),
        Link("elbow", (0.0, 0.0, 0.14), Y, 0.3, (0.0, 0.0, 0.06), (6e-4, 6e-4, 2e-4)),
        Link("roll", (0.0, 0.0, 0.12), Z, 0.2, (0.0, 0.01, 0.03), (2e-4, 2e-4, 1e-4)),
        Link("wrist", (0.0, 0.0, 0.06), Y, 0.15, (0.02, 0.0, 0.03), (1e-4, 1e-4, 1e-4)),
        Link("hand", (0.0, 0.0, 0.05), X, 0.1, (0.0, 0.02, 0.04), (1e-4, 1e-4, 1e-4)),
    ),
}


def servo_law(kind: str) -> dict[str, float]:
    """The nominal servo of every joint; an arm of six joints has stronger ones."""
    factor = STRONG if kind == "arm6" else 1.0
    return {name: factor * value for name, value in SERVO.items()}


def write_mjcf(kind: str, folder: Path) -> Path:
    """The file of a nominal robot for MuJoCo; of the SO-101 its own."""
    if kind == "so101":
        return DATA / "so101" / "so101.xml"
    inner = ""
    for link in reversed(CHAINS[kind]):
        inner = BODY.format(
            name=link.name,
            at=_text(link.at),
            axis=_text(link.axis),
            centre=_text(link.centre),
            mass=link.mass,
            inertia=_text([HEAVY + i for i in link.inertia]),
            inner=inner,
        )
    path = folder / f"{kind}.xml"
    path.write_text(MJCF.format(name=kind, inner=inner), encoding="utf-8")
    return path


def write_urdf(kind: str, path: Path, more: float = 0.0) -> Path:
    """The file of a robot for PyBullet; more: mass added to its last link where its centre is."""
    text, parent = '<robot name="plant">' + GROUND, "ground"
    for link in CHAINS[kind]:
        mass = link.mass + (more if link is CHAINS[kind][-1] else 0.0)
        at, axis, centre = _text(link.at), _text(link.axis), _text(link.centre)
        inertia = [HEAVY + i for i in link.inertia]
        text += URDF_LINK.format(name=link.name, parent=parent, at=at, axis=axis, centre=centre, mass=mass, i=inertia)
        parent = f"{link.name}_link"
    path.write_text(text + "</robot>", encoding="utf-8")
    return path


def _text(values: Sequence[float]) -> str:
    return " ".join(str(v) for v in values)
