"""The models of ``robots/my_robot_gazebo``: objects that a robot can detect, push or hit.

`make_gazebo_worlds.py` writes them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from gazebo_sdf import (
    BLACK,
    BLUE,
    GRAY,
    ORANGE,
    RED,
    SKIN,
    WHITE,
    WOOD,
    YELLOW,
    Body,
    Color,
    Model,
    Part,
    Pose,
    Vector,
    box,
    cylinder,
    mesh,
    numbers,
    sphere,
)


def make_prism(name: str, rings: Sequence[tuple[float, float]], sides: int, turn: float = 0.0) -> str:
    """Return an STL file with a closed surface about z.

    Args:
        name: the name of the solid.
        rings: the radius and height of each ring of corners in meters, from the bottom to the top.
        sides: the number of corners of a ring.
        turn: the angle of the first corner in radians.
    """
    angles = [turn + 2 * math.pi * index / sides for index in range(sides)]
    corners = [[(r * math.cos(a), r * math.sin(a), z) for a in angles] for r, z in rings]
    triangles: list[tuple[Vector, Vector, Vector]] = []
    for lower, upper in pairwise(corners):
        for index in range(sides):
            next_index = (index + 1) % sides
            triangles.append((lower[index], lower[next_index], upper[next_index]))
            triangles.append((lower[index], upper[next_index], upper[index]))
    for index in range(1, sides - 1):
        triangles.append((corners[0][0], corners[0][index + 1], corners[0][index]))
        triangles.append((corners[-1][0], corners[-1][index], corners[-1][index + 1]))
    rows = [f"solid {name}"]
    for triangle in triangles:
        rows += [f"facet normal {numbers(compute_normal(*triangle))}", "outer loop"]
        rows += [f"vertex {numbers(corner)}" for corner in triangle]
        rows += ["endloop", "endfacet"]
    return "\n".join([*rows, f"endsolid {name}", ""])


def compute_normal(a: Vector, b: Vector, c: Vector) -> Vector:
    """Return the unit normal of a triangle with counterclockwise corners."""
    u, v = [tuple(q - p for p, q in zip(a, other, strict=True)) for other in (b, c)]
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = math.hypot(*n)
    return (n[0] / length, n[1] / length, n[2] / length)


def compute_cone_radius(z: float) -> float:
    """Return the radius of the traffic cone at a height, in meters."""
    return 0.13 - 0.105 * (z - 0.03) / 0.47


def traffic_cone() -> tuple[Model, dict[str, str]]:
    """Return a traffic cone of 0.5 m with two white bands and a square foot.

    It can fall over.
    """
    bands = {
        f"band_{number}.stl": make_prism("band", [(compute_cone_radius(z) + 0.002, z) for z in (low, low + 0.08)], 24)
        for number, low in ((1, 0.15), (2, 0.32))
    }
    meshes = {
        "cone.stl": make_prism("cone", [(compute_cone_radius(0.03), 0.03), (compute_cone_radius(0.5), 0.5)], 24),
        **bands,
    }
    parts = [
        box("foot", (0.34, 0.34, 0.03), Pose(z=0.015), ORANGE),
        mesh("cone", "traffic_cone/meshes/cone.stl", Pose(), ORANGE),
        *(
            mesh(f"band_{number}", f"traffic_cone/meshes/band_{number}.stl", Pose(), WHITE, solid=False)
            for number in (1, 2)
        ),
    ]
    return Model("traffic_cone", parts, body=Body(1.8, (0.04, 0.04, 0.02), (0, 0, 0.12))), meshes


def ball() -> tuple[Model, dict[str, str]]:
    """Return a rolling football of 0.22 m, with its origin on the ground."""
    radius, mass = 0.11, 0.43
    spots = [
        cylinder(f"spot_{number}", 0.03, 0.2205, Pose(z=radius, roll=roll, pitch=pitch), BLACK, solid=False)
        for number, (roll, pitch) in enumerate(((0, 0), (math.pi / 2, 0), (0, math.pi / 2)), start=1)
    ]
    shell = 2 * mass * radius**2 / 3
    body = Body(mass, (shell, shell, shell), (0, 0, radius))
    return Model("ball", [sphere("ball", radius, Pose(z=radius), WHITE), *spots], body=body), {}


def crate() -> tuple[Model, dict[str, str]]:
    """Return a wooden crate of 0.4 m that a robot can push."""
    size, mass = 0.4, 3.0
    slats = [
        box(f"slat_{number}_{side}", (0.41, 0.41, 0.05), Pose(z=z), (0.40, 0.26, 0.14), solid=False)
        for number, (side, z) in enumerate((("low", 0.03), ("high", 0.37)), start=1)
    ]
    cube = mass * size**2 / 6
    parts = [box("crate", (size, size, size), Pose(z=size / 2), WOOD), *slats]
    return Model("crate", parts, body=Body(mass, (cube, cube, cube), (0, 0, size / 2))), {}


def person(name: str, scale: float, shirt: Color, trousers: Color) -> tuple[Model, dict[str, str]]:
    """Return a standing person that looks along x, 1.75 m tall times the scale."""

    def at(y: float, z: float, x: float = 0.0) -> Pose:
        return Pose(x * scale, y * scale, z * scale)

    sides = (("left", 1), ("right", -1))
    parts = [
        *(cylinder(f"{side}_leg", 0.075 * scale, 0.80 * scale, at(s * 0.10, 0.42), trousers) for side, s in sides),
        *(
            box(f"{side}_shoe", (0.26 * scale, 0.10 * scale, 0.08 * scale), at(s * 0.10, 0.04, 0.05), BLACK)
            for side, s in sides
        ),
        box("trunk", (0.22 * scale, 0.38 * scale, 0.62 * scale), at(0, 1.13), shirt),
        *(cylinder(f"{side}_arm", 0.05 * scale, 0.62 * scale, at(s * 0.25, 1.12), shirt) for side, s in sides),
        *(sphere(f"{side}_hand", 0.055 * scale, at(s * 0.25, 0.78), SKIN) for side, s in sides),
        cylinder("neck", 0.05 * scale, 0.10 * scale, at(0, 1.48), SKIN),
        sphere("head", 0.125 * scale, at(0, 1.625), SKIN),
        sphere("hair", 0.125 * scale, at(0, 1.655, -0.015), (0.20, 0.12, 0.07), solid=False),
        *(sphere(f"{side}_eye", 0.016 * scale, at(s * 0.045, 1.64, 0.115), BLACK, solid=False) for side, s in sides),
    ]
    return Model(name, parts), {}


# The strokes of a letter in a field of 3 by 5 steps: middle (across, up) and size (across, up).
STROKES_BY_LETTER: dict[str, list[tuple[float, float, float, float]]] = {
    "S": [(0, 2, 3, 1), (-1, 1, 1, 1), (0, 0, 3, 1), (1, -1, 1, 1), (0, -2, 3, 1)],
    "T": [(0, 2, 3, 1), (0, -0.5, 1, 4)],
    "O": [(0, 2, 3, 1), (-1, 0, 1, 3), (1, 0, 1, 3), (0, -2, 3, 1)],
    "P": [(0, 2, 3, 1), (-1, -0.5, 1, 4), (1, 1, 1, 1), (0, 0, 3, 1)],
}


def make_lettering(word: str, step: float, pose: Pose, color: Color) -> list[Part]:
    """Return a word of flat boxes on a plate that faces x.

    `step` is the width of a stroke in meters.
    """
    parts = []
    for index, letter in enumerate(word):
        middle = (index - (len(word) - 1) / 2) * 4
        for stroke, (across, up, width, tall) in enumerate(STROKES_BY_LETTER[letter], start=1):
            # A reader looks along -x and has y on the right.
            stroke_pose = Pose(pose.x, pose.y + (middle + across) * step, pose.z + up * step)
            size = (0.004, width * step, tall * step)
            parts.append(box(f"{letter}{index + 1}_{stroke}", size, stroke_pose, color, solid=False))
    return parts


def make_sign(name: str, plates: Sequence[tuple[str, str, Color]], height: float) -> list[Part]:
    """Return a pole with plates that face x, each a mesh in front of the previous one."""
    upright = [
        mesh(
            part,
            f"{name}/meshes/{file}",
            Pose(0.03 + 0.004 * index, 0, height, pitch=math.pi / 2),
            color,
            solid=index == 0,
        )
        for index, (part, file, color) in enumerate(plates)
    ]
    pole = cylinder("pole", 0.025, height, Pose(z=height / 2), GRAY)
    return [pole, *upright]


def make_plate(sides: int, radius: float, turn: float) -> str:
    """Return a plate of 8 mm thickness, centered at the origin, that faces z."""
    return make_prism("plate", [(radius, -0.004), (radius, 0.004)], sides, turn)


def stop_sign() -> tuple[Model, dict[str, str]]:
    """Return a stop sign that faces x: a red octagon with a white rim on a pole of 1.6 m."""
    height = 1.6
    meshes = {"rim.stl": make_plate(8, 0.32, math.pi / 8), "field.stl": make_plate(8, 0.30, math.pi / 8)}
    parts = make_sign("stop_sign", [("rim", "rim.stl", WHITE), ("field", "field.stl", RED)], height)
    return Model("stop_sign", [*parts, *make_lettering("STOP", 0.03, Pose(0.04, 0, height), WHITE)]), meshes


def yield_sign() -> tuple[Model, dict[str, str]]:
    """Return a yield sign that faces x, on a pole of 1.6 m.

    It is a white triangle with a red rim, one corner down.
    """
    # A quarter turn about y raises the plate, with its -x at the top: a corner at +x points down.
    meshes = {"rim.stl": make_plate(3, 0.40, 0.0), "field.stl": make_plate(3, 0.28, 0.0)}
    parts = make_sign("yield_sign", [("rim", "rim.stl", RED), ("field", "field.stl", WHITE)], 1.6)
    return Model("yield_sign", parts), meshes


MODELS = {
    "traffic_cone": (traffic_cone, "A traffic cone that can be knocked over"),
    "ball": (ball, "A football that rolls"),
    "crate": (crate, "A wooden crate that a robot can push"),
    "person_standing": (lambda: person("person_standing", 1.0, BLUE, GRAY), "A standing person of 1.75 m"),
    "child_standing": (lambda: person("child_standing", 0.68, YELLOW, RED), "A standing child of 1.2 m"),
    "stop_sign": (stop_sign, "A stop sign on a pole"),
    "yield_sign": (yield_sign, "A yield sign on a pole"),
}


def format_model_config(name: str, description: str) -> str:
    """Return the ``model.config`` of a model."""
    return "\n".join(
        [
            '<?xml version="1.0"?>',
            "<model>",
            f"  <name>{name}</name>",
            "  <version>1.0</version>",
            '  <sdf version="1.6">model.sdf</sdf>',
            "  <author>",
            "    <name>The Linkwright authors</name>",
            "    <email>maintainers@linkwright.dev</email>",
            "  </author>",
            f"  <description>{description}.</description>",
            "</model>",
            "",
        ]
    )
