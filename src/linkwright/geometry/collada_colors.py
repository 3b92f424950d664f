"""Read COLLADA files with the colors of their materials, without a library.

Files with textures or with unusual content are left to trimesh.
"""

from __future__ import annotations

from xml.etree import ElementTree as ET

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.collada import ArrayBuilder
from linkwright.geometry.collada_scene import TAGS_WITHOUT_FACES, UnsupportedContent, read_scene
from linkwright.geometry.plain import PlainMesh, parse_numbers
from linkwright.geometry.polyhedron import Faces
from linkwright.loading.lean_dataclasses import NamedTuple

_Color = tuple[float, float, float]
_WHITE: _Color = (1.0, 1.0, 1.0)


class ColoredMesh(NamedTuple):
    """Triangles with one material.

    Attributes:
        mesh: the triangles, in the file's unit.
        matrix: the transform from the mesh to the file, shape (4, 4).
        unit: meters per unit.
        color: the diffuse color of the material, or None if the triangles have no material.
    """

    mesh: PlainMesh
    matrix: Array
    unit: float
    color: _Color | None


def read_colored_meshes(data: bytes) -> list[ColoredMesh] | None:
    """Return the meshes of a file with their colors.

    Returns None for a file with textures, unusual content or mistakes; only trimesh can read such a file.
    """
    file = read_scene(data, _MaterialArrayBuilder())
    if file is None:
        return None
    materials = _Materials(file.root)
    meshes = []
    try:
        for (parts, matrix), instance in zip(file.placed_meshes, file.instances, strict=True):
            colors = materials.find_colors(instance)
            meshes += [
                ColoredMesh(part, matrix, file.unit, color)
                for part, color in zip(parts, colors, strict=True)
                if len(part.faces)
            ]
    except (UnsupportedContent, ValueError, LookupError):
        return None
    return meshes


class _MaterialArrayBuilder:
    """The implementation of `MeshBuilder` that keeps the triangles of each element apart."""

    def __init__(self) -> None:
        self._arrays = ArrayBuilder()
        self.identity = self._arrays.identity
        self.apply_transform = self._arrays.apply_transform
        self.faces = self._arrays.faces

    def mesh(self, text: str, faces: list[Faces]) -> list[PlainMesh]:
        """Return a mesh for the triangles of each element."""
        points = parse_numbers(text, np.float32).reshape(-1, 3).astype(np.float64)
        return [PlainMesh(points, element_faces) for element_faces in faces]


class _Materials:
    """The materials of a file.

    Args:
        root: the root of the document.
    """

    def __init__(self, root: ET.Element) -> None:
        self._namespace = root.tag.rpartition("}")[0] + "}"
        self._geometries = self._index_by_id(root, "library_geometries", "geometry")
        self._materials = self._index_by_id(root, "library_materials", "material")
        self._effects = self._index_by_id(root, "library_effects", "effect")

    def find_colors(self, instance: ET.Element) -> list[_Color | None]:
        """Return the color of each element with triangles in an instance of a geometry."""
        material_by_symbol = {
            material.get("symbol", ""): material.get("target", "").removeprefix("#")
            for material in instance.iter(f"{self._namespace}instance_material")
        }
        mesh = self._single_child(self._geometries[instance.get("url", "").removeprefix("#")], "mesh")
        symbols = [
            part.get("material") for part in mesh if part.tag.removeprefix(self._namespace) not in TAGS_WITHOUT_FACES
        ]
        return [
            None if symbol is None or symbol not in material_by_symbol else self._read_color(material_by_symbol[symbol])
            for symbol in symbols
        ]

    def _read_color(self, name: str) -> _Color:
        effect = self._effects[
            self._single_child(self._materials[name], "instance_effect").get("url", "").removeprefix("#")
        ]
        technique = self._single_child(self._single_child(effect, "profile_COMMON"), "technique")
        shading = [child for child in technique if child.find(f"{self._namespace}diffuse") is not None]
        if not shading:
            return _WHITE
        numbers = parse_numbers(
            self._single_child(self._single_child(shading[0], "diffuse"), "color").text, np.float64
        ).tolist()
        if len(numbers) not in (3, 4):
            raise UnsupportedContent
        red, green, blue = (min(1.0, max(0.0, number)) for number in numbers[:3])
        return red, green, blue

    def _single_child(self, node: ET.Element, tag: str) -> ET.Element:
        children = node.findall(self._namespace + tag)
        if len(children) != 1:
            raise UnsupportedContent
        return children[0]

    def _index_by_id(self, root: ET.Element, library: str, tag: str) -> dict[str, ET.Element]:
        libraries = root.findall(self._namespace + library)
        return {node.get("id", ""): node for element in libraries for node in element.findall(self._namespace + tag)}
