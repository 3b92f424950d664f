"""Write ``robots/my_robot_description/meshes/kinect.dae``, the mesh of mbot's Kinect.

Usage: python tools/make_kinect_mesh.py [--check]

The mesh is COLLADA 1.4.1 in meters with z up. The long side lies along x and the lenses look along -y, so that the
quarter turn about z in the URDF makes them look along the robot's +x. The origin is 34 mm above the underside of the
foot: mbot's models place it 30 mm and 35 mm above a deck. The output has the same bytes on every machine.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

TARGET = Path(__file__).resolve().parent.parent / "robots" / "my_robot_description" / "meshes" / "kinect.dae"

Vector = tuple[float, float, float]

# Overall 0.28 x 0.07 x 0.046 m. The body's front lies behind the lenses, which end at y = -0.035.
BODY_X = 0.14
BODY_Y = (-0.0335, 0.035)
BODY_Z = (-0.020, 0.012)
FOOT_BOTTOM = -0.034
LENS_FRONT = -0.035


@dataclass(frozen=True)
class Material:
    """A surface, with colors as red, green and blue from 0 to 1."""

    name: str
    diffuse: Vector
    specular: Vector = (0.0, 0.0, 0.0)
    emission: Vector = (0.0, 0.0, 0.0)
    shininess: float = 1.0


@dataclass(frozen=True)
class Triangle:
    """Three corners, counterclockwise from outside, and the outward normal at each corner."""

    corners: tuple[Vector, Vector, Vector]
    normals: tuple[Vector, Vector, Vector]


@dataclass(frozen=True)
class Part:
    """A closed surface of one material."""

    name: str
    material: Material
    triangles: list[Triangle]


SHELL = Material("shell", (0.055, 0.055, 0.062), specular=(0.35, 0.35, 0.36), shininess=42.0)
FOOT = Material("foot", (0.11, 0.11, 0.12), specular=(0.10, 0.10, 0.10), shininess=12.0)
LENS = Material("lens", (0.015, 0.018, 0.045), specular=(0.90, 0.92, 1.0), shininess=90.0)
EMITTER = Material(
    "emitter", (0.20, 0.012, 0.02), specular=(0.6, 0.4, 0.4), emission=(0.10, 0.0, 0.005), shininess=60.0
)
LED = Material("led", (0.05, 0.45, 0.10), emission=(0.03, 0.55, 0.10))


def subtract(a: Vector, b: Vector) -> Vector:
    """Return the vector from b to a."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def unit(a: Vector) -> Vector:
    """Return a vector with the same direction and length 1."""
    length = math.hypot(*a)
    return (a[0] / length, a[1] / length, a[2] / length)


def cross(a: Vector, b: Vector) -> Vector:
    """Return the vector product of a and b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def rounded_rectangle(width: float, height: float, radius: float, steps: int = 5) -> list[tuple[float, float]]:
    """Return the outline of a rectangle about (0, 0) with round corners, counterclockwise."""
    outline = []
    for quarter, (sign_u, sign_v) in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))):
        for step in range(steps + 1):
            angle = (quarter + step / steps) * math.pi / 2
            outline.append(
                (
                    sign_u * (width / 2 - radius) + radius * math.cos(angle),
                    sign_v * (height / 2 - radius) + radius * math.sin(angle),
                )
            )
    return outline


def circle(radius: float, steps: int = 32) -> list[tuple[float, float]]:
    """Return the outline of a circle about (0, 0), counterclockwise."""
    angles = [2 * math.pi * step / steps for step in range(steps)]
    return [(radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]


def loft(rings: Sequence[Sequence[Vector]]) -> list[Triangle]:
    """Return a closed, convex surface through rings with equal numbers of points.

    The rings are counterclockwise, seen from beyond the last one. Shading is smooth around a ring and flat between
    rings, so that edges between rings remain sharp. Both ends are flat.
    """
    triangles = []
    count = len(rings[0])
    for lower, upper in pairwise(rings):
        faces = []
        for index in range(count):
            next_index = (index + 1) % count
            faces.append(unit(cross(subtract(lower[next_index], lower[index]), subtract(upper[index], lower[index]))))
        for index in range(count):
            next_index = (index + 1) % count
            normal = smooth_normal(faces[index - 1], faces[index], faces[index])
            next_normal = smooth_normal(faces[index], faces[next_index], faces[index])
            triangles.append(
                Triangle((lower[index], lower[next_index], upper[next_index]), (normal, next_normal, next_normal))
            )
            triangles.append(Triangle((lower[index], upper[next_index], upper[index]), (normal, next_normal, normal)))
    return triangles + make_cap(list(reversed(rings[0]))) + make_cap(list(rings[-1]))


def smooth_normal(a: Vector, b: Vector, face: Vector) -> Vector:
    """Return the mean normal of two faces that meet at less than 30 degrees, else the face's."""
    if sum(x * y for x, y in zip(a, b, strict=True)) < math.cos(math.radians(30)):
        return face
    return unit((a[0] + b[0], a[1] + b[1], a[2] + b[2]))


def make_cap(ring: list[Vector]) -> list[Triangle]:
    """Return a flat, convex end: a fan over a ring that is counterclockwise from outside."""
    normal = unit(cross(subtract(ring[1], ring[0]), subtract(ring[2], ring[0])))
    normals = (normal, normal, normal)
    return [Triangle((ring[0], ring[index], ring[index + 1]), normals) for index in range(1, len(ring) - 1)]


def make_body() -> Part:
    """Return the long shell: a rounded profile, extruded along x and beveled at both ends."""
    middle_y, middle_z = sum(BODY_Y) / 2, sum(BODY_Z) / 2
    rings = []
    for x, inset in ((-BODY_X, 0.004), (-BODY_X + 0.004, 0.0), (BODY_X - 0.004, 0.0), (BODY_X, 0.004)):
        outline = rounded_rectangle(BODY_Y[1] - BODY_Y[0] - 2 * inset, BODY_Z[1] - BODY_Z[0] - 2 * inset, 0.009 - inset)
        # The y-z plane seen from +x: y to the right, z up.
        rings.append([(x, middle_y + u, middle_z + v) for u, v in outline])
    return Part("body", SHELL, loft(rings))


def make_foot() -> Part:
    """Return the stand: a neck that widens to the base, with its upper end inside the body."""
    rings = []
    for z, width, depth in (
        (FOOT_BOTTOM, 0.090, 0.062),
        (FOOT_BOTTOM + 0.005, 0.090, 0.062),
        (FOOT_BOTTOM + 0.008, 0.058, 0.044),
        (BODY_Z[0] + 0.002, 0.046, 0.036),
    ):
        outline = rounded_rectangle(width, depth, 0.012)
        rings.append([(u, v, z) for u, v in outline])
    return Part("foot", FOOT, loft(rings))


def make_lens(name: str, material: Material, x: float, radius: float, front: float = LENS_FRONT) -> Part:
    """Return a round window in the front: a short cylinder along -y with a beveled rim."""
    z = sum(BODY_Z) / 2
    rings = []
    for y, size in ((BODY_Y[0] + 0.003, radius), (front + 0.0005, radius), (front, radius - 0.001)):
        # The x-z plane seen from -y, toward which the rings advance: x to the right, z up.
        rings.append([(x + u, y, z + v) for u, v in circle(size)])
    return Part(name, material, loft(rings))


def make_kinect() -> list[Part]:
    """Return all parts, in the order of the file."""
    return [
        make_body(),
        make_foot(),
        make_lens("emitter", EMITTER, -0.068, 0.0085),
        make_lens("color_lens", LENS, 0.0, 0.0085),
        make_lens("depth_lens", LENS, 0.030, 0.0085),
        make_lens("led", LED, -0.026, 0.0025, front=LENS_FRONT + 0.0005),
    ]


def format_number(value: float) -> str:
    """Return a number with at most six decimal places, without negative zero."""
    text = f"{value:.6f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def format_effect(material: Material) -> str:
    """Return the COLLADA effect of a material, with Phong shading."""
    rows = []
    for tag, color in (
        ("emission", material.emission),
        ("diffuse", material.diffuse),
        ("specular", material.specular),
    ):
        rows.append(f"          <{tag}><color>{' '.join(map(format_number, color))} 1</color></{tag}>")
    return "\n".join(
        [
            f'    <effect id="{material.name}-effect">',
            "      <profile_COMMON>",
            '        <technique sid="common"><phong>',
            *rows,
            f"          <shininess><float>{format_number(material.shininess)}</float></shininess>",
            "        </phong></technique>",
            "      </profile_COMMON>",
            "    </effect>",
        ]
    )


def format_source(identifier: str, vectors: Sequence[Vector]) -> str:
    """Return a COLLADA source of x, y, z triples, one per line."""
    rows = "\n".join("          " + " ".join(map(format_number, vector)) for vector in vectors)
    accessor = f'<accessor source="#{identifier}-array" count="{len(vectors)}" stride="3">'
    return "\n".join(
        [
            f'        <source id="{identifier}">',
            f'          <float_array id="{identifier}-array" count="{3 * len(vectors)}">',
            rows,
            "          </float_array>",
            f"          <technique_common>{accessor}",
            '            <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>',
            "          </accessor></technique_common>",
            "        </source>",
        ]
    )


def format_geometry(part: Part) -> str:
    """Return the COLLADA geometry of a part.

    Equal points and equal normals are written once.
    """
    positions: dict[Vector, int] = {}
    normals: dict[Vector, int] = {}
    indices = []
    for triangle in part.triangles:
        for corner, normal in zip(triangle.corners, triangle.normals, strict=True):
            point_index = positions.setdefault(round_vector(corner), len(positions))
            facing = normals.setdefault(round_vector(normal), len(normals))
            indices.append(f"{point_index} {facing}")
    rows = "\n".join("          " + "  ".join(indices[start : start + 3]) for start in range(0, len(indices), 3))
    name = part.name
    return "\n".join(
        [
            f'    <geometry id="{name}-mesh" name="{name}">',
            "      <mesh>",
            format_source(f"{name}-positions", list(positions)),
            format_source(f"{name}-normals", list(normals)),
            f'        <vertices id="{name}-vertices">',
            f'          <input semantic="POSITION" source="#{name}-positions"/>',
            "        </vertices>",
            f'        <triangles material="{part.material.name}" count="{len(part.triangles)}">',
            f'          <input semantic="VERTEX" source="#{name}-vertices" offset="0"/>',
            f'          <input semantic="NORMAL" source="#{name}-normals" offset="1"/>',
            "          <p>",
            rows,
            "          </p>",
            "        </triangles>",
            "      </mesh>",
            "    </geometry>",
        ]
    )


def round_vector(vector: Vector) -> Vector:
    """Return a vector rounded as in the file; adding zero turns -0.0 into 0.0."""
    return (round(vector[0], 6) + 0.0, round(vector[1], 6) + 0.0, round(vector[2], 6) + 0.0)


def format_node(part: Part) -> str:
    """Return the node of a part in the scene."""
    name, material = part.name, part.material.name
    return "\n".join(
        [
            f'      <node id="{name}" name="{name}">',
            f'        <instance_geometry url="#{name}-mesh"><bind_material><technique_common>',
            f'          <instance_material symbol="{material}" target="#{material}-material"/>',
            "        </technique_common></bind_material></instance_geometry>",
            "      </node>",
        ]
    )


def generate() -> str:
    """Return the text of the file."""
    parts = make_kinect()
    materials = list(dict.fromkeys(part.material for part in parts))
    # COLLADA requires both dates; they are fixed, so that the file depends only on this program.
    return "\n".join(
        [
            '<?xml version="1.0" encoding="utf-8"?>',
            "<!-- SPDX-License-Identifier: Apache-2.0. Generated by tools/make_kinect_mesh.py of Linkwright. -->",
            '<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">',
            "  <asset>",
            "    <contributor><authoring_tool>make_kinect_mesh.py</authoring_tool></contributor>",
            "    <created>2000-01-01T00:00:00Z</created>",
            "    <modified>2000-01-01T00:00:00Z</modified>",
            '    <unit name="meter" meter="1"/>',
            "    <up_axis>Z_UP</up_axis>",
            "  </asset>",
            "  <library_effects>",
            *map(format_effect, materials),
            "  </library_effects>",
            "  <library_materials>",
            *(
                f'    <material id="{name}-material" name="{name}"><instance_effect url="#{name}-effect"/></material>'
                for name in (material.name for material in materials)
            ),
            "  </library_materials>",
            "  <library_geometries>",
            *map(format_geometry, parts),
            "  </library_geometries>",
            "  <library_visual_scenes>",
            '    <visual_scene id="scene" name="kinect">',
            *map(format_node, parts),
            "    </visual_scene>",
            "  </library_visual_scenes>",
            '  <scene><instance_visual_scene url="#scene"/></scene>',
            "</COLLADA>",
            "",
        ]
    )


def main(arguments: Sequence[str]) -> int:
    """Write the file, or with ``--check`` report whether it is current."""
    text = generate()
    if "--check" in arguments:
        current = TARGET.read_text(encoding="utf-8") if TARGET.exists() else ""
        if current != text:
            print(f"{TARGET} is stale: run python tools/make_kinect_mesh.py", file=sys.stderr)
            return 1
        return 0
    TARGET.parent.mkdir(parents=True, exist_ok=True)
    TARGET.write_text(text, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
