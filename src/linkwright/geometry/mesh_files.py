"""Parse mesh files by trimesh, or by simpler readers where these suffice."""

from __future__ import annotations

import logging
import struct
import warnings
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import LinkwrightError, Phrase, foreign, phrase
from linkwright.geometry.arrays import Array
from linkwright.geometry.collada import read_collada
from linkwright.geometry.mesh_faults import find_fault
from linkwright.geometry.outlines import STL_HEADER_BYTES, STL_TRIANGLE_BYTES
from linkwright.geometry.stl import read_stl
from linkwright.geometry.wavefront import read_obj
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.loading.lean_typing import Any
from linkwright.xmltree import Comment, write_element
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.tinyxml import parse_as_tinyxml

MESH_SUFFIXES = (".stl", ".dae", ".obj", ".glb", ".gltf")
"""The extensions of the supported formats, which RViz and Gazebo also read."""
_FACE_LINES = {".stl": b"facet normal", ".obj": b"\nf "}
"""The beginning of the line that occurs once for each triangle, or polygon, in text files."""


class PlacedMesh(NamedTuple):
    """An instance of a mesh in a file.

    Attributes:
        mesh: a `trimesh.Trimesh` or a `PlainMesh` with triangles.
        matrix: the homogeneous matrix of the mesh's frame in the frame of the file, in the file's unit; shape (4, 4).
        unit: meters per unit of the file.
        names: the names of the mesh and of the instance in the file.
    """

    mesh: Any
    matrix: Array
    unit: float
    names: frozenset[str]

    @property
    def faces(self) -> NDArray[np.int64]:
        """The indices of the triangles' corners, shape (faces, 3).

        If the matrix mirrors the mesh, the order of corners is reversed, so that the outside stays outside.
        """
        faces = np.asarray(self.mesh.faces, dtype=np.int64)
        return faces[:, ::-1] if np.linalg.det(self.matrix[:3, :3]) < 0 else faces


class BadMeshError(Exception):
    """Raised when a mesh file cannot be used.

    The message gives the reason.

    Attributes:
        reason: the reason, a phrase in terms of the file.
    """

    def __init__(self, reason: Phrase) -> None:
        super().__init__(reason)
        self.reason = reason


def read_placed_meshes(data: bytes, kind: str, *, is_plain: bool = False, **options: Any) -> list[PlacedMesh]:
    """Return the triangle meshes of an STL, COLLADA, OBJ or glTF file.

    Lines and points are ignored.

    STL and OBJ have no unit, and URDF takes their numbers as meters. As in RViz, the unit of COLLADA is returned, and
    its up axis is not applied.

    Args:
        data: the content of the file.
        kind: the file extension, without the dot.
        is_plain: whether to read only triangles, without colors, normals and names. In this case, most files are read
            without trimesh, whose import takes longer.
        options: options of `trimesh.load_scene`.

    Raises:
        BadMeshError: the file cannot be read, has no triangles, or has malformed numbers.
        ModuleNotFoundError: a library for the format is not installed.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            meshes = (_read_plain(data, kind) if is_plain else None) or list(_read_meshes(data, kind, **options))
    except ModuleNotFoundError:
        raise
    except Exception as error:  # noqa: BLE001 - a parser may raise anything for unknown bytes
        repaired = _repair_xml(data) if kind == "dae" else None
        if repaired is not None:
            return read_placed_meshes(repaired, kind, is_plain=is_plain, **options)
        raise BadMeshError(find_fault(data, kind) or describe_parser_error(error)) from None
    if not meshes:
        raise BadMeshError(find_fault(data, kind) or phrase("it has no triangles"))
    for placed_mesh in meshes:
        vertices = placed_mesh.mesh.vertices
        if np.shape(vertices)[1] != 3 or not (np.isfinite(vertices).all() and np.isfinite(placed_mesh.matrix).all()):
            raise BadMeshError(find_fault(data, kind) or phrase("a coordinate is not a finite number"))
        corner, count = int(placed_mesh.mesh.faces.max()), len(vertices)
        if corner >= count:
            raise BadMeshError(
                phrase("a triangle refers to vertex {corner}, but there are {count}", corner=corner, count=count)
            )
    return meshes


def count_declared_triangles(path: Path) -> int | None:
    """Return a lower bound of the number of triangles in a file, without parsing the file.

    Parsing a large file takes a minute. Returns None if the number can only be determined by parsing (COLLADA, glTF),
    or if the file cannot be read.
    """
    kind = path.suffix.lower()
    try:
        with path.open("rb") as file:
            head = file.read(STL_HEADER_BYTES)
            if kind == ".stl" and len(head) == STL_HEADER_BYTES:
                (declared_count,) = struct.unpack_from("<I", head, STL_HEADER_BYTES - 4)
                if path.stat().st_size == STL_HEADER_BYTES + declared_count * STL_TRIANGLE_BYTES:
                    return int(declared_count)
            line_start = _FACE_LINES.get(kind)
            return None if line_start is None else (head + file.read()).count(line_start)
    except OSError:
        return None


def _read_plain(data: bytes, kind: str) -> list[PlacedMesh] | None:
    """Return the meshes of a simple STL, COLLADA or OBJ file, or None for other files."""
    no_names: frozenset[str] = frozenset()
    if kind == "dae":
        file = read_collada(data)
        return (
            None
            if file is None
            else [PlacedMesh(plain_mesh, matrix, file.unit, no_names) for plain_mesh, matrix in file.placed_meshes]
        )
    mesh = read_stl(data, is_plain=True) if kind == "stl" else read_obj(data) if kind == "obj" else None
    return None if mesh is None else [PlacedMesh(mesh, np.eye(4), 1.0, no_names)]


def _read_meshes(data: bytes, kind: str, **options: Any) -> Iterator[PlacedMesh]:
    if kind == "stl" and (stl := read_stl(data)) is not None:
        yield PlacedMesh(stl, np.eye(4), 1.0, frozenset((stl.name,)))
        return
    import trimesh  # The import takes 0.1 s, and checks of most robots need no mesh.

    logger = logging.getLogger("trimesh")
    if not logger.handlers:
        logger.addHandler(logging.NullHandler())  # trimesh's warnings are of no use to users.
    scene: Any = _load_collada_scene(data, **options) if kind == "dae" else _load_scene(data, kind, **options)
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        mesh = scene.geometry[name]
        if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces):
            unit = _get_collada_unit(mesh) if kind == "dae" else 1.0
            yield PlacedMesh(mesh, np.asarray(matrix, dtype=np.float64), unit, frozenset((name, node)))
    scene.__dict__.clear()  # This breaks the reference cycle that keeps the file's bytes in memory.


def _load_scene(data: bytes, kind: str, **options: Any) -> Any:
    import trimesh

    return trimesh.load_scene(BytesIO(data), file_type=kind, process=False, **options)


def _load_collada_scene(data: bytes, **options: Any) -> Any:
    """Load the scene of a COLLADA file, ignoring materials that cannot be read and elements at unknown places.

    pycollada can skip broken materials, but also skips the geometry that uses them. The first attempt is therefore
    strict, and a file that it rejects is read again without the references to these materials. In the strict attempt,
    pycollada rejects an element that does not belong into a node, such as `bind_material` beside `instance_geometry`,
    by a bare `raise`, which fails with RuntimeError.
    """
    from collada.common import DaeError  # type: ignore[import-untyped]  # pycollada has no types

    try:
        return _load_scene(data, "dae", ignore_broken=False, **options)
    except (DaeError, RuntimeError):
        return _load_scene(_remove_broken_materials(data), "dae", ignore_broken=True, **options)


def _repair_xml(data: bytes) -> bytes | None:
    """Return a COLLADA file as well-formed XML, or None.

    Mistakes that Gazebo and RViz tolerate are removed. Returns None if the file has no such mistakes, or has other
    mistakes. Exporters write such files: assimp names the nodes of an STL ``<STL_BINARY>``.
    """
    try:
        document, tolerated_mistakes = parse_as_tinyxml(decode(data, "<mesh>"), "<mesh>", foreign(""))
    except LinkwrightError:
        return None
    if not tolerated_mistakes:
        return None
    for element in document.root.walk():
        element.children = [child for child in element.children if not isinstance(child, Comment)]
    return write_element(document.root).encode()


def _remove_broken_materials(data: bytes) -> bytes:
    """Return a COLLADA file without its references to missing or unreadable materials."""
    from collada import Collada  # type: ignore[import-untyped]  # pycollada has no types
    from collada.common import DaeError

    document = Collada(BytesIO(data), ignore=[DaeError])
    material_ids = {f"#{material.id}" for material in document.materials}
    for bindings in document.xmlnode.iter(document.tag("technique_common")):
        for material in bindings.findall(document.tag("instance_material")):
            if material.get("target") not in material_ids:
                bindings.remove(material)
    output = BytesIO()
    document.xmlnode.write(output)
    return output.getvalue()


def describe_parser_error(error: Exception) -> Phrase:
    """Return a description of a parser's error, for faults without a better description."""
    if isinstance(error, FileNotFoundError):
        return phrase("it refers to the file '{name}', which does not exist", name=str(error.filename or error))
    lines = str(error).strip().splitlines()
    return phrase("the parser reports: {error}", error=foreign(lines[0] if lines else type(error).__name__))


def create_file_resolver(path: str) -> Any:
    """Return an object with which trimesh reads the files next to a mesh file.

    Returns None for STL, which refers to no files.
    """
    if path.lower().endswith(".stl"):
        return None
    from trimesh.resolvers import FilePathResolver

    return FilePathResolver(path)


def _get_collada_unit(mesh: Any) -> float:
    """Return the meters per unit of a COLLADA file, from a mesh.

    trimesh stores the unit with the meshes, and does not apply it to the numbers.
    """
    fields = str(mesh.metadata.get("units", "meters")).split(" * ")
    return float(fields[0]) if len(fields) == 2 else 1.0
