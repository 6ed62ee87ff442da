"""Random serial arms whose bodies could be real: material for tests, studies and training."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lagnet.rigid_body.descriptions.urdf import read_urdf
from lagnet.rigid_body.descriptions.xml_files import checked_xml
from lagnet.rigid_body.robot import Robot

POINTS = 8  # point masses a link: more than the four that make a body of full rank


def random_arm(
    n_joints: int,
    seed: int,
    kinds: Sequence[str] = ("revolute", "continuous", "prismatic"),
    fixed: bool = True,
) -> Robot:
    """A serial arm drawn at random, physically consistent by construction.

    Args:
        n_joints: number of moving joints.
        seed: of the draw; the same seed gives the same arm.
        kinds: joint types to draw from.
        fixed: whether some links carry a further body on a fixed joint.
    """
    text = random_arm_urdf(n_joints, seed, kinds, fixed)
    name = f"random_arm({n_joints}, seed={seed})"
    return Robot(read_urdf(checked_xml(text.encode(), name)))


def random_arm_urdf(
    n_joints: int, seed: int, kinds: Sequence[str] = ("revolute", "continuous", "prismatic"), fixed: bool = True
) -> str:
    """The URDF text of `random_arm`."""
    if n_joints < 1:
        raise ValueError(f"n_joints is {n_joints}, expected at least 1")
    generator = np.random.default_rng(seed)
    parts, parent = ['<link name="base"/>'], "base"
    for i in range(n_joints):
        kind = str(generator.choice(list(kinds)))
        parts += [_link(f"link_{i}", generator), _joint(f"joint_{i}", kind, parent, f"link_{i}", generator)]
        parent = f"link_{i}"
        if fixed and generator.random() < 0.3:
            parts += [_link(f"cover_{i}", generator), _joint(f"weld_{i}", "fixed", parent, f"cover_{i}", generator)]
    tool = f"<origin xyz='{_text(generator.uniform(-0.1, 0.1, 3))}'/><parent link='{parent}'/><child link='tool'/>"
    parts += ['<link name="tool"/>', f'<joint name="tool_joint" type="fixed">{tool}</joint>']
    return f'<robot name="random_arm">{"".join(parts)}</robot>'


def _link(name: str, generator: np.random.Generator) -> str:
    mass = generator.uniform(0.5, 6.0)
    shares = generator.dirichlet(np.ones(POINTS)) * mass
    points = generator.normal(0.0, 1.0, (POINTS, 3)) * generator.uniform(0.02, 0.12, 3)
    points += generator.uniform(-0.15, 0.15, 3)
    com = shares @ points / mass
    centred = points - com
    second = (centred * shares[:, None]).T @ centred
    tensor = np.trace(second) * np.eye(3) - second
    names = (("ixx", 0, 0), ("ixy", 0, 1), ("ixz", 0, 2), ("iyy", 1, 1), ("iyz", 1, 2), ("izz", 2, 2))
    inertia = " ".join(f'{key}="{float(tensor[i, j])!r}"' for key, i, j in names)
    body = f'<origin xyz="{_text(com)}"/><mass value="{float(mass)!r}"/><inertia {inertia}/>'
    return f'<link name="{name}"><inertial>{body}</inertial></link>'


def _joint(name: str, kind: str, parent: str, child: str, generator: np.random.Generator) -> str:
    place, turn = generator.uniform(-0.3, 0.3, 3), generator.uniform(-np.pi, np.pi, 3)
    axis = generator.normal(size=3) if generator.random() < 0.4 else np.eye(3)[generator.integers(3)]
    axis = axis / np.linalg.norm(axis)
    reach = {"prismatic": 0.5, "revolute": generator.uniform(1.5, 3.1)}.get(kind, 0.0)
    limit = f'<limit lower="{-reach!r}" upper="{reach!r}" effort="200" velocity="4"/>' if reach else ""
    if kind == "continuous":
        limit = '<limit effort="200" velocity="4"/>'
    return (
        f'<joint name="{name}" type="{kind}"><origin xyz="{_text(place)}" rpy="{_text(turn)}"/>'
        f'<parent link="{parent}"/><child link="{child}"/><axis xyz="{_text(axis)}"/>{limit}</joint>'
    )


def _text(values: np.ndarray) -> str:
    return " ".join(repr(float(value)) for value in values)
