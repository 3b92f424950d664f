"""The elements of SDF 1.6 for the worlds and models of ``robots/my_robot_gazebo``.

Both Gazebo Classic and the newer Gazebo read SDF 1.6. Lengths are meters, angles radians, masses kilograms.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

Vector = tuple[float, float, float]
Color = tuple[float, float, float]

WALL = (0.82, 0.80, 0.76)
WOOD = (0.55, 0.38, 0.22)
ORANGE = (0.95, 0.36, 0.05)
WHITE = (0.95, 0.95, 0.95)
BLACK = (0.04, 0.04, 0.04)
RED = (0.78, 0.05, 0.06)
GREEN = (0.10, 0.55, 0.20)
BLUE = (0.10, 0.25, 0.70)
YELLOW = (0.95, 0.80, 0.10)
GRAY = (0.50, 0.52, 0.55)
SKIN = (0.85, 0.65, 0.52)


def number(value: float) -> str:
    """Return a number with at most four decimal places, without negative zero."""
    text = f"{value:.4f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def numbers(values: Iterable[float]) -> str:
    """Return numbers separated by spaces."""
    return " ".join(map(number, values))


@dataclass(frozen=True)
class Pose:
    """A position in meters, and rotations about x (roll), y (pitch) and z (yaw) in radians."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    yaw: float = 0.0
    pitch: float = 0.0
    roll: float = 0.0

    def __str__(self) -> str:
        return numbers((self.x, self.y, self.z, self.roll, self.pitch, self.yaw))


@dataclass(frozen=True)
class Part:
    """A shape of one color in a link: a visual and, if it is solid, a collision."""

    name: str
    geometry: str
    pose: Pose
    color: Color
    solid: bool = True

    def xml(self, indent: str) -> str:
        """Return the collision and the visual."""
        rows = []
        if self.solid:
            rows += [f'<collision name="{self.name}">', *self._format_pose(), "</collision>"]
        color = numbers((*self.color, 1))
        colors = f"<ambient>{color}</ambient><diffuse>{color}</diffuse><specular>0.1 0.1 0.1 1</specular>"
        rows += [
            f'<visual name="{self.name}">',
            *self._format_pose(),
            f"  <material>{colors}</material>",
            "</visual>",
        ]
        return "\n".join(indent + row for row in rows)

    def _format_pose(self) -> list[str]:
        pose = [] if self.pose == Pose() else [f"  <pose>{self.pose}</pose>"]
        return [*pose, f"  <geometry>{self.geometry}</geometry>"]


def box(name: str, size: Vector, pose: Pose, color: Color, *, solid: bool = True) -> Part:
    """Return a box centered at a pose."""
    return Part(name, f"<box><size>{numbers(size)}</size></box>", pose, color, solid)


def cylinder(name: str, radius: float, length: float, pose: Pose, color: Color, *, solid: bool = True) -> Part:
    """Return a cylinder along z, centered at a pose."""
    geometry = f"<cylinder><radius>{number(radius)}</radius><length>{number(length)}</length></cylinder>"
    return Part(name, geometry, pose, color, solid)


def sphere(name: str, radius: float, pose: Pose, color: Color, *, solid: bool = True) -> Part:
    """Return a sphere centered at a pose."""
    return Part(name, f"<sphere><radius>{number(radius)}</radius></sphere>", pose, color, solid)


def mesh(name: str, file: str, pose: Pose, color: Color, *, solid: bool = True) -> Part:
    """Return a mesh of a model of this package, MODEL/meshes/FILE."""
    return Part(name, f"<mesh><uri>model://{file}</uri></mesh>", pose, color, solid)


@dataclass(frozen=True)
class Body:
    """The mass in kg of a movable object, and its moments about the center in kg m^2."""

    mass: float
    moments: Vector
    center: Vector = (0.0, 0.0, 0.0)

    def xml(self, indent: str) -> str:
        """Return the ``<inertial>`` of the link."""
        xx, yy, zz = map(moment, self.moments)
        rows = [
            "<inertial>",
            f"  <pose>{numbers((*self.center, 0, 0, 0))}</pose>",
            f"  <mass>{number(self.mass)}</mass>",
            f"  <inertia><ixx>{xx}</ixx><ixy>0</ixy><ixz>0</ixz><iyy>{yy}</iyy><iyz>0</iyz><izz>{zz}</izz></inertia>",
            "</inertial>",
        ]
        return "\n".join(indent + row for row in rows)


def moment(value: float) -> str:
    """Return a moment of inertia as text, with enough digits for small values."""
    return f"{value:.4g}"


@dataclass(frozen=True)
class Model:
    """A rigid group of parts; without a body, it is static."""

    name: str
    parts: Sequence[Part]
    pose: Pose = field(default_factory=Pose)
    body: Body | None = None

    def xml(self, indent: str = "    ") -> str:
        """Return the model as an element of a world or of a separate file."""
        pose_rows = [] if self.pose == Pose() else [f"{indent}  <pose>{self.pose}</pose>"]
        rows = [
            f'{indent}<model name="{self.name}">',
            *([f"{indent}  <static>true</static>"] if self.body is None else []),
            *pose_rows,
            f'{indent}  <link name="link">',
            *([self.body.xml(indent + "    ")] if self.body else []),
            *(part.xml(indent + "    ") for part in self.parts),
            f"{indent}  </link>",
            f"{indent}</model>",
        ]
        return "\n".join(rows)


@dataclass(frozen=True)
class Include:
    """A model of this package, placed in a world under a name."""

    model: str
    name: str
    pose: Pose

    def xml(self, indent: str = "    ") -> str:
        """Return the ``<include>`` element."""
        rows = [
            "<include>",
            f"  <uri>model://{self.model}</uri>",
            f"  <name>{self.name}</name>",
            f"  <pose>{self.pose}</pose>",
            "</include>",
        ]
        return "\n".join(indent + row for row in rows)


def sdf(content: str) -> str:
    """Return the text of an SDF 1.6 file."""
    made_by = "SPDX-License-Identifier: Apache-2.0. Generated by tools/make_gazebo_worlds.py of Linkwright."
    return f'<?xml version="1.0"?>\n<!-- {made_by} -->\n<sdf version="1.6">\n{content}\n</sdf>\n'
