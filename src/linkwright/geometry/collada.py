"""Reading the triangles of usual COLLADA files: importing trimesh takes longer than reading most."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from xml.etree import ElementTree as ET

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array
from linkwright.geometry.plain import PlainMesh, Unusual, fans, numbers
from linkwright.geometry.polyhedron import Faces
from linkwright.lean_dataclasses import dataclass, field

_Node = ET.Element
_TRANSFORMS = ("matrix", "translate", "rotate", "scale")
_NO_FACES = ("source", "vertices", "lines", "extra")
_WITHOUT_TRIANGLES = ("instance_camera", "instance_light", "instance_controller", "extra", "asset")
_DECLARATION = re.compile(rb"<!(?!--)")
"""The beginning of a document type, which may hold entities, and of quoted text."""
_MOST_PLACES = 20_000
"""Nodes at their places, of which a few can make any number by naming each other."""


@dataclass(frozen=True, slots=True)
class _Source:
    """A ``<source>``: how many rows it has, and its numbers as text."""

    rows: int
    width: int
    text: str


@dataclass
class ColladaFile:
    """The meshes of a COLLADA file, in its own unit.

    Attributes:
        unit: metres for each unit.
        placed: each mesh with its frame in that of the file; shape (4, 4).
    """

    unit: float = 1.0
    placed: list[tuple[PlainMesh, Array]] = field(default_factory=list)


def read_collada(data: bytes) -> ColladaFile | None:
    """The meshes that the scene of a file places, with the rounding to 32 bits that pycollada does.

    None for a file with anything out of the ordinary, and for one with mistakes, which trimesh is to read.
    """
    if _DECLARATION.search(data):
        return None
    try:
        return _File(ET.fromstring(data)).read()  # noqa: S314 - there are no entities in it
    except (Unusual, ET.ParseError, ValueError, LookupError, RecursionError):
        return None


class _File:
    def __init__(self, root: _Node) -> None:
        name, brace, _ = root.tag.rpartition("}")
        if not brace:
            raise Unusual
        self._root = root
        self._space = name + brace
        self._geometries = self._by_id("library_geometries", "geometry")
        self._nodes = self._by_id("library_nodes", "node")
        self._meshes: dict[str, PlainMesh] = {}
        self._places = 0

    def read(self) -> ColladaFile:
        file = ColladaFile(self._unit())
        instance = self._only(self._only(self._root, "scene"), "instance_visual_scene")
        scene = self._by_id("library_visual_scenes", "visual_scene")[_reference(instance)]
        for node in self._all(scene, "node"):
            file.placed.extend(self._placed(node, np.eye(4)))
        if not file.placed:
            raise Unusual
        return file

    # --- the tree ---------------------------------------------------------------------------------------------

    def _all(self, node: _Node, tag: str) -> list[_Node]:
        return node.findall(self._space + tag)

    def _only(self, node: _Node, tag: str) -> _Node:
        found = self._all(node, tag)
        if len(found) != 1:
            raise Unusual
        return found[0]

    def _by_id(self, library: str, tag: str) -> dict[str, _Node]:
        found: dict[str, _Node] = {}
        for each in self._all(self._root, library):
            for node in self._all(each, tag):
                name = node.get("id", "")
                if not name or name in found:
                    raise Unusual
                found[name] = node
        return found

    def _tag(self, node: _Node) -> str:
        if not node.tag.startswith(self._space):
            raise Unusual
        return node.tag[len(self._space) :]

    def _unit(self) -> float:
        for asset in self._all(self._root, "asset")[:1]:
            for unit in self._all(asset, "unit")[:1]:
                metres = float(unit.get("meter", "1"))
                return 1.0 if math.isclose(metres, 1.0, rel_tol=1e-5) else metres
        return 1.0

    # --- the scene --------------------------------------------------------------------------------------------

    def _placed(self, node: _Node, above: Array) -> Iterator[tuple[PlainMesh, Array]]:
        """The meshes in a node, each with its frame in that of the file."""
        self._places += 1
        if self._places > _MOST_PLACES:
            raise Unusual
        matrix = above
        for part in node:
            if (tag := self._tag(part)) in _TRANSFORMS:
                matrix = matrix @ _transform(tag, numbers(part.text, np.float32).astype(np.float64))
        for part in node:
            tag = self._tag(part)
            if tag == "node":
                yield from self._placed(part, matrix)
            elif tag == "instance_node":
                yield from self._placed(self._nodes[_reference(part)], matrix)
            elif tag == "instance_geometry":
                mesh = self._mesh(_reference(part))
                if len(mesh.faces):
                    yield mesh, matrix
            elif tag not in _TRANSFORMS and tag not in _WITHOUT_TRIANGLES:
                raise Unusual

    # --- the meshes -------------------------------------------------------------------------------------------

    def _mesh(self, name: str) -> PlainMesh:
        if name not in self._meshes:
            self._meshes[name] = self._of_geometry(self._only(self._geometries[name], "mesh"))
        return self._meshes[name]

    def _of_geometry(self, mesh: _Node) -> PlainMesh:
        sources = {f"#{each.get('id', '')}": self._source(each) for each in self._all(mesh, "source")}
        vertices = self._only(mesh, "vertices")
        inputs = {each.get("semantic"): sources[each.get("source", "")] for each in self._all(vertices, "input")}
        corners = inputs["POSITION"]
        if corners.width != 3:
            raise Unusual
        name = f"#{vertices.get('id', '')}"
        rows = {name: corners.rows, **{source: each.rows for source, each in sources.items()}}
        parts = [part for part in mesh if self._tag(part) not in _NO_FACES]
        faces = [self._faces(part, self._tag(part), rows, name) for part in parts]
        points = numbers(corners.text, np.float32).reshape(-1, 3).astype(np.float64)
        return PlainMesh(points, np.concatenate([np.zeros((0, 3), dtype=np.int64), *faces]))

    def _source(self, source: _Node) -> _Source:
        numbers_of = self._only(source, "float_array")
        accessor = self._only(self._only(source, "technique_common"), "accessor")
        width = len(self._all(accessor, "param"))
        text = numbers_of.text or ""
        count = len(text.split())
        stride, offset = int(accessor.get("stride", "1")), int(accessor.get("offset", "0"))
        if stride != width or offset or count != int(numbers_of.get("count", "-1")) or count % width:
            raise Unusual
        return _Source(count // width, width, text)

    def _faces(self, part: _Node, tag: str, rows: dict[str, int], corners: str) -> Faces:
        """The triangles of ``<triangles>``, ``<polylist>`` or ``<polygons>``; a polygon makes a fan."""
        inputs = [
            (each.get("semantic"), each.get("source", ""), int(each.get("offset", "")))
            for each in self._all(part, "input")
        ]
        width = max(offset for _, _, offset in inputs) + 1
        texts = [numbers(each.text, np.int64).reshape(-1, width) for each in self._all(part, "p")]
        if tag == "triangles" and len(texts) == 1:
            counts: NDArray[np.int64] = np.full(len(texts[0]) // 3, 3, np.int64)
        elif tag == "polylist" and len(texts) == 1:
            counts = numbers(self._only(part, "vcount").text, np.int64)
        elif tag == "polygons" and texts and not self._all(part, "ph"):
            counts = np.array([len(each) for each in texts])
        else:
            raise Unusual
        indices = np.concatenate(texts)
        if counts.sum() != len(indices) or (len(counts) and counts.min() < 3):
            raise Unusual
        for _, source, offset in inputs:
            if len(indices) and not 0 <= indices[:, offset].min() <= indices[:, offset].max() < rows[source]:
                raise Unusual
        (column,) = [offset for semantic, source, offset in inputs if semantic == "VERTEX" and source == corners]
        return fans(indices[:, column], counts)


def _reference(node: _Node) -> str:
    """The id that a ``url`` in the same file names."""
    mark, _, name = node.get("url", "").partition("#")
    if mark or not name:
        raise Unusual
    return name


def _transform(tag: str, values: Array) -> Array:
    """The matrix of a transform; the axis of a rotation is taken as it is written, as pycollada does."""
    matrix = np.eye(4)
    if tag == "matrix":
        return values.reshape(4, 4)
    if tag == "rotate":
        x, y, z, degrees = values
        cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        axis = np.array([x, y, z])
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        matrix[:3, :3] = (1 - cosine) * np.outer(axis, axis) + cosine * np.eye(3) + sine * cross
        return matrix
    if len(values) != 3:
        raise Unusual
    if tag == "translate":
        matrix[:3, 3] = values
    else:
        matrix[[0, 1, 2], [0, 1, 2]] = values
    return matrix
