"""The scene of a run: the robot's initial pose, and the models that a judge adds."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import atan2, hypot
from typing import NamedTuple
from xml.sax.saxutils import quoteattr

Color = tuple[float, float, float]

WHITE: Color = (0.9, 0.9, 0.9)
BLACK: Color = (0.03, 0.03, 0.03)
GRAY: Color = (0.5, 0.5, 0.55)
RED: Color = (0.85, 0.1, 0.1)
GREEN: Color = (0.1, 0.65, 0.2)
BLUE: Color = (0.1, 0.25, 0.85)
YELLOW: Color = (0.9, 0.8, 0.1)


class OtherRobot(NamedTuple):
    """A robot to add to a world. The attributes are the arguments of `Scene.add_robot`."""

    file: str
    name: str
    pose: tuple[float, float, float]


class Scene:
    """The models to add to a world, and the initial pose of the robot.

    Attributes:
        start: the initial x and y of the robot in m, and its yaw in rad.
        start_height: the initial height of the robot's frame, in m.
        robots: the other robots, added by `add_robot`.
    """

    def __init__(self) -> None:
        self.start = (0.0, 0.0, 0.0)
        self.start_height = 0.0
        self.robots: list[OtherRobot] = []
        self._models: list[str] = []

    def add_box(
        self,
        name: str,
        center: Sequence[float],
        size: Sequence[float],
        color: Color = GRAY,
        *,
        yaw: float = 0.0,
        mass: float | None = None,
    ) -> None:
        """Add a box.

        Args:
            name: the name of the model.
            center: the x, y, z of its center, in m.
            size: its length, width and height, in m.
            color: red, green and blue, from 0 to 1.
            yaw: its rotation about z, in rad.
            mass: the mass in kg; None for a box that cannot be moved.
        """
        self._add(name, center, yaw, f"<box><size>{_join_numbers(size)}</size></box>", color, mass, size)

    def add_cylinder(
        self,
        name: str,
        center: Sequence[float],
        radius: float,
        height: float,
        color: Color = GRAY,
        *,
        mass: float | None = None,
    ) -> None:
        """Add an upright cylinder. The arguments are those of `add_box`."""
        shape = f"<cylinder><radius>{radius:.4f}</radius><length>{height:.4f}</length></cylinder>"
        self._add(name, center, 0.0, shape, color, mass, (2 * radius, 2 * radius, height))

    def add_wall(self, name: str, start: Sequence[float], end: Sequence[float], height: float = 0.5) -> None:
        """Add a wall, 0.1 m thick, between two points x, y on the ground."""
        length = hypot(end[0] - start[0], end[1] - start[1])
        yaw = atan2(end[1] - start[1], end[0] - start[0])
        middle = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2, height / 2)
        self.add_box(name, middle, (length + 0.1, 0.1, height), WHITE, yaw=yaw)

    def add_room(self, corners: Sequence[Sequence[float]], height: float = 0.5) -> None:
        """Add a closed polygon of walls between corners, named ``wall_1``, ``wall_2``, ..."""
        for number, corner in enumerate(corners, start=1):
            self.add_wall(f"wall_{number}", corner, corners[number % len(corners)], height)

    def add_tile(self, name: str, center: Sequence[float], size: float, color: Color = GREEN) -> None:
        """Add a flat colored square on the ground, without contacts."""
        box = f"<box><size>{size:.4f} {size:.4f} 0.002</size></box>"
        visual = f'<visual name="visual"><geometry>{box}</geometry>{_format_material(color)}</visual>'
        self._models.append(
            f"<model name={quoteattr(name)}><static>true</static><pose>{_join_numbers((*center, 0.002))} 0 0 0</pose>"
            f'<link name="link">{visual}</link></model>'
        )

    def add_person(self, name: str, position: Sequence[float], color: Color = RED) -> None:
        """Add a standing person, which the judge moves with ``simulation.set_model_pose``."""
        legs = "<cylinder><radius>0.16</radius><length>0.1</length></cylinder>"
        coat = "<cylinder><radius>0.18</radius><length>1.3</length></cylinder>"
        head = "<sphere><radius>0.13</radius></sphere>"
        parts = (("legs", 0.05, legs, BLACK), ("coat", 0.75, coat, color), ("head", 1.55, head, (0.8, 0.6, 0.5)))
        visuals = "".join(
            f'<visual name="{part}"><pose>0 0 {z} 0 0 0</pose><geometry>{shape}</geometry>'
            f"{_format_material(paint)}</visual>"
            for part, z, shape, paint in parts
        )
        body = "<cylinder><radius>0.18</radius><length>1.6</length></cylinder>"
        collision = f'<collision name="body"><pose>0 0 0.8 0 0 0</pose><geometry>{body}</geometry></collision>'
        self._models.append(
            f"<model name={quoteattr(name)}><pose>{_join_numbers((*position, 0.0))} 0 0 0</pose>"
            f'<link name="link"><kinematic>true</kinematic>{collision}{visuals}</link></model>'
        )

    def add_block(self, name: str, position: Sequence[float], size: float, color: Color) -> None:
        """Add a cube on the ground, which the judge moves."""
        shape = f"<geometry><box><size>{size:.4f} {size:.4f} {size:.4f}</size></box></geometry>"
        self._models.append(
            f"<model name={quoteattr(name)}><pose>{_join_numbers((*position, size / 2))} 0 0 0</pose>"
            f'<link name="link"><kinematic>true</kinematic><collision name="collision">{shape}</collision>'
            f'<visual name="visual">{shape}{_format_material(color)}</visual></link></model>'
        )

    def add_table(self, name: str, center: Sequence[float], yaw: float, half: float, color: Color = YELLOW) -> None:
        """Add a table with four legs that a robot can pass under, and that the judge moves.

        Args:
            name: the name of the model.
            center: the x and y of its center, in m.
            yaw: its rotation, in rad.
            half: the distance from the center to the legs along x and y, in m.
            color: red, green and blue, from 0 to 1.
        """
        leg = "<box><size>0.06 0.06 0.5</size></box>"
        corners = [(x, y, 0.25) for x in (-half, half) for y in (-half, half)]
        parts = [(f"leg_{number}", corner, leg) for number, corner in enumerate(corners, start=1)]
        side = 2 * half + 0.06
        parts.append(("top", (0.0, 0.0, 0.52), f"<box><size>{side:.4f} {side:.4f} 0.04</size></box>"))
        shapes = "".join(
            f'<collision name="{part}"><pose>{_join_numbers(place)} 0 0 0</pose>'
            f"<geometry>{shape}</geometry></collision>"
            f'<visual name="{part}"><pose>{_join_numbers(place)} 0 0 0</pose><geometry>{shape}</geometry>'
            f"{_format_material(color)}</visual>"
            for part, place, shape in parts
        )
        self._models.append(
            f"<model name={quoteattr(name)}><pose>{_join_numbers((*center, 0.0))} 0 0 {yaw:.5f}</pose>"
            f'<link name="link"><kinematic>true</kinematic>{shapes}</link></model>'
        )

    def add_line(self, name: str, points: Sequence[Sequence[float]], width: float, color: Color = BLACK) -> None:
        """Add a flat line through points x, y on the ground.

        The line is a loop if the last point equals the first.
        """
        pieces = []
        for index, (first, second) in enumerate(pairwise(points)):
            length = hypot(second[0] - first[0], second[1] - first[1]) + 0.6 * width
            pose = ((first[0] + second[0]) / 2, (first[1] + second[1]) / 2, 0.002)
            yaw = atan2(second[1] - first[1], second[0] - first[0])
            pieces.append(
                f'<visual name="piece_{index}"><pose>{_join_numbers(pose)} 0 0 {yaw:.5f}</pose>'
                f"<geometry><box><size>{length:.4f} {width:.4f} 0.002</size></box></geometry>"
                f"{_format_material(color)}</visual>"
            )
        self._models.append(
            f'<model name={quoteattr(name)}><static>true</static><link name="link">{"".join(pieces)}</link></model>'
        )

    def add_robot(self, file: str, name: str, pose: Sequence[float]) -> None:
        """Add another robot, whose plugins need a namespace of their own.

        Args:
            file: its URDF or xacro file, relative to the folder of the exercise, or its ``package://`` URI.
            name: the name of the model.
            pose: its x and y in m, and its yaw in rad.
        """
        x, y, yaw = pose
        self.robots.append(OtherRobot(file, name, (x, y, yaw)))

    def add_sdf(self, text: str) -> None:
        """Add an SDF ``<model>`` or ``<include>``."""
        self._models.append(text)

    def insert_into(self, world: str, plugin: str) -> str:
        """Return the text of a world with the models and a plugin."""
        head, end, tail = world.rpartition("</world>")
        return "".join((head, *(f"    {model}\n" for model in self._models), f"    {plugin}\n  ", end, tail))

    def _add(
        self,
        name: str,
        center: Sequence[float],
        yaw: float,
        shape: str,
        color: Color,
        mass: float | None,
        size: Sequence[float],
    ) -> None:
        body = "<static>true</static>" if mass is None else ""
        inertial = "" if mass is None else _format_inertial(mass, size)
        self._models.append(
            f"<model name={quoteattr(name)}>{body}<pose>{_join_numbers(center)} 0 0 {yaw:.5f}</pose>"
            f'<link name="link">{inertial}<collision name="collision"><geometry>{shape}</geometry></collision>'
            f'<visual name="visual"><geometry>{shape}</geometry>{_format_material(color)}</visual></link></model>'
        )


def _format_inertial(mass: float, size: Sequence[float]) -> str:
    x, y, z = (length**2 for length in size)
    moments = (mass * (y + z) / 12, mass * (x + z) / 12, mass * (x + y) / 12)
    values = "".join(
        f"<{axis}>{value:.8f}</{axis}>" for axis, value in zip(("ixx", "iyy", "izz"), moments, strict=True)
    )
    return f"<inertial><mass>{mass:.4f}</mass><inertia>{values}</inertia></inertial>"


def _format_material(color: Color) -> str:
    values = f"{_join_numbers(color)} 1"
    return f"<material><ambient>{values}</ambient><diffuse>{values}</diffuse></material>"


def _join_numbers(values: Sequence[float]) -> str:
    return " ".join(f"{value:.5f}" for value in values)
