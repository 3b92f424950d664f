"""Robots for the measurements."""

from __future__ import annotations

import json
import random
import re
import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np

REPOSITORY = Path(__file__).resolve().parents[1]
CORPUS = REPOSITORY.parent / "shared" / "corpus"
SHIPPED = REPOSITORY / "robots" / "my_robot_description"


@dataclass(frozen=True)
class Model:
    """A description to expand, its arguments, and the folders of the packages that it names."""

    path: str
    arguments: dict[str, str]
    packages: dict[str, str]

    @property
    def name(self) -> str:
        """Return a short name for tables."""
        path = Path(self.path)
        return f"{path.parent.name}/{path.name}" + "".join(
            f" {name}:={value}" for name, value in self.arguments.items()
        )


def has_corpus() -> bool:
    """Return whether the real robots are beside the repository."""
    return (CORPUS / "manifest.json").is_file()


def find_models(folder: Path) -> list[Model]:
    """Return the descriptions to expand: the corpus, or else shipped and generated ones."""
    if has_corpus():
        manifest = json.loads((CORPUS / "manifest.json").read_text(encoding="utf-8"))
        packages = {name: str(CORPUS / place) for name, place in manifest["packages"].items()}
        return [Model(str(CORPUS / "robots" / model["entry"]), model["args"], packages) for model in manifest["models"]]
    paths = [path for path in sorted(SHIPPED.rglob("*.xacro")) if path.parent.name == "urdf"]
    for legs in (4, 16, 64):
        path = folder / f"crawler_{legs}.urdf.xacro"
        path.write_text(make_crawler(legs), encoding="utf-8")
        paths.append(path)
    return [Model(str(path), {}, {SHIPPED.name: str(SHIPPED)}) for path in paths]


def collect_models(folder: Path) -> list[Model]:
    """Return the descriptions below a folder of repositories, each with all packages there."""
    packages: dict[str, str] = {}
    for path in filter(Path.is_file, sorted(folder.rglob("package.xml"))):  # a checkout may have dangling links
        name = re.search(r"<name>\s*([\w-]+)\s*</name>", path.read_text(encoding="utf-8", errors="replace"))
        if name:
            packages.setdefault(name[1], str(path.parent))
    files = [path for path in sorted(folder.rglob("*")) if path.suffix in (".urdf", ".xacro") and path.is_file()]
    return [Model(str(path), {}, packages) for path in files]


def make_crawler(legs: int) -> str:
    """Return a xacro text with a macro for a leg of three links, called for each leg."""
    calls = "\n".join(
        f'  <xacro:leg name="leg_{leg}" x="${{{leg} * 0.1}}" side="{1 if leg % 2 else -1}"/>' for leg in range(legs)
    )
    return _CRAWLER.replace("CALLS", calls)


_CRAWLER = """<?xml version="1.0"?>
<robot name="crawler" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="length" value="0.3"/>
  <xacro:property name="mass" value="${length * 0.8}"/>
  <!-- a slim box -->
  <xacro:macro name="inertia" params="mass length">
    <inertial>
      <mass value="${mass}"/>
      <inertia ixx="${mass * length ** 2 / 12}" ixy="0" ixz="0" iyy="${mass * length ** 2 / 12}" iyz="0"
               izz="${mass * 0.0001}"/>
    </inertial>
  </xacro:macro>
  <xacro:macro name="segment" params="name parent length:=0.2 *origin">
    <link name="${name}">
      <visual>
        <origin xyz="0 0 ${-length / 2}" rpy="0 0 0"/>
        <geometry><box size="0.02 0.02 ${length}"/></geometry>
      </visual>
      <collision>
        <origin xyz="0 0 ${-length / 2}" rpy="0 0 0"/>
        <geometry><box size="0.02 0.02 ${length}"/></geometry>
      </collision>
      <xacro:inertia mass="${mass}" length="${length}"/>
    </link>
    <joint name="${name}_joint" type="revolute">
      <xacro:insert_block name="origin"/>
      <parent link="${parent}"/>
      <child link="${name}"/>
      <axis xyz="0 1 0"/>
      <limit lower="${-pi / 2}" upper="${pi / 2}" effort="10" velocity="3"/>
    </joint>
  </xacro:macro>
  <xacro:macro name="leg" params="name x side">
    <xacro:segment name="${name}_hip" parent="base_link">
      <origin xyz="${x} ${side * 0.2} 0" rpy="0 0 0"/>
    </xacro:segment>
    <xacro:segment name="${name}_thigh" parent="${name}_hip" length="${length}">
      <origin xyz="0 0 -0.2" rpy="0 0 0"/>
    </xacro:segment>
    <xacro:if value="${side > 0}">
      <xacro:segment name="${name}_shin" parent="${name}_thigh" length="${length}">
        <origin xyz="0 0 ${-length}" rpy="0 0 0"/>
      </xacro:segment>
    </xacro:if>
  </xacro:macro>
  <link name="base_link"/>
CALLS
</robot>
"""


def make_tree_robot(links: int, branching: int = 8) -> str:
    """Return a URDF with a tree of links with boxes, connected by continuous joints."""
    parts = ['<?xml version="1.0"?>', '<robot name="tree">']
    for number in range(links):
        parts.append(
            f'<link name="link_{number}"><visual><geometry><box size="0.04 0.04 0.04"/></geometry></visual></link>'
        )
        if number:
            parent = (number - 1) // branching
            angle = number % branching
            parts.append(
                f'<joint name="joint_{number}" type="continuous"><parent link="link_{parent}"/>'
                f'<child link="link_{number}"/><origin xyz="{0.1 + 0.02 * angle:.2f} {0.05 * angle - 0.2:.2f} 0.08"/>'
                '<axis xyz="0 0 1"/></joint>'
            )
    parts.append("</robot>")
    return "\n".join(parts)


def write_robot_with_mesh(folder: Path, kind: str) -> Path:
    """Return the path of a robot of one link with a mass and a mesh of four triangles.

    `kind` is the format of the mesh, ``stl`` or ``dae``.
    """
    corners = ((0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.0, 0.1, 0.0), (0.0, 0.0, 0.1))
    faces = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))
    if kind == "stl":
        rows = (
            struct.pack("<12fH", *[0.0] * 3, *(part for index in face for part in corners[index]), 0) for face in faces
        )
        (folder / "part.stl").write_bytes(bytes(80) + struct.pack("<I", len(faces)) + b"".join(rows))
    else:
        points = " ".join(str(part) for corner in corners for part in corner)
        indices = " ".join(str(index) for face in faces for index in face)
        (folder / "part.dae").write_text(_COLLADA.format(points=points, indices=indices), encoding="utf-8")
    robot = folder / f"robot_{kind}.urdf"
    robot.write_text(_ONE_LINK.replace("KIND", kind), encoding="utf-8")
    return robot


_ONE_LINK = """<robot name="part">
  <link name="base_link">
    <inertial>
      <origin xyz="0.025 0.025 0.025"/>
      <mass value="0.1"/>
      <inertia ixx="0.0001" ixy="0.00001" ixz="0" iyy="0.0001" iyz="0" izz="0.0001"/>
    </inertial>
    <visual><geometry><mesh filename="part.KIND"/></geometry></visual>
    <collision><geometry><mesh filename="part.KIND"/></geometry></collision>
  </link>
</robot>
"""
_COLLADA = """<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit meter="1"/></asset>
  <library_geometries><geometry id="part"><mesh>
    <source id="points"><float_array id="numbers" count="12">{points}</float_array>
      <technique_common><accessor source="#numbers" count="4" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
      </accessor></technique_common></source>
    <vertices id="corners"><input semantic="POSITION" source="#points"/></vertices>
    <triangles count="4"><input semantic="VERTEX" source="#corners" offset="0"/><p>{places}</p></triangles>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="scene"><node><instance_geometry url="#part"/></node></visual_scene>
  </library_visual_scenes>
  <scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>
"""


def make_detailed_robot(links: int, moving: int) -> str:
    """Return a robot of links and moving joints.

    Each link has inertia, two shapes and its own numbers.
    """
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
        <mesh filename="meshes/visual_{index}.dae"/>
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


SWEEP_LAUNCH = """
from launch import LaunchDescription
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

def generate_launch_description():
    description = open({model!r}).read()
    return LaunchDescription([
        Node(package="robot_state_publisher", executable="robot_state_publisher",
             parameters=[{{"robot_description": ParameterValue(description, value_type=str),
                          "publish_frequency": 100.0}}]),
        Node(package="joint_state_publisher", executable="joint_state_publisher",
             parameters=[{{"rate": {rate}, "delta": 0.01}}]),
        Node(package="rviz2", executable="rviz2", arguments=["-d", {rviz!r}]),
    ])
"""
"""A launch file in which every joint moves at a rate."""

TREE_RVIZ = """
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/RobotModel
      Description Topic: {Value: /robot_description}
      Enabled: true
      Name: RobotModel
      Value: true
    - Class: rviz_default_plugins/TF
      Enabled: true
      Name: TF
      Value: true
  Global Options: {Fixed Frame: link_0, Frame Rate: 30}
"""


ARM_VIEW = """\
  Views:
    Current: {Class: rviz_default_plugins/Orbit, Distance: 2.2, Pitch: 0.4, Yaw: 0.8, Focal Point: {X: 0, Y: 0, Z: 0.5}}
"""
ARM_LENGTHS = (0.1, 0.15, 0.45, 0.4, 0.15, 0.12, 0.08)
ARM_TRIANGLES = (5_000, 17_000, 30_000, 13_000, 14_000, 14_000, 3_000)
"""The triangles of each link, similar to meshes published by makers of arms: 96,000 in total."""


def write_sweep(folder: Path, links: int, rate: int) -> Path:
    """Write a tree robot, its .rviz file and a launch file that sweeps all joints.

    Returns the launch file.
    """
    return _write_sweep(folder, make_tree_robot(links), TREE_RVIZ, rate)


def write_arm_sweep(folder: Path, rate: int) -> Path:
    """Write the same as `write_sweep` for an arm of seven links with meshes."""
    parts = ['<?xml version="1.0"?>', '<robot name="arm">']
    for number, (length, triangles) in enumerate(zip(ARM_LENGTHS, ARM_TRIANGLES, strict=True)):
        mesh = folder / f"link_{number}.stl"
        mesh.write_bytes(_make_ribbed_tube(0.07 - 0.006 * number, length, triangles))
        parts.append(
            f'<link name="link_{number}"><visual><geometry><mesh filename="file://{mesh}"/></geometry>'
            f'<material name="m{number}"><color rgba="0.{3 + number} 0.6 0.8 1"/></material></visual></link>'
        )
        if number:
            parts.append(
                f'<joint name="joint_{number}" type="continuous"><parent link="link_{number - 1}"/>'
                f'<child link="link_{number}"/><origin xyz="0 0 {ARM_LENGTHS[number - 1]}"/>'
                f'<axis xyz="{number % 2} 0 {1 - number % 2}"/></joint>'
            )
    parts.append("</robot>")
    rviz = TREE_RVIZ.replace("  Global Options", ARM_VIEW + "  Global Options")
    return _write_sweep(folder, "\n".join(parts), rviz, rate)


def _make_ribbed_tube(radius: float, length: float, triangles: int) -> bytes:
    """Return a binary STL of a round tube with ribs along z, in m."""
    rings = round((triangles / 2) ** 0.5)
    corners = triangles // 2 // rings
    z = np.linspace(0, length, rings + 1)
    around = np.linspace(0, 2 * np.pi, corners + 1)
    wide = radius * (1 + 0.12 * np.sin(40 * z) ** 2)
    grid = np.stack(
        [np.outer(wide, np.cos(around)), np.outer(wide, np.sin(around)), np.repeat(z[:, None], corners + 1, axis=1)], -1
    )
    a, b, c, d = grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]
    faces = np.concatenate([np.stack([a, b, c], -2), np.stack([a, c, d], -2)]).reshape(-1, 3, 3)
    records = np.zeros(len(faces), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    records["corners"] = faces
    return bytes(80) + len(faces).to_bytes(4, "little") + records.tobytes()


def _write_sweep(folder: Path, urdf: str, config: str, rate: int) -> Path:
    model = folder / "model.urdf"
    model.write_text(urdf, encoding="utf-8")
    rviz = folder / "model.rviz"
    rviz.write_text(config, encoding="utf-8")
    launch = folder / "sweep.launch.py"
    launch.write_text(SWEEP_LAUNCH.format(model=str(model), rate=rate, rviz=str(rviz)), encoding="utf-8")
    return launch
