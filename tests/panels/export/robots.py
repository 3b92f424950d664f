"""Robots to export, and a reader of the exported files; for tests."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.descriptions import DescriptionLibrary
from linkwright.geometry.arrays import rotation_matrix
from linkwright.packages import PackageFinder
from linkwright.viewer.model_snapshot import take_model_snapshot

GRIPPER = """\
<robot name="gripper" version="1.2">
  <link name="base"><visual><geometry><box size="1 2 0.5"/></geometry>
    <material name="blue"><color rgba="0 0.5 1 0.75"/></material></visual></link>
  <link name="arm">
    <visual><origin xyz="0 0 0.5"/><geometry><cylinder radius="0.1" length="1"/></geometry></visual>
    <collision><geometry><sphere radius="0.5"/></geometry></collision>
  </link>
  <link name="left"><visual><geometry><sphere radius="0.1"/></geometry></visual></link>
  <link name="right"><visual><geometry><capsule radius="0.1" length="0.2"/></geometry></visual></link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
    <origin xyz="0 0 0.25" rpy="0 0 1.5707963267948966"/><axis xyz="0 2 0"/>
    <limit lower="-1" upper="1.5" effort="1" velocity="1"/></joint>
  <joint name="open" type="prismatic"><parent link="arm"/><child link="left"/>
    <origin xyz="0 0.2 1"/><axis xyz="0 1 0"/><limit lower="0.1" upper="0.4" effort="1" velocity="1"/></joint>
  <joint name="open_too" type="prismatic"><parent link="arm"/><child link="right"/>
    <origin xyz="0 -0.2 1"/><axis xyz="0 1 0"/><limit lower="-0.8" upper="0" effort="1" velocity="1"/>
    <mimic joint="open" multiplier="-2" offset="0.05"/></joint>
</robot>
"""


def make_snapshot(text: str, packages: dict[str, Path] | None = None):
    library = DescriptionLibrary()
    robot = library.read(text).robot
    finder = PackageFinder(start=Path("/nonexistent"), environment={}, extra=packages or {})
    return take_model_snapshot(text, robot, library, finder)


@dataclass
class DrawnPrimitive:
    """A primitive of a glTF in the robot's frame, z up."""

    link: str
    bounds: tuple[list[float], list[float]]
    color: str
    opacity: float
    textured: bool


class GlbContents:
    """The contents of a .glb file."""

    def __init__(self, data: bytes) -> None:
        magic, version, length, size, kind = struct.unpack_from("<5I", data)
        assert (magic, version, length, kind) == (0x46546C67, 2, len(data), 0x4E4F534A)
        self.document: dict[str, Any] = json.loads(data[20 : 20 + size])
        self.binary = data[20 + size + 8 :]
        self.nodes = self.document["nodes"]
        self.drawn: list[DrawnPrimitive] = []
        self.links: dict[str, np.ndarray] = {}
        (self.root,) = self.document["scenes"][0]["nodes"]
        upright = np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
        self._visit(self.root, upright, "")

    def _visit(self, index: int, above: np.ndarray, link: str) -> None:
        node = self.nodes[index]
        local = np.eye(4)
        local[:3, :3] = rotation_matrix(np.array(node.get("rotation", (0, 0, 0, 1)), dtype=float))
        local[:3, :3] = local[:3, :3] @ np.diag(node.get("scale", (1, 1, 1)))
        local[:3, 3] = node.get("translation", (0, 0, 0))
        pose = above @ local
        if "mesh" in node:
            for primitive in self.document["meshes"][node["mesh"]]["primitives"]:
                self._draw(primitive, pose, link)
        else:
            link = node["name"]
            self.links[link] = pose
        for child in node.get("children", ()):
            self._visit(child, pose, link)

    def _draw(self, primitive: dict, pose: np.ndarray, link: str) -> None:
        points = self.array(primitive["attributes"]["POSITION"])
        accessor = self.document["accessors"][primitive["attributes"]["POSITION"]]
        np.testing.assert_allclose([accessor["min"], accessor["max"]], [points.min(0), points.max(0)], rtol=1e-6)
        assert self.array(primitive["indices"]).max() < len(points)
        placed = points @ pose[:3, :3].T + pose[:3, 3]
        surface = self.document["materials"][primitive["material"]]["pbrMetallicRoughness"]
        factor = np.array(surface["baseColorFactor"])
        linear = factor[:3]
        encoded = np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)
        self.drawn.append(
            DrawnPrimitive(
                link,
                (placed.min(0).tolist(), placed.max(0).tolist()),
                "#" + "".join(f"{round(part * 255):02x}" for part in encoded),
                float(factor[3]),
                "baseColorTexture" in surface,
            )
        )

    def array(self, index: int) -> np.ndarray:
        accessor = self.document["accessors"][index]
        view = self.document["bufferViews"][accessor["bufferView"]]
        kind = {5126: "<f4", 5123: "<u2", 5125: "<u4"}[accessor["componentType"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        values = np.frombuffer(self.binary, kind, accessor["count"] * width, view.get("byteOffset", 0))
        return values.reshape(-1, width) if width > 1 else values

    def image(self, index: int = 0) -> bytes:
        view = self.document["bufferViews"][self.document["images"][index]["bufferView"]]
        return self.binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
