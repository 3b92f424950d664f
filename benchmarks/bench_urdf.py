"""How long URDF text takes to become a validated robot, and forward kinematics of all its links.

Run it with ``python benchmarks/bench_urdf.py [URDF ...]``; without a file it makes robots of 23 and 88 links. Times are
the best of several rounds, in the units that the targets are given in; "cold" forgets the values remembered from
earlier readings.
"""

from __future__ import annotations

import random
import sys
from collections.abc import Callable
from pathlib import Path
from time import perf_counter

import numpy as np

from linkwright.kinematics import KinematicTree
from linkwright.urdf import Robot, load, materials, origins, read, values
from linkwright.xmltree import parse

ROUNDS = 15
CONFIGURATIONS = 10_000


def robot_text(links: int, moving: int) -> str:
    """A robot with as many links and moving joints, each link with inertia, two shapes and numbers of its own."""
    chance = random.Random(links)

    def numbers(count: int) -> str:
        return " ".join(repr(chance.uniform(-1, 1)) for _ in range(count))

    parts = ['<robot name="bench">', '<material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>']
    for index in range(links):
        tensor = " ".join(f'{name}="{numbers(1)}"' for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
        parts.append(
            f"""  <link name="link_{index}">
    <inertial>
      <origin xyz="{numbers(3)}" rpy="0 0 0"/>
      <mass value="{numbers(1)}"/>
      <inertia {tensor}/>
    </inertial>
    <visual>
      <origin xyz="0 0 0" rpy="{numbers(3)}"/>
      <geometry>
        <mesh filename="package://bench/meshes/visual_{index}.dae"/>
      </geometry>
      <material name="grey"/>
    </visual>
    <collision>
      <origin xyz="{numbers(3)}" rpy="0 0 0"/>
      <geometry>
        <cylinder radius="0.1" length="0.2"/>
      </geometry>
    </collision>
  </link>"""
        )
    for index in range(1, links):
        kind = "revolute" if index <= moving else "fixed"
        limit = '<limit lower="-3.1" upper="3.1" effort="10" velocity="1"/>' if kind == "revolute" else ""
        parts.append(
            f"""  <joint name="joint_{index}" type="{kind}">
    <origin xyz="{numbers(3)}" rpy="{numbers(3)}"/>
    <parent link="link_{max(0, index - chance.randint(1, 3))}"/>
    <child link="link_{index}"/>
    <axis xyz="0 0 1"/>
    {limit}
  </joint>"""
        )
    return "\n".join([*parts, "</robot>"])


def best(action: Callable[[], object], repeat: int = 1) -> float:
    """The shortest time of one call, in seconds."""
    times = []
    for _ in range(ROUNDS):
        start = perf_counter()
        for _ in range(repeat):
            action()
        times.append((perf_counter() - start) / repeat)
    return min(times)


def forget() -> None:
    """Empty what the reader remembers of values it has seen."""
    for cached in (values.number, values.vector3, origins._pose, materials._rgba):
        cached.cache_clear()


def report(name: str, text: str) -> Robot:
    """Time reading one text, print the row, and give the robot."""
    document = parse(text, "<bench>")

    def cold() -> None:
        forget()
        load(text)

    robot = load(text)
    whole, cold_time = best(lambda: load(text)), best(cold)
    parsing, reading = best(lambda: parse(text, "<bench>")), best(lambda: read(document))
    print(
        f"{name:40} {len(robot.links):4} links {len(text) / 1000:6.1f} kB   text to robot {whole * 1e3:6.2f} ms "
        f"(cold {cold_time * 1e3:.2f})   parse {parsing * 1e3:.2f}   read {reading * 1e3:.2f}"
    )
    return robot


def report_kinematics(name: str, robot: Robot) -> None:
    """Time forward kinematics of all links and print the row."""
    tree = KinematicTree(robot)
    positions = np.random.default_rng(0).uniform(-1, 1, (CONFIGURATIONS, len(tree.joint_names)))
    batch = best(lambda: tree.forward(positions)) / CONFIGURATIONS
    single = best(lambda: tree.forward(positions[0]), repeat=200)
    print(
        f"{name:40} {len(tree.link_names):4} links {len(tree.joint_names):3} joints   forward of {CONFIGURATIONS} "
        f"{batch * 1e6:6.2f} us each   of one {single * 1e6:6.1f} us"
    )


def main(paths: list[str]) -> None:
    """Time the files given, or robots made up."""
    texts = {path: Path(path).read_text() for path in paths} or {
        "made up": robot_text(23, 12),
        "made up, large": robot_text(88, 45),
    }
    robots = {name: report(Path(name).name, text) for name, text in texts.items()}
    for name, robot in robots.items():
        report_kinematics(Path(name).name, robot)


if __name__ == "__main__":
    main(sys.argv[1:])
