"""Writes a robot as a binary glTF 2.0 file: a document, arrays and images."""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import numpy as np
from numpy.typing import NDArray

from linkwright._version import __version__
from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, display_path, missing_extra, phrase
from linkwright.geometry.mesh_files import BadMeshError
from linkwright.geometry.mesh_parts import UNCOLORED, FileMaterial, MeshPart, read_parts
from linkwright.geometry.single import normalized
from linkwright.geometry.surfaces import box, capsule, cylinder, sphere
from linkwright.nodes.robot_state_publisher import JointMotion
from linkwright.page.files import FileRefusedError
from linkwright.page.protocol.robot import LinkScene, Shape
from linkwright.panels.export.snapshot import FileSet, Snapshot

_MAGIC, _VERSION = 0x46546C67, 2
_JSON, _BINARY = 0x4E4F534A, 0x004E4942
_FLOAT, _UNSIGNED_SHORT, _UNSIGNED_INT = 5126, 5123, 5125
_VERTICES, _INDICES = 34962, 34963
_ACCESSOR_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_REPEAT, _LINEAR, _LINEAR_MIPMAPS = 10497, 9729, 9987


class GltfFile:
    """A glTF file under construction, whose entries are identified by indices.

    Args:
        generator: the name of the program that creates the file.
    """

    def __init__(self, generator: str) -> None:
        self._lists: dict[str, list[dict[str, Any]]] = {}
        self._binary = bytearray()
        self._generator = generator

    def add(self, kind: str, **content: Any) -> int:
        """Add an entry to a list of the document, and return the entry's index.

        The list is for example ``nodes``, ``meshes`` or ``materials``. Values of None are omitted.
        """
        entries = self._lists.setdefault(kind, [])
        entries.append({name: value for name, value in content.items() if value is not None})
        return len(entries) - 1

    def get_entry(self, kind: str, index: int) -> dict[str, Any]:
        """Return an entry of a list. Changes to the returned dict change the document."""
        return self._lists[kind][index]

    def add_vertices(self, values: NDArray[Any], *, bounded: bool = False) -> int:
        """Add an array of shape (N, 2 to 4) as float32, and return its index.

        If `bounded` is true, the minimum and maximum of the array are added, as glTF requires for positions.
        """
        array = np.ascontiguousarray(values, dtype="<f4")
        bounds: dict[str, Any] = {}
        if bounded:
            bounds = {"min": array.min(axis=0).tolist(), "max": array.max(axis=0).tolist()}
        return self.add(
            "accessors",
            bufferView=self._add_view(array.tobytes(), _VERTICES),
            componentType=_FLOAT,
            count=len(array),
            type=_ACCESSOR_TYPES[array.shape[1]],
            **bounds,
        )

    def add_indices(self, values: NDArray[Any]) -> int:
        """Add the vertex indices of triangles, and return the index of the array."""
        is_short = values.size == 0 or int(values.max()) < 0xFFFF
        array = np.ascontiguousarray(values, dtype="<u2" if is_short else "<u4").reshape(-1)
        return self.add(
            "accessors",
            bufferView=self._add_view(array.tobytes(), _INDICES),
            componentType=_UNSIGNED_SHORT if is_short else _UNSIGNED_INT,
            count=array.size,
            type="SCALAR",
        )

    def add_texture(self, data: bytes, content_type: str) -> int:
        """Add a PNG or JPEG file as a repeating texture, and return the texture's index."""
        if not self._lists.get("samplers"):
            self.add("samplers", magFilter=_LINEAR, minFilter=_LINEAR_MIPMAPS, wrapS=_REPEAT, wrapT=_REPEAT)
        image = self.add("images", bufferView=self._add_view(data), mimeType=content_type)
        return self.add("textures", source=image, sampler=0)

    def to_binary(self, roots: list[int]) -> bytes:
        """Return the content of the .glb file with these root nodes in its scene."""
        document: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": self._generator},
            "scene": 0,
            "scenes": [{"nodes": roots}],
            **self._lists,
        }
        if self._binary:
            document["buffers"] = [{"byteLength": len(self._binary)}]
        text = json.dumps(document, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode()
        chunks = [_make_chunk(_JSON, text, b" ")]
        if self._binary:
            chunks.append(_make_chunk(_BINARY, bytes(self._binary), b"\0"))
        body = b"".join(chunks)
        return struct.pack("<III", _MAGIC, _VERSION, 12 + len(body)) + body

    def _add_view(self, data: bytes, target: int | None = None) -> int:
        self._binary += b"\0" * (-len(self._binary) % 4)
        index = self.add("bufferViews", buffer=0, byteOffset=len(self._binary), byteLength=len(data), target=target)
        self._binary += data
        return index


def _make_chunk(kind: int, data: bytes, padding: bytes) -> bytes:
    data += padding * (-len(data) % 4)
    return struct.pack("<II", len(data), kind) + data


_DEFAULT_COLOR = (1.0, 0.0, 0.0)
_Y_UP = [-sqrt(0.5), 0.0, 0.0, sqrt(0.5)]
"""The rotation from z up, as in ROS, to y up, as in glTF: x, y, z, w."""


def write_glb(snapshot: Snapshot) -> bytes:
    """Return the visuals of a robot in its current pose, as a .glb file.

    The colors of the page are converted to the linear values of glTF.

    Raises:
        LinkwrightError: VIEW204, a mesh cannot be read; INR104 or VIEW205, a library for it is not installed.
    """
    return _RobotWriter(snapshot).write()


@dataclass(frozen=True, slots=True)
class _Appearance:
    color: tuple[float, float, float]
    alpha: float
    image: bytes | None
    double_sided: bool
    has_vertex_colors: bool


class _RobotWriter:
    def __init__(self, snapshot: Snapshot) -> None:
        self._snapshot = snapshot
        self._files = FileSet(snapshot.meshes)
        self._gltf = GltfFile(f"Linkwright {__version__}")
        self._lists: dict[str, list[MeshPart]] = {}
        self._geometries: dict[tuple[Any, ...], dict[str, Any]] = {}
        self._materials: dict[_Appearance, int] = {}
        self._meshes: dict[tuple[Any, ...], int] = {}
        self._textures: dict[bytes, int] = {}

    def write(self) -> bytes:
        robot, scene = self._snapshot.robot, self._snapshot.scene
        poses = self._compute_joint_poses()
        nodes = {link.name: self._add_link(link) for link in scene.links}
        for joint in robot.joints.values():
            x, y, z, *quaternion = poses[joint.name]
            child = self._gltf.get_entry("nodes", nodes[joint.child])
            child.update(translation=[x, y, z], rotation=list(normalized(*quaternion)))
            child["extras"] = {"joint": joint.name, "type": joint.type, "axis": list(joint.axis)}
            self._gltf.get_entry("nodes", nodes[joint.parent]).setdefault("children", []).append(nodes[joint.child])
        root_node = self._gltf.add("nodes", name=robot.name, rotation=_Y_UP, children=[nodes[robot.root]])
        return self._gltf.to_binary([root_node])

    def _compute_joint_poses(self) -> Mapping[str, list[float]]:
        joints = list(self._snapshot.robot.joints.values())
        positions = np.array([self._snapshot.positions.get(joint.name, 0.0) for joint in joints])
        poses = JointMotion(joints).poses(positions)
        return {joint.name: pose.tolist() for joint, pose in zip(joints, poses, strict=True)}

    def _add_link(self, link: LinkScene) -> int:
        shapes = [self._add_shape(link, index, shape) for index, shape in enumerate(link.visuals)]
        return self._gltf.add("nodes", name=link.name, children=shapes or None)

    def _add_shape(self, link: LinkScene, index: int, shape: Shape) -> int:
        return self._gltf.add(
            "nodes",
            name=shape.name or f"{link.name} visual {index}",
            mesh=self._add_mesh(link, shape),
            translation=shape.position,
            rotation=list(normalized(*shape.quaternion)),
            scale=shape.size if shape.kind == "mesh" and shape.size != [1.0, 1.0, 1.0] else None,
        )

    # --- geometry ----------------------------------------------------------------------------------------------

    def _add_mesh(self, link: LinkScene, shape: Shape) -> int:
        source = (shape.url,) if shape.kind == "mesh" else (shape.kind, *shape.size)
        primitives = []
        for index, part in enumerate(self._read_mesh_parts(link, shape)):
            appearance = _appearance(shape, part, self._read_texture(shape))
            primitives.append(
                {**self._add_geometry((*source, index), part), "material": self._add_material(appearance)}
            )
        key = (*source, *(primitive["material"] for primitive in primitives))
        if key not in self._meshes:
            self._meshes[key] = self._gltf.add("meshes", name=_get_mesh_name(shape), primitives=primitives)
        return self._meshes[key]

    def _read_mesh_parts(self, link: LinkScene, shape: Shape) -> list[MeshPart]:
        if shape.kind == "box":
            return [MeshPart(box(shape.size), None)]
        if shape.kind == "cylinder":
            return [MeshPart(cylinder(shape.size[0], shape.size[1]), None)]
        if shape.kind == "capsule":
            return [MeshPart(capsule(shape.size[0], shape.size[1]), None)]
        if shape.kind == "sphere":
            return [MeshPart(sphere(shape.size[0]), None)]
        assert shape.url is not None
        if shape.url not in self._lists:
            self._lists[shape.url] = self._read(link, shape.url)
        return self._lists[shape.url]

    def _read(self, link: LinkScene, url: str) -> list[MeshPart]:
        try:
            path = self._files.path(url)
        except FileRefusedError:
            raise _unreadable_mesh_error(
                link, urlsplit(url).path, phrase("it does not exist or cannot be read")
            ) from None
        try:
            return read_parts(path, resolver=_NeighborFiles(self._files, url))
        except BadMeshError as error:
            raise _unreadable_mesh_error(link, display_path(path), error.reason) from None

    def _add_geometry(self, key: tuple[Any, ...], part: MeshPart) -> dict[str, Any]:
        if key not in self._geometries:
            triangles = part.triangles
            attributes = {"POSITION": self._gltf.add_vertices(triangles.positions, bounded=True)}
            if triangles.normals is not None:
                attributes["NORMAL"] = self._gltf.add_vertices(triangles.normals)
            if triangles.coordinates is not None:
                attributes["TEXCOORD_0"] = self._gltf.add_vertices(triangles.coordinates)
            if triangles.colors is not None:
                attributes["COLOR_0"] = self._gltf.add_vertices(_to_linear_colors(triangles.colors))
            indices = self._gltf.add_indices(triangles.indices)
            self._geometries[key] = {"attributes": attributes, "indices": indices}
        return self._geometries[key]

    # --- materials ---------------------------------------------------------------------------------------------

    def _read_texture(self, shape: Shape) -> bytes | None:
        """Return the texture that the URDF sets, as PNG or JPEG.

        None means that there is no texture, or that it cannot be read.
        """
        if shape.texture is None:
            return None
        try:
            return _read_as_png(self._files.path(shape.texture))
        except (FileRefusedError, OSError, ValueError):
            return None  # The page also draws the shape without a texture.

    def _add_material(self, appearance: _Appearance) -> int:
        if appearance not in self._materials:
            red, green, blue, _ = _to_linear_colors(np.array([[*appearance.color, 1.0]]))[0].tolist()
            surface: dict[str, Any] = {
                "baseColorFactor": [red, green, blue, appearance.alpha],
                "metallicFactor": 0.0,
                "roughnessFactor": 0.9,
            }
            if appearance.image is not None:
                if appearance.image not in self._textures:
                    content_type = "image/jpeg" if appearance.image.startswith(b"\xff\xd8") else "image/png"
                    self._textures[appearance.image] = self._gltf.add_texture(appearance.image, content_type)
                surface["baseColorTexture"] = {"index": self._textures[appearance.image]}
            self._materials[appearance] = self._gltf.add(
                "materials",
                pbrMetallicRoughness=surface,
                alphaMode="BLEND" if appearance.alpha < 1.0 else None,
                doubleSided=appearance.double_sided or None,
            )
        return self._materials[appearance]


class _NeighborFiles:
    """The files next to a mesh, for trimesh, with the same restrictions as for pages."""

    def __init__(self, files: FileSet, url: str) -> None:
        self._files = files
        self._folder = urlsplit(url).path.rpartition("/")[0]

    def get(self, name: str) -> bytes:
        """Return the content of a file that the mesh refers to by a relative path."""
        try:
            return self._files.path(f"{self._folder}/{name.strip().removeprefix('./')}").read_bytes()
        except FileRefusedError as error:
            raise OSError(str(error)) from None

    __getitem__ = get

    def keys(self) -> list[str]:
        """Return an empty list, so that trimesh reads files only with `get`."""
        return []


def _appearance(shape: Shape, part: MeshPart, texture: bytes | None) -> _Appearance:
    """Return the appearance of a mesh part, from the mesh file or, if it has none, the URDF.

    The opacity is always taken from the URDF.
    """
    is_mesh = shape.kind == "mesh"
    alpha = shape.color[3] if shape.color else 1.0
    material = part.file_material
    if material is None:
        is_gray = is_mesh and not (shape.format or "").startswith("stl")
        default_color = (UNCOLORED,) * 3 if is_gray else _DEFAULT_COLOR
        red, green, blue = (1.0, 1.0, 1.0) if texture else tuple(shape.color[:3]) if shape.color else default_color
        material = FileMaterial((red, green, blue), texture)
    image = material.image if part.triangles.coordinates is not None else None
    return _Appearance(material.color, float(alpha), image, is_mesh, part.triangles.colors is not None)


def _read_as_png(path: Path) -> bytes:
    """Return the content of an image file, converted to PNG unless it is PNG or JPEG."""
    data = path.read_bytes()
    if data.startswith((b"\x89PNG", b"\xff\xd8\xff")):
        return data
    from io import BytesIO

    try:
        from PIL import Image
    except ModuleNotFoundError as error:
        raise missing_extra("VIEW205", error) from None
    file = BytesIO()
    Image.open(BytesIO(data)).convert("RGBA").save(file, "PNG")
    return file.getvalue()


def _to_linear_colors(colors: Any) -> Any:
    """Convert sRGB colors to the linear values of glTF, with unchanged alpha."""
    srgb = np.asarray(colors, dtype=np.float64)
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    linear[..., 3] = srgb[..., 3]
    return linear


def _get_mesh_name(shape: Shape) -> str:
    return urlsplit(shape.url).path.rpartition("/")[2] if shape.url else shape.kind


def _unreadable_mesh_error(link: LinkScene, name: str, reason: Phrase) -> LinkwrightError:
    hint = phrase("export the mesh again, or remove it from the robot")
    return LinkwrightError(
        Diagnostic(
            "VIEW204",
            phrase(
                "cannot read the mesh '{name}' of link '{link_name}': {reason}",
                name=name,
                link_name=link.name,
                reason=reason,
            ),
            hint=hint,
        )
    )
