"""A robot as glTF: a node for each link, placed by its joint; the shapes below."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import numpy as np

from linkwright._version import __version__
from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, missing_extra, phrase
from linkwright.geometry.single import normalized
from linkwright.nodes.robot_transforms import JointMotion
from linkwright.viewer.features.export import primitives
from linkwright.viewer.features.export.files import FileSet
from linkwright.viewer.features.export.gltf import GltfFile
from linkwright.viewer.features.export.mesh_parts import UNCOLOURED, MeshPart, OwnLook, read_parts
from linkwright.viewer.features.export.snapshot import Snapshot
from linkwright.viewer.protocol.robot import LinkScene, Shape
from linkwright.viewer.web.files import FileRefusedError

_RVIZ_RED = (1.0, 0.0, 0.0)
_Y_UP = [-sqrt(0.5), 0.0, 0.0, sqrt(0.5)]
"""The rotation from our z up to glTF's y up."""


def glb_of(snapshot: Snapshot) -> bytes:
    """The visuals of a robot in its pose of the moment, as a .glb file.

    Colours are those that the page shows; glTF counts them linearly.

    Raises:
        LinkwrightError: VIEW204, a mesh cannot be read; VIEW205, a library for it is not installed.
    """
    return _RobotWriter(snapshot).write()


@dataclass(frozen=True, slots=True)
class _Look:
    color: tuple[float, float, float]
    alpha: float
    image: bytes | None
    double_sided: bool
    by_vertex: bool


class _RobotWriter:
    def __init__(self, snapshot: Snapshot) -> None:
        self._snapshot = snapshot
        self._files = FileSet(snapshot.meshes)
        self._gltf = GltfFile(f"Linkwright {__version__}")
        self._parts: dict[str, list[MeshPart]] = {}
        self._geometries: dict[tuple[Any, ...], dict[str, Any]] = {}
        self._materials: dict[_Look, int] = {}
        self._meshes: dict[tuple[Any, ...], int] = {}
        self._textures: dict[bytes, int] = {}

    def write(self) -> bytes:
        robot, scene = self._snapshot.robot, self._snapshot.scene
        poses = self._joint_poses()
        nodes = {link.name: self._link(link) for link in scene.links}
        for joint in robot.joints.values():
            x, y, z, *quaternion = poses[joint.name]
            child = self._gltf.entry("nodes", nodes[joint.child])
            child.update(translation=[x, y, z], rotation=list(normalized(*quaternion)))
            child["extras"] = {"joint": joint.name, "type": joint.type, "axis": list(joint.axis)}
            self._gltf.entry("nodes", nodes[joint.parent]).setdefault("children", []).append(nodes[joint.child])
        top = self._gltf.add("nodes", name=robot.name, rotation=_Y_UP, children=[nodes[robot.root]])
        return self._gltf.binary([top])

    def _joint_poses(self) -> Mapping[str, list[float]]:
        joints = list(self._snapshot.robot.joints.values())
        positions = np.array([self._snapshot.positions.get(joint.name, 0.0) for joint in joints])
        poses = JointMotion(joints).poses(positions)
        return {joint.name: pose.tolist() for joint, pose in zip(joints, poses, strict=True)}

    def _link(self, link: LinkScene) -> int:
        shapes = [self._shape(link, index, shape) for index, shape in enumerate(link.visuals)]
        return self._gltf.add("nodes", name=link.name, children=shapes or None)

    def _shape(self, link: LinkScene, index: int, shape: Shape) -> int:
        return self._gltf.add(
            "nodes",
            name=shape.name or f"{link.name} visual {index}",
            mesh=self._mesh(link, shape),
            translation=shape.position,
            rotation=list(normalized(*shape.quaternion)),
            scale=shape.size if shape.kind == "mesh" and shape.size != [1.0, 1.0, 1.0] else None,
        )

    # --- geometry ----------------------------------------------------------------------------------------------

    def _mesh(self, link: LinkScene, shape: Shape) -> int:
        source = (shape.url,) if shape.kind == "mesh" else (shape.kind, *shape.size)
        drawn = []
        for number, part in enumerate(self._parts_of(link, shape)):
            look = _look(shape, part, self._texture(shape))
            drawn.append({**self._geometry((*source, number), part), "material": self._material(look)})
        key = (*source, *(primitive["material"] for primitive in drawn))
        if key not in self._meshes:
            self._meshes[key] = self._gltf.add("meshes", name=_mesh_name(shape), primitives=drawn)
        return self._meshes[key]

    def _parts_of(self, link: LinkScene, shape: Shape) -> list[MeshPart]:
        if shape.kind == "box":
            return [MeshPart(primitives.box(shape.size), None)]
        if shape.kind == "cylinder":
            return [MeshPart(primitives.cylinder(*shape.size), None)]
        if shape.kind == "capsule":
            return [MeshPart(primitives.capsule(*shape.size), None)]
        if shape.kind == "sphere":
            return [MeshPart(primitives.sphere(*shape.size), None)]
        assert shape.url is not None
        if shape.url not in self._parts:
            self._parts[shape.url] = self._read(link, shape.url)
        return self._parts[shape.url]

    def _read(self, link: LinkScene, url: str) -> list[MeshPart]:
        try:
            path = self._files.path(url)
        except FileRefusedError:
            raise _unreadable(link, urlsplit(url).path, phrase("it is not there, or may not be read")) from None
        try:
            return read_parts(path, resolver=_Neighbours(self._files, url))
        except ValueError as error:
            raise _unreadable(link, display_path(path), str(error)) from None

    def _geometry(self, key: tuple[Any, ...], part: MeshPart) -> dict[str, Any]:
        if key not in self._geometries:
            triangles = part.triangles
            attributes = {"POSITION": self._gltf.vertices(triangles.positions, bounded=True)}
            if triangles.normals is not None:
                attributes["NORMAL"] = self._gltf.vertices(triangles.normals)
            if triangles.coordinates is not None:
                attributes["TEXCOORD_0"] = self._gltf.vertices(triangles.coordinates)
            if triangles.colors is not None:
                attributes["COLOR_0"] = self._gltf.vertices(_linear(triangles.colors))
            indices = self._gltf.indices(triangles.indices)
            self._geometries[key] = {"attributes": attributes, "indices": indices}
        return self._geometries[key]

    # --- materials ---------------------------------------------------------------------------------------------

    def _texture(self, shape: Shape) -> bytes | None:
        """The URDF's texture, as a file that glTF takes."""
        if shape.texture is None:
            return None
        try:
            return _as_png(self._files.path(shape.texture))
        except (FileRefusedError, OSError, ValueError):
            return None  # the page too draws the shape without it

    def _material(self, look: _Look) -> int:
        if look not in self._materials:
            red, green, blue, _ = _linear(np.array([[*look.color, 1.0]]))[0].tolist()
            surface: dict[str, Any] = {
                "baseColorFactor": [red, green, blue, look.alpha],
                "metallicFactor": 0.0,
                "roughnessFactor": 0.9,
            }
            if look.image is not None:
                if look.image not in self._textures:
                    kind = "image/jpeg" if look.image.startswith(b"\xff\xd8") else "image/png"
                    self._textures[look.image] = self._gltf.texture(look.image, kind)
                surface["baseColorTexture"] = {"index": self._textures[look.image]}
            self._materials[look] = self._gltf.add(
                "materials",
                pbrMetallicRoughness=surface,
                alphaMode="BLEND" if look.alpha < 1.0 else None,
                doubleSided=look.double_sided or None,
            )
        return self._materials[look]


class _Neighbours:
    """Gives trimesh the files beside a mesh, under the rules by which pages are served."""

    def __init__(self, files: FileSet, url: str) -> None:
        self._files = files
        self._folder = urlsplit(url).path.rpartition("/")[0]

    def get(self, name: str) -> bytes:
        """A file by its name in the mesh."""
        try:
            return self._files.path(f"{self._folder}/{name.strip().removeprefix('./')}").read_bytes()
        except FileRefusedError as error:
            raise OSError(str(error)) from None

    __getitem__ = get

    def keys(self) -> list[str]:
        """There is no list."""
        return []


def _look(shape: Shape, part: MeshPart, texture: bytes | None) -> _Look:
    """A part with a material of its own keeps it; any other takes the URDF's. How opaque it is says the URDF alone."""
    is_mesh = shape.kind == "mesh"
    alpha = shape.color[3] if shape.color else 1.0
    own = part.own
    if own is None:
        grey = is_mesh and not (shape.format or "").startswith("stl")
        bare = (UNCOLOURED,) * 3 if grey else _RVIZ_RED
        red, green, blue = (1.0, 1.0, 1.0) if texture else tuple(shape.color[:3]) if shape.color else bare
        own = OwnLook((red, green, blue), texture)
    image = own.image if part.triangles.coordinates is not None else None
    return _Look(own.color, float(alpha), image, is_mesh, part.triangles.colors is not None)


def _as_png(path: Path) -> bytes:
    """An image file as PNG or JPEG."""
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


def _linear(colors: Any) -> Any:
    """Colours as they are seen (sRGB) in glTF's linear numbers; alpha stays."""
    seen = np.asarray(colors, dtype=np.float64)
    linear = np.where(seen <= 0.04045, seen / 12.92, ((seen + 0.055) / 1.055) ** 2.4)
    linear[..., 3] = seen[..., 3]
    return linear


def _mesh_name(shape: Shape) -> str:
    return urlsplit(shape.url).path.rpartition("/")[2] if shape.url else shape.kind


def _unreadable(link: LinkScene, name: str, why: str) -> LinkwrightError:
    hint = phrase("export the mesh again, or leave it out")
    return LinkwrightError(
        Diagnostic(
            "VIEW204",
            phrase(
                "cannot read the mesh '{name}' of link '{link_name}': {why}",
                name=name,
                link_name=link.name,
                why=foreign(why),
            ),
            hint=hint,
        )
    )
