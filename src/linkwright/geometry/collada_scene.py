"""Read the scene of COLLADA files that have only common content.

This module reads the XML tree, which is faster than importing trimesh. Numbers are read into arrays (`collada`) or, for
small files, in plain Python (`collada_lists`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from xml.etree import ElementTree as ET

from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.loading.lean_typing import Any, Generic, Protocol, TypeVar

_Node = ET.Element
_TRANSFORM_TAGS = ("matrix", "translate", "rotate", "scale")
TAGS_WITHOUT_FACES = ("source", "vertices", "lines", "extra")
"""The children of a mesh that have no triangles."""
_TAGS_WITHOUT_TRIANGLES = ("instance_camera", "instance_light", "instance_controller", "extra", "asset")
_DECLARATION_PATTERN = lazy_pattern(rb"<!(?!--)")
"""The beginning of a document type, which may define entities, or of a CDATA section."""
_MAX_INSTANCES = 20_000
"""The maximum number of node instances, because a few nodes that refer to each other can create any number."""


Limits = list[tuple[int, int]]
"""Columns of indices, each with the exclusive upper bound of its indices."""
FacesT = TypeVar("FacesT")
MeshT = TypeVar("MeshT")
MeshT_co = TypeVar("MeshT_co", covariant=True)
MatrixT = TypeVar("MatrixT")


class UnsupportedContent(Exception):  # noqa: N818 - not an error: another reader reads the file
    """Raised when a file has content that a simple reader does not support."""


class MeshBuilder(Protocol[MeshT_co, MatrixT, FacesT]):
    """The interface that creates meshes and matrices from the text of elements.

    Each method raises `UnsupportedContent` or ValueError for text that it does not support.
    """

    def identity(self) -> MatrixT:
        """Return the identity matrix."""

    def apply_transform(self, matrix: MatrixT, tag: str, text: str | None) -> MatrixT:
        """Return the product of a matrix and the matrix of a transform element.

        The axis of a rotation is not normalized, as in pycollada.
        """

    def faces(self, tag: str, texts: list[str], corner_counts: str, width: int, column: int, limits: Limits) -> FacesT:
        """Return the triangles of a ``<triangles>``, ``<polylist>`` or ``<polygons>`` element.

        Polygons are split into fans.

        Args:
            tag: the tag of the element.
            texts: the texts with indices.
            corner_counts: the text with the number of corners of each polygon, for ``<polylist>``.
            width: the number of indices for each corner.
            column: the column of the indices of vertices.
            limits: the columns of indices to check, and the limit of each.
        """

    def mesh(self, text: str, faces: list[FacesT]) -> MeshT_co:
        """Return a mesh from the text of its vertices and the triangles of its elements."""


@dataclass(frozen=True, slots=True)
class _Source:
    """The number of rows, the row width and the text of a ``<source>``."""

    rows: int
    width: int
    text: str


class ColladaFile(Generic[MeshT, MatrixT]):
    """The meshes of a COLLADA file, in the file's unit.

    Attributes:
        unit: meters per unit.
        placed_meshes: each mesh with the matrix of its frame in the frame of the file; shape (4, 4).
        instances: the ``<instance_geometry>`` of each mesh.
        root: the root of the document.
    """

    def __init__(
        self, unit: float, placed_meshes: list[tuple[MeshT, MatrixT]], instances: list[ET.Element], root: ET.Element
    ) -> None:
        self.unit = unit
        self.placed_meshes = placed_meshes
        self.instances = instances
        self.root = root


def read_scene(data: bytes, builder: MeshBuilder[MeshT, MatrixT, Any]) -> ColladaFile[MeshT, MatrixT] | None:
    """Return the meshes in the scene of a file.

    Numbers are rounded to 32 bits, as in pycollada. Returns None for a file with unusual content or mistakes; only
    trimesh can read such a file.
    """
    if _DECLARATION_PATTERN.search(data):
        return None
    try:
        return _SceneReader(ET.fromstring(data), builder).read()  # noqa: S314 - the text contains no entities
    except (UnsupportedContent, ET.ParseError, ValueError, LookupError, RecursionError):
        return None


class _SceneReader(Generic[MeshT, MatrixT]):
    def __init__(self, root: _Node, builder: MeshBuilder[MeshT, MatrixT, Any]) -> None:
        name, brace, _ = root.tag.rpartition("}")
        if not brace:
            raise UnsupportedContent
        self._root = root
        self._builder = builder
        self._namespace = name + brace
        self._geometries = self._index_by_id("library_geometries", "geometry")
        self._nodes = self._index_by_id("library_nodes", "node")
        self._meshes: dict[str, tuple[MeshT, bool]] = {}
        self._instance_count = 0

    def read(self) -> ColladaFile[MeshT, MatrixT]:
        instance = self._find_only_child(self._find_only_child(self._root, "scene"), "instance_visual_scene")
        scene = self._index_by_id("library_visual_scenes", "visual_scene")[_read_reference(instance)]
        root = self._builder.identity()
        placed_meshes = [
            item for node in self._find_children(scene, "node") for item in self._find_placed_meshes(node, root)
        ]
        if not placed_meshes:
            raise UnsupportedContent
        instances = [instance for _, _, instance in placed_meshes]
        return ColladaFile(
            self._read_unit(), [(mesh, matrix) for mesh, matrix, _ in placed_meshes], instances, self._root
        )

    # --- tree -------------------------------------------------------------------------------------------------

    def _find_children(self, node: _Node, tag: str) -> list[_Node]:
        return node.findall(self._namespace + tag)

    def _find_only_child(self, node: _Node, tag: str) -> _Node:
        children = self._find_children(node, tag)
        if len(children) != 1:
            raise UnsupportedContent
        return children[0]

    def _index_by_id(self, library: str, tag: str) -> dict[str, _Node]:
        nodes: dict[str, _Node] = {}
        for element in self._find_children(self._root, library):
            for node in self._find_children(element, tag):
                name = node.get("id", "")
                if not name or name in nodes:
                    raise UnsupportedContent
                nodes[name] = node
        return nodes

    def _get_tag(self, node: _Node) -> str:
        if not node.tag.startswith(self._namespace):
            raise UnsupportedContent
        return node.tag[len(self._namespace) :]

    def _read_unit(self) -> float:
        for asset in self._find_children(self._root, "asset")[:1]:
            for unit in self._find_children(asset, "unit")[:1]:
                meters = float(unit.get("meter", "1"))
                return 1.0 if math.isclose(meters, 1.0, rel_tol=1e-5) else meters
        return 1.0

    # --- scene ------------------------------------------------------------------------------------------------

    def _find_placed_meshes(self, node: _Node, parent_matrix: MatrixT) -> Iterator[tuple[MeshT, MatrixT, _Node]]:
        """Yield the meshes in a node, with their poses as matrices in the file's frame, and their instances."""
        self._instance_count += 1
        if self._instance_count > _MAX_INSTANCES:
            raise UnsupportedContent
        matrix = parent_matrix
        for child in node:
            if (tag := self._get_tag(child)) in _TRANSFORM_TAGS:
                matrix = self._builder.apply_transform(matrix, tag, child.text)
        for child in node:
            tag = self._get_tag(child)
            if tag == "node":
                yield from self._find_placed_meshes(child, matrix)
            elif tag == "instance_node":
                yield from self._find_placed_meshes(self._nodes[_read_reference(child)], matrix)
            elif tag == "instance_geometry":
                mesh, has_faces = self._get_mesh(_read_reference(child))
                if has_faces:
                    yield mesh, matrix, child
            elif tag not in _TRANSFORM_TAGS and tag not in _TAGS_WITHOUT_TRIANGLES:
                raise UnsupportedContent

    # --- meshes -----------------------------------------------------------------------------------------------

    def _get_mesh(self, name: str) -> tuple[MeshT, bool]:
        if name not in self._meshes:
            self._meshes[name] = self._read_mesh(self._find_only_child(self._geometries[name], "mesh"))
        return self._meshes[name]

    def _read_mesh(self, mesh: _Node) -> tuple[MeshT, bool]:
        """Return the mesh of a ``<mesh>`` element, and whether it has triangles."""
        sources = {
            f"#{element.get('id', '')}": self._read_source(element) for element in self._find_children(mesh, "source")
        }
        vertices = self._find_only_child(mesh, "vertices")
        inputs = {
            element.get("semantic"): sources[element.get("source", "")]
            for element in self._find_children(vertices, "input")
        }
        positions = inputs["POSITION"]
        if positions.width != 3:
            raise UnsupportedContent
        vertices_id = f"#{vertices.get('id', '')}"
        rows = {vertices_id: positions.rows, **{source: source_data.rows for source, source_data in sources.items()}}
        primitives = [part for part in mesh if self._get_tag(part) not in TAGS_WITHOUT_FACES]
        faces = [self._read_faces(part, self._get_tag(part), rows, vertices_id) for part in primitives]
        return self._builder.mesh(positions.text, faces), any(len(face) for face in faces)

    def _read_source(self, source: _Node) -> _Source:
        float_array = self._find_only_child(source, "float_array")
        accessor = self._find_only_child(self._find_only_child(source, "technique_common"), "accessor")
        width = len(self._find_children(accessor, "param"))
        text = float_array.text or ""
        count = len(text.split())
        stride, offset = int(accessor.get("stride", "1")), int(accessor.get("offset", "0"))
        if stride != width or offset or count != int(float_array.get("count", "-1")) or count % width:
            raise UnsupportedContent
        return _Source(count // width, width, text)

    def _read_faces(self, primitive: _Node, tag: str, rows: dict[str, int], vertices_id: str) -> Any:
        """Return the triangles of a ``<triangles>``, ``<polylist>`` or ``<polygons>`` element."""
        inputs = [
            (element.get("semantic"), element.get("source", ""), int(element.get("offset", "")))
            for element in self._find_children(primitive, "input")
        ]
        width = max(offset for _, _, offset in inputs) + 1
        texts = [element.text or "" for element in self._find_children(primitive, "p")]
        is_polygons = tag == "polygons" and texts and not self._find_children(primitive, "ph")
        if not is_polygons and (tag not in ("triangles", "polylist") or len(texts) != 1):
            raise UnsupportedContent
        corner_counts = (self._find_only_child(primitive, "vcount").text or "") if tag == "polylist" else ""
        (column,) = [offset for semantic, source, offset in inputs if semantic == "VERTEX" and source == vertices_id]
        limits = [(offset, rows[source]) for _, source, offset in inputs]
        return self._builder.faces(tag, texts, corner_counts, width, column, limits)


def _read_reference(node: _Node) -> str:
    """Return the ID in a node's ``url`` that refers to an element of the same file."""
    mark, _, name = node.get("url", "").partition("#")
    if mark or not name:
        raise UnsupportedContent
    return name
