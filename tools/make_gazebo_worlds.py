"""Write the worlds and models of ``robots/my_robot_gazebo``.

Usage: python tools/make_gazebo_worlds.py [--check]

The worlds consist of boxes, cylinders, spheres and a few meshes (`gazebo_models.py`). Each world has a ground and
light. The start of the robot, at the origin and facing x, is free. The output has the same bytes on every machine.
"""

from __future__ import annotations

import math
import random
import sys
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from gazebo_models import MODELS, format_model_config
from gazebo_sdf import (
    BLACK,
    BLUE,
    GRAY,
    GREEN,
    RED,
    WALL,
    WHITE,
    WOOD,
    YELLOW,
    Body,
    Include,
    Model,
    Part,
    Pose,
    box,
    cylinder,
    sdf,
    sphere,
)

PACKAGE = Path(__file__).resolve().parent.parent / "robots" / "my_robot_gazebo"

Point = tuple[float, float]
"""A point on the ground: x and y in meters."""
Line = tuple[Point, Point]

GROUND = """\
    <model name="ground">
      <static>true</static>
      <link name="link">
        <collision name="ground">
          <geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>
          <surface><friction><ode><mu>1</mu><mu2>1</mu2></ode></friction></surface>
        </collision>
        <visual name="ground">
          <cast_shadows>false</cast_shadows>
          <geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>
          <material><ambient>0.7 0.7 0.7 1</ambient><diffuse>0.7 0.7 0.7 1</diffuse></material>
        </visual>
      </link>
    </model>"""

PHYSICS_AND_SCENE = """\
    <physics type="ode">
      <max_step_size>0.001</max_step_size>
      <real_time_factor>1</real_time_factor>
      <real_time_update_rate>1000</real_time_update_rate>
    </physics>

    <scene>
      <ambient>0.5 0.5 0.5 1</ambient>
      <background>0.72 0.80 0.88 1</background>
      <shadows>true</shadows>
    </scene>

    <light name="sun" type="directional">
      <cast_shadows>true</cast_shadows>
      <pose>0 0 10 0 0 0</pose>
      <diffuse>0.8 0.8 0.8 1</diffuse>
      <specular>0.2 0.2 0.2 1</specular>
      <attenuation>
        <range>1000</range>
        <constant>0.9</constant>
        <linear>0.01</linear>
        <quadratic>0.001</quadratic>
      </attenuation>
      <direction>-0.4 0.3 -0.9</direction>
    </light>"""


def world(name: str, objects: Sequence[Model | Include]) -> str:
    """Return a world with ground, light and the given objects."""
    parts = [PHYSICS_AND_SCENE, GROUND, *(thing.xml() for thing in objects)]
    return sdf(f'  <world name="{name}">\n\n' + "\n\n".join(parts) + "\n\n  </world>")


def wall(name: str, start: Point, end: Point, height: float, thickness: float) -> Part:
    """Return a wall between two points on the ground.

    It extends beyond both by half its thickness.
    """
    length = math.dist(start, end) + thickness
    pose = Pose(
        (start[0] + end[0]) / 2, (start[1] + end[1]) / 2, height / 2, math.atan2(end[1] - start[1], end[0] - start[0])
    )
    return box(name, (length, thickness, height), pose, WALL)


def walls(lines: Iterable[Line], height: float, thickness: float) -> Model:
    """Return all walls of a building as one static model."""
    parts = [wall(f"wall_{index}", *ends, height, thickness) for index, ends in enumerate(lines, start=1)]
    return Model("walls", parts)


def rectangle(left: float, right: float, low: float, high: float) -> list[Line]:
    """Return the four sides of a rectangle in x and y, in meters."""
    corners = [(left, low), (right, low), (right, high), (left, high)]
    return [(corners[index], corners[(index + 1) % 4]) for index in range(4)]


def obstacles() -> list[Model | Include]:
    """Return a room of 10 m x 8 m with pillars, blocks, a ramp and two movable crates."""
    blocks = [
        (2.5, 1.5, 0.8, 0.5, 0.6, 0.5, RED),
        (-2.2, 2.4, 1.2, 0.4, 0.8, -0.3, BLUE),
        (-3.0, -1.8, 0.6, 0.6, 0.5, 0.8, GREEN),
        (1.2, -2.6, 1.6, 0.3, 0.4, 0.2, YELLOW),
        (3.8, -0.6, 0.4, 1.4, 0.7, 0.0, GRAY),
    ]
    pillars = [(1.0, 2.9), (-1.2, -1.2), (3.2, 2.8), (-3.9, 0.7), (3.4, -2.9)]
    parts = [
        box(f"block_{index}", (x_size, y_size, tall), Pose(x, y, tall / 2, yaw), color)
        for index, (x, y, x_size, y_size, tall, yaw, color) in enumerate(blocks, start=1)
    ]
    parts += [
        cylinder(f"pillar_{index}", 0.15, 1.2, Pose(x, y, 0.6), GRAY) for index, (x, y) in enumerate(pillars, start=1)
    ]
    ramp = box("ramp", (1.2, 0.9, 0.05), Pose(-3.6, 3.0, 0.08, pitch=-0.12), WOOD)
    return [
        walls(rectangle(-5, 5, -4, 4), 1.0, 0.15),
        Model("obstacles", [*parts, ramp]),
        Include("crate", "crate_1", Pose(1.8, -0.9, 0, 0.4)),
        Include("crate", "crate_2", Pose(-1.6, 0.9, 0, 1.1)),
    ]


def house() -> list[Model | Include]:
    """Return a house of 10 m x 8 m without a roof, with five rooms and doors of 1 m width."""
    lines: list[Line] = [
        *rectangle(-5, 5, -4, 4)[1:],
        ((-5, -4), (-0.5, -4)),  # the front door is between these two
        ((0.5, -4), (5, -4)),
        ((-5, 0.9), (-2.5, 0.9)),  # living room | bedroom
        ((-1.5, 0.9), (-0.9, 0.9)),
        ((-0.9, 0.9), (-0.9, 4)),
        ((0.9, 0.9), (0.9, 2.0)),  # hall | bath
        ((0.9, 3.0), (0.9, 4)),
        ((0.9, 0.9), (5, 0.9)),
        ((1.5, -4), (1.5, -2.2)),  # living room | kitchen
        ((1.5, -1.2), (1.5, 0.9)),
    ]
    furniture = Model(
        "furniture",
        [
            box("sofa_seat", (0.8, 1.8, 0.40), Pose(-4.4, -1.8, 0.20), BLUE),
            box("sofa_back", (0.25, 1.8, 0.80), Pose(-4.75, -1.8, 0.40), BLUE),
            box("low_table", (0.6, 1.0, 0.35), Pose(-3.2, -1.8, 0.175), WOOD),
            box("shelf", (1.6, 0.35, 1.6), Pose(-3.0, -3.72, 0.80), WOOD),
            box("bed", (1.5, 2.0, 0.45), Pose(-4.1, 2.85, 0.225), WHITE),
            box("pillow", (1.1, 0.35, 0.12), Pose(-4.1, 3.6, 0.51), YELLOW, solid=False),
            box("wardrobe", (1.2, 0.55, 1.7), Pose(-1.7, 3.6, 0.85), WOOD),
            box("kitchen_counter", (0.6, 3.0, 0.9), Pose(4.6, -1.6, 0.45), GRAY),
            box("bath_tub", (1.7, 0.75, 0.5), Pose(4.0, 3.5, 0.25), WHITE),
            box("wash_basin", (0.5, 0.4, 0.8), Pose(4.6, 1.3, 0.40), WHITE),
            box("table_top", (1.0, 1.0, 0.05), Pose(3.0, -2.6, 0.72), WOOD),
            *(
                cylinder(f"table_leg_{index}", 0.03, 0.70, Pose(3.0 + x, -2.6 + y, 0.35), WOOD)
                for index, (x, y) in enumerate(((0.45, 0.45), (-0.45, 0.45), (-0.45, -0.45), (0.45, -0.45)), start=1)
            ),
        ],
    )
    floors = [
        ("living_room_floor", -1.75, -1.55, 6.35, 4.75, (0.66, 0.50, 0.34)),
        ("kitchen_floor", 3.25, -1.55, 3.35, 4.75, (0.75, 0.75, 0.72)),
        ("bedroom_floor", -2.95, 2.45, 3.95, 2.95, (0.50, 0.55, 0.66)),
        ("hall_floor", 0.0, 2.45, 1.65, 2.95, (0.62, 0.58, 0.52)),
        ("bath_floor", 2.95, 2.45, 3.95, 2.95, (0.55, 0.70, 0.72)),
    ]
    carpet = [
        box(name, (x_size, y_size, 0.002), Pose(x, y, 0.001), color, solid=False)
        for name, x, y, x_size, y_size, color in floors
    ]
    return [
        walls(lines, 1.8, 0.15),
        Model("floors", carpet),
        furniture,
        Include("person_standing", "visitor", Pose(0.0, 3.2, 0, -math.pi / 2)),
    ]


def maze(size: int = 9, cell: float = 1.1, seed: int = 7) -> list[Model | Include]:
    """Return a maze of square cells with one path between any two.

    The robot starts in one corner and leaves at the opposite one.
    """
    generator = random.Random(seed)
    cell_position, visited = (0, 0), {(0, 0)}
    path, open_between = [cell_position], set()
    while path:
        cell_position = path[-1]
        steps = [(cell_position[0] + dx, cell_position[1] + dy) for dx, dy in ((1, 0), (0, 1), (-1, 0), (0, -1))]
        unvisited = [step for step in steps if step not in visited and all(0 <= value < size for value in step)]
        if not unvisited:
            path.pop()
            continue
        next_position = unvisited[int(generator.random() * len(unvisited))]
        open_between |= {(cell_position, next_position), (next_position, cell_position)}
        visited.add(next_position)
        path.append(next_position)
    lines: list[Line] = []
    for line in range(size + 1):
        # Walls along x below row `line`, and along y left of column `line`; the exit is the right side of the last
        # cell.
        has_wall_below = [((index, line - 1), (index, line)) not in open_between for index in range(size)]
        has_wall_left = [((line - 1, index), (line, index)) not in open_between for index in range(size)]
        if line == size:
            has_wall_left[-1] = False
        lines += [((low, fixed), (high, fixed)) for fixed, low, high in _iterate_wall_spans(line, has_wall_below, cell)]
        lines += [((fixed, low), (fixed, high)) for fixed, low, high in _iterate_wall_spans(line, has_wall_left, cell)]
    finish = box("finish", (0.9, 0.9, 0.002), Pose(size * cell, (size - 1) * cell, 0.001), GREEN, solid=False)
    return [walls(lines, 0.6, 0.08), Model("finish", [finish])]


def _iterate_wall_spans(line: int, closed: Sequence[bool], cell: float) -> Iterator[tuple[float, float, float]]:
    """Yield the position of a grid line, and the start and end of each of its walls, in meters.

    Cell 0 is centered at 0.
    """
    start = None
    for index, is_wall in enumerate([*closed, False]):
        if is_wall:
            start = index if start is None else start
        elif start is not None:
            yield (line - 0.5) * cell, (start - 0.5) * cell, (index - 0.5) * cell
            start = None


def playground() -> list[Model | Include]:
    """Return a yard with objects to detect: a slalom of cones, balls, crates, people and signs."""
    slalom = [
        Include("traffic_cone", f"cone_{index}", Pose(1.5 + 1.2 * index, 0.35 * (-1) ** index)) for index in range(1, 5)
    ]
    colored = [
        Model(
            f"{word}_ball",
            [sphere("ball", 0.15, Pose(), color)],
            Pose(x, y, 0.15),
            Body(0.5, (0.0075, 0.0075, 0.0075)),
        )
        for word, color, x, y in (("red", RED, 2.0, -1.6), ("green", GREEN, 2.8, -2.2), ("blue", BLUE, 1.4, -2.6))
    ]
    stacked = [
        Include("crate", "crate_1", Pose(3.2, 2.4, 0, 0.2)),
        Include("crate", "crate_2", Pose(3.8, 2.6, 0, -0.3)),
        Include("crate", "crate_3", Pose(3.5, 2.5, 0.41, 0.1)),
    ]
    drums = Model(
        "drums",
        [
            cylinder("blue_drum", 0.28, 0.85, Pose(-2.5, -3.0, 0.425), BLUE),
            cylinder("yellow_drum", 0.28, 0.85, Pose(-3.2, -2.7, 0.425), YELLOW),
        ],
    )
    return [
        walls(rectangle(-5, 8, -5, 5), 0.8, 0.12),
        drums,
        *slalom,
        Include("ball", "football", Pose(1.2, 1.0)),
        *colored,
        *stacked,
        Include("person_standing", "adult_1", Pose(4.5, -1.8, 0, 2.6)),
        Include("person_standing", "adult_2", Pose(-2.6, 2.6, 0, -0.8)),
        Include("child_standing", "child", Pose(4.9, -2.4, 0, 2.4)),
        Include("stop_sign", "stop_sign", Pose(7.2, 1.2, 0, math.pi)),
        Include("yield_sign", "yield_sign", Pose(6.2, -2.8, 0, 2.6)),
    ]


def line_track(steps: int = 120) -> list[Model | Include]:
    """Return a closed black line of 5 cm on a white floor, with two cones beside it.

    At the origin, the line is along x.
    """

    def point(index: int) -> Point:
        t = 2 * math.pi * index / steps
        return 3.0 * math.sin(t), 1.6 * (1 - math.cos(t)) + 0.35 * (math.cos(3 * t) - 1)

    pieces = []
    for index in range(steps):
        (x, y), (next_x, next_y) = point(index), point(index + 1)
        length = math.dist((x, y), (next_x, next_y)) + 0.01
        pose = Pose((x + next_x) / 2, (y + next_y) / 2, 0.003, math.atan2(next_y - y, next_x - x))
        pieces.append(box(f"piece_{index + 1}", (length, 0.05, 0.002), pose, BLACK, solid=False))
    floor = box("floor", (8.0, 6.0, 0.002), Pose(0, 1.6, 0.001), WHITE, solid=False)
    return [
        Model("floor", [floor]),
        Model("line", pieces),
        Include("traffic_cone", "cone_1", Pose(0.0, 1.6)),
        Include("traffic_cone", "cone_2", Pose(-3.6, 3.8)),
    ]


def table() -> list[Model | Include]:
    """Return a table before the robot, with three cubes to grasp and a tray to put them on."""
    top = box("top", (0.5, 1.1, 0.3), Pose(0.75, 0, 0.15), WOOD)
    tray = box("tray", (0.2, 0.2, 0.004), Pose(0.62, 0.3, 0.302), WHITE, solid=False)
    inertia = 0.06 * 0.04**2 / 6
    cubes = [
        Model(
            f"{word}_cube",
            [box("cube", (0.04, 0.04, 0.04), Pose(), color)],
            Pose(x, y, 0.32, yaw),
            Body(0.06, (inertia,) * 3),
        )
        for word, color, x, y, yaw in (
            ("red", RED, 0.6, 0.12, 0.3),
            ("green", GREEN, 0.65, -0.02, -0.5),
            ("blue", BLUE, 0.58, -0.15, 0.1),
        )
    ]
    return [Model("table", [top, tray]), *cubes]


WORLDS = {
    "empty": list,
    "obstacles": obstacles,
    "house": house,
    "maze": maze,
    "playground": playground,
    "line_track": line_track,
    "table": table,
}


def generate() -> dict[str, str]:
    """Return the texts of all files, by path below the package."""
    files = {f"worlds/{name}.world": world(name, make()) for name, make in WORLDS.items()}
    for name, (make, description) in MODELS.items():
        model, meshes = make()
        files[f"models/{name}/model.config"] = format_model_config(name, description)
        files[f"models/{name}/model.sdf"] = sdf(model.xml("  "))
        files |= {f"models/{name}/meshes/{file}": text for file, text in meshes.items()}
    return files


def main(arguments: Sequence[str]) -> int:
    """Write the files, or with ``--check`` report whether they are current."""
    stale = []
    for name, text in generate().items():
        path = PACKAGE / name
        if "--check" in arguments:
            if not path.is_file() or path.read_text(encoding="utf-8") != text:
                stale.append(path)
            continue
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8", newline="\n")
    for path in stale:
        print(f"{path} is stale: run python tools/make_gazebo_worlds.py", file=sys.stderr)
    return 1 if stale else 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
