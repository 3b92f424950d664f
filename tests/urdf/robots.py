"""Robots made up by hypothesis, and short ways to write them."""

from __future__ import annotations

from hypothesis import strategies as st

from linkwright.urdf import (
    Box,
    Calibration,
    Capsule,
    Collision,
    Cylinder,
    Dynamics,
    Inertial,
    Joint,
    Limit,
    Link,
    Material,
    Mesh,
    Mimic,
    Pose,
    Robot,
    Safety,
    Sphere,
    Visual,
)

numbers = st.floats(-1e6, 1e6, allow_nan=False, allow_subnormal=False)
sizes = st.floats(1e-6, 1e6)
shares = st.floats(0, 1)
angles = st.floats(-3.2, 3.2)
vectors = st.tuples(numbers, numbers, numbers)
names = st.text(
    st.characters(codec="utf-8", exclude_categories=("Cc", "Cs", "Zl", "Zp"), exclude_characters="\ufffe\uffff"),
    max_size=8,
)
poses = st.builds(Pose, vectors, st.tuples(angles, angles, angles))
geometries = st.one_of(
    st.builds(Box, st.tuples(sizes, sizes, sizes)),
    st.builds(Cylinder, sizes, sizes),
    st.builds(Capsule, sizes, sizes),
    st.builds(Sphere, sizes),
    st.builds(Mesh, names, vectors),
)
colours = st.tuples(shares, shares, shares, shares)
limits = st.builds(
    lambda low, span, effort, velocity: Limit(low, low + span, effort, velocity), numbers, sizes, numbers, numbers
)


@st.composite
def robots(draw, max_links: int = 8) -> Robot:
    """A robot of version 1.1 with all kinds of joints, mimic chains, shapes and materials."""
    link_names = draw(st.lists(names, min_size=1, max_size=max_links, unique=True).filter(all))
    materials = {
        name: Material(name, draw(st.none() | colours), draw(st.none() | names))
        for name in draw(st.lists(names.filter(bool), max_size=3, unique=True))
    }
    materials = {
        name: material if material.rgba or material.texture is not None else Material(name, (0.0, 0.0, 0.0, 1.0))
        for name, material in materials.items()
    }
    links = {name: draw(_links(name, materials)) for name in link_names}
    joint_names = draw(
        st.lists(names, min_size=len(link_names) - 1, max_size=len(link_names) - 1, unique=True).filter(
            lambda drawn: len(drawn) == len(link_names) - 1
        )
    )
    joints: dict[str, Joint] = {}
    for place, name in enumerate(joint_names, start=1):
        parent = link_names[draw(st.integers(0, place - 1))]
        joints[name] = draw(_joints(name, parent, link_names[place], tuple(joints)))
    return Robot(draw(names), link_names[0], links, joints, materials, (1, 1))


@st.composite
def _links(draw, name: str, materials: dict[str, Material]) -> Link:
    inertial = st.builds(Inertial, numbers, numbers, numbers, numbers, numbers, numbers, numbers, poses)
    visuals = []
    for geometry in draw(st.lists(geometries, max_size=2)):
        how = draw(st.sampled_from(["none", "named", "undefined", "own"]))
        material_name, material = "", None
        if how == "named" and materials:
            material_name = draw(st.sampled_from(sorted(materials)))
            material = materials[material_name]
        elif how == "undefined":
            material_name = "nowhere defined"
        elif how == "own":
            material = Material("", draw(colours))
        visuals.append(Visual(geometry, draw(poses), draw(names), material_name, material))
    collisions = draw(st.lists(st.builds(Collision, geometries, poses, names), max_size=2))
    return Link(name, draw(st.none() | inertial), tuple(visuals), tuple(collisions))


@st.composite
def _joints(draw, name: str, parent: str, child: str, earlier: tuple[str, ...]) -> Joint:
    kind = draw(st.sampled_from(["revolute", "continuous", "prismatic", "fixed", "floating", "planar"]))
    mimic = st.builds(Mimic, st.sampled_from(earlier), numbers, numbers) if earlier else st.none()
    return Joint(
        name,
        kind,
        parent,
        child,
        draw(poses),
        (1.0, 0.0, 0.0) if kind in ("fixed", "floating") else draw(vectors),
        draw(limits if kind in ("revolute", "prismatic") else st.none() | limits),
        draw(st.none() | mimic),
        draw(st.none() | st.builds(Safety, numbers, numbers, numbers, numbers)),
        draw(st.none() | st.builds(Dynamics, numbers, numbers)),
        draw(st.none() | st.builds(Calibration, st.none() | numbers, st.none() | numbers)),
    )


def robot_text(*parts: str, version: str | None = None) -> str:
    """A ``<robot>`` around parts."""
    attribute = f' version="{version}"' if version else ""
    return f'<robot name="r"{attribute}>{"".join(parts)}</robot>'


def chain(*joints: str) -> str:
    """Links a, b, c, ... and joints between them; each joint is written as ``type`` or ``type: what is inside``."""
    letters = "abcdefghijklmnopqrstuvwxyz"
    text = "".join(f'<link name="{letter}"/>' for letter in letters[: len(joints) + 1])
    for place, joint in enumerate(joints):
        kind, _, inside = joint.partition(":")
        limit = (
            '<limit effort="1" velocity="1"/>' if kind in ("revolute", "prismatic") and "<limit" not in inside else ""
        )
        text += (
            f'<joint name="j{place}" type="{kind}"><parent link="{letters[place]}"/>'
            f'<child link="{letters[place + 1]}"/>{limit}{inside}</joint>'
        )
    return text
