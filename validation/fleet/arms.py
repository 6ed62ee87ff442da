"""Two makes of small arms: their nominal URDF text, and bodies that swing in a vertical plane or about two axes."""

from __future__ import annotations

LINK = (
    '<link name="{name}"><inertial><origin xyz="{com} 0 0"/><mass value="{mass}"/>'
    '<inertia ixx="{small}" ixy="0" ixz="0" iyy="{large}" iyz="0" izz="{large}"/></inertial></link>'
)
JOINT = (
    '<joint name="{name}" type="revolute"><origin xyz="{offset} 0 0"/><parent link="{parent}"/><child link="{child}"/>'
    '<axis xyz="{axis}"/><limit lower="-2.9" upper="2.9" effort="80" velocity="8"/></joint>'
)
Y, Z = "0 1 0", "0 0 1"
# name, axis, length to the next joint [m], mass [kg]
MAKES = {
    "planar": (("shoulder", Y, 0.40, 2.4), ("elbow", Y, 0.32, 1.3)),
    "desk": (("waist", Z, 0.08, 1.9), ("shoulder", Y, 0.34, 2.1), ("elbow", Y, 0.30, 1.1)),
}


def urdf(make: str) -> str:
    """The nominal description of a make."""
    parts, parent, offset = ['<link name="base"/>'], "base", 0.0
    for joint, axis, length, mass in MAKES[make]:
        link = f"{joint}_link"
        large = mass * length**2 / 12.0
        parts.append(LINK.format(name=link, com=0.45 * length, mass=mass, small=0.1 * large, large=large))
        parts.append(JOINT.format(name=joint, offset=offset, parent=parent, child=link, axis=axis))
        parent, offset = link, length
    return f'<robot name="{make}">{"".join(parts)}</robot>'
