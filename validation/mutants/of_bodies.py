"""Sabotaged bodies: what goes wrong in the files that describe robots."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np

from lagnet.rigid_body.inertia import parameters_of_body
from validation.mutants.bench import Case, robot_from, sound, sound_urdf
from validation.mutants.registry import mutant

# ---- bodies --------------------------------------------------------------------------------------------------------


def _with_body(change: Callable[[np.ndarray], np.ndarray]) -> Case:
    arm = sound()
    rows = arm.inertial_parameters().copy()
    rows[1] = change(rows[1])
    return Case(arm.with_inertial_parameters(rows))


def _scaled_attributes(urdf: str, link: str, element: str, factor: float) -> str:
    """The file with the numbers of one element of one link scaled."""
    head, body, tail = re.split(rf'(<link name="{link}">.*?</link>)', urdf, maxsplit=1, flags=re.S)

    def scaled(match: re.Match[str]) -> str:
        return re.sub(
            r'"([^"]*)"', lambda m: '"' + " ".join(repr(factor * float(x)) for x in m[1].split()) + '"', match[0]
        )

    return head + re.sub(rf"<{element} [^>]*/>", scaled, body, count=1) + tail


@mutant("link_mass")
def massless_body() -> Case:
    """A body in the middle of the arm has moments of inertia but no mass."""

    def change(row):
        return np.concatenate([np.zeros(4), row[4:]])

    return _with_body(change)


@mutant("link_inertia_given")
def point_mass() -> Case:
    """The inertia of a link was left at zero."""
    return Case(robot_from(_scaled_attributes(sound_urdf(), "link_1", "inertia", 0.0)))


@mutant("link_triangle_inequality")
def triangle_broken_by_one_per_cent() -> Case:
    """The largest principal moment exceeds the sum of the others by 1 %."""
    return _with_body(lambda row: parameters_of_body(row[0], row[1:4] / row[0], np.diag([0.01, 0.02, 0.0303])))


@mutant("link_pseudo_inertia")
def plate_without_thickness() -> Case:
    """A link is a plate of no thickness: the triangle inequality holds as an equality."""
    return _with_body(lambda row: parameters_of_body(row[0], row[1:4] / row[0], np.diag([0.01, 0.02, 0.03])))


@mutant("link_center_of_mass")
def millimetres_for_metres() -> Case:
    """A centre of mass was given in millimetres."""
    return Case(robot_from(_scaled_attributes(sound_urdf(), "link_1", "origin", 1000.0)))


@mutant("link_density")
def one_link_in_grams() -> Case:
    """Mass and inertia of one link are in grams."""
    return _with_body(lambda row: 1000.0 * row)


@mutant("link_density")
def one_mass_in_grams() -> Case:
    """The mass alone of one link is in grams."""
    return Case(robot_from(_scaled_attributes(sound_urdf(), "link_1", "mass", 1000.0)))


@mutant("link_extent")
def inertia_in_square_millimetres() -> Case:
    """The inertia of one link is in kg mm²."""
    return Case(robot_from(_scaled_attributes(sound_urdf(), "link_1", "inertia", 1e6)))


@mutant("link_counted_once")
def link_repeated_by_a_frame() -> Case:
    """A frame welded to a link repeats its inertia."""
    urdf = sound_urdf()
    found = re.search(r'<link name="link_1">(.*?)</link>', urdf, re.S)
    assert found is not None
    weld = '<joint name="copy_joint" type="fixed"><parent link="link_1"/><child link="link_1_inertia"/></joint>'
    extra = f'<link name="link_1_inertia">{found[1]}</link>{weld}'
    return Case(robot_from(urdf.replace("</robot>", extra + "</robot>")))
