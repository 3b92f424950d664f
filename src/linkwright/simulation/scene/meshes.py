"""Meshes, and shapes that are converted to meshes, as assets of MuJoCo."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, display_path, phrase
from linkwright.geometry.arrays import Array
from linkwright.geometry.decomposition import convex_pieces, is_collinear, thicken
from linkwright.geometry.mesh_files import BadMeshError, count_declared_triangles, create_file_resolver
from linkwright.geometry.mesh_parts import MeshPart, Triangles, read_parts, read_png
from linkwright.geometry.meshes import read_mesh, unreadable_mesh_error
from linkwright.geometry.polygon import triangulate
from linkwright.geometry.single import Transform, compose, rotation_from_z
from linkwright.images.heights import read_heights
from linkwright.sdf.links import Visual
from linkwright.sdf.resources import Missing, ResourceFinder
from linkwright.sdf.shapes import Cone, Heightmap, Mesh, Plane, Polyline, Shape
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.scene.convex_parts import split_into_hulls
from linkwright.simulation.scene.shapes import compute_cone_vertices, set_pose
from linkwright.simulation.scene.textured_shapes import create_textured_mesh
from linkwright.simulation.scene.textures import limit_texture_size
from linkwright.xmltree import Element

_MAX_PIECES = 300
"""The maximum number of convex pieces of a mesh. Each piece costs time in every step."""
_MAX_PATCHES = 1000
"""The maximum number of patches of caves, terrains and other static surfaces that have more flat faces than that."""
_MAX_TRIANGLES = 1_000_000
"""The maximum number of triangles. Larger meshes need gigabytes without improving contacts or images."""
_MAX_HULL_VERTICES = 64
"""The maximum number of vertices of a convex hull."""
_MIN_AREA = 1e-12
"""The total area in m2 up to which the triangles of a visual are left out, because MuJoCo rejects them."""


class MeshLibrary:
    """A library that reads each mesh of a world once, and reports each unusable mesh once.

    Args:
        finder: finds mesh files and images.

    Attributes:
        spec: the specification to which the meshes are added.
        diagnostics: findings on meshes and images that cannot be used.
        used: the mesh files requested since this attribute was last cleared, with their modification times in ns since
            the epoch.
    """

    def __init__(self, finder: ResourceFinder) -> None:
        self.spec: Any = None
        self.diagnostics: list[Diagnostic] = []
        self.used: dict[Path, int] = {}
        self._finder = finder
        self._files: dict[tuple[str, Path], Path | None] = {}
        self._assets: dict[Hashable, list[str]] = {}
        self._textures: dict[bytes, str] = {}  # texture names, by PNG image
        self._reported: set[str] = set()
        self._textured_meshes: set[str] = set()  # meshes of the specification that have texture coordinates

    def set_finder(self, finder: ResourceFinder) -> None:
        """Set the finder of mesh files, and search for missing files again."""
        self._finder = finder
        self._files = {key: path for key, path in self._files.items() if path is not None}

    def collisions(
        self, body: Any, shape: Shape, pose: Transform, element: Element | None, *, fixed: bool, rolls: bool = False
    ) -> list[Any]:
        """Add a collision to a body as convex pieces or a heightmap, and return the added geoms.

        The list is empty if the shape cannot be used.

        Args:
            body: the body of the specification.
            shape: a mesh, cone, polygon or heightmap.
            pose: the pose of the shape in the frame of the body.
            element: the element of the shape in the file; None if there is no file.
            fixed: whether the body never moves; on a movable body, a mesh is replaced by a few convex hulls that
                contain it.
            rolls: whether the body may be a wheel, whose mesh is replaced by a single hull, because the seams
                between several hulls would bump.
        """
        if isinstance(shape, Heightmap):
            return self._add_heightmap(body, shape, pose, element)
        key = ("collision", shape, _create_cache_key(self._find_shape_file(shape, element)), fixed, rolls)
        if key not in self._assets:
            self._assets[key] = [self._add_hull(corners) for corners in self._read_pieces(shape, element, fixed, rolls)]
        return [self._add_geom(body, pose, name) for name in self._assets[key]]

    def visuals(self, body: Any, shape: Shape, pose: Transform, element: Element | None) -> list[Any]:
        """Add a visual with the materials of its mesh file to a body, and return the added geoms.

        The arguments are the same as in `collisions`.
        """
        if isinstance(shape, Heightmap):
            return self._add_heightmap(body, shape, pose, element)
        path = self._find_shape_file(shape, element)
        key = ("visual", shape, _create_cache_key(path))
        if key not in self._assets:
            if isinstance(shape, Mesh):
                self._assets[key] = [] if path is None else list(self._add_visual_meshes(shape, path, element))
            else:
                self._assets[key] = [
                    self._add_hull(corners) for corners in self._read_pieces(shape, element, fixed=True, rolls=False)
                ]
        return [self._add_geom(body, pose, name) for name in self._assets[key]]

    def _add_geom(self, body: Any, pose: Transform, mesh: str) -> Any:
        geom = body.add_geom(type=load_mujoco().mjtGeom.mjGEOM_MESH, meshname=mesh)
        material = f"{mesh} look"
        if self.spec.material(material) is not None:
            geom.material = material
        set_pose(geom, pose)
        return geom

    def _read_pieces(self, shape: Shape, element: Element | None, fixed: bool, rolls: bool) -> list[Array]:
        """Return the vertices of each convex piece of a shape.

        The list is empty if the shape cannot be used.
        """
        if isinstance(shape, Cone):
            return [compute_cone_vertices(shape)] if min(shape.radius, shape.length) > 0 else []
        if isinstance(shape, Polyline):
            return list(_create_prisms(shape))
        if isinstance(shape, tuple):
            return [corners for polyline in shape for corners in _create_prisms(polyline)]
        path = self._find_shape_file(shape, element)
        if not isinstance(shape, Mesh) or path is None:
            return []
        try:
            _check_triangle_count(path, count_declared_triangles(path) or 0)
            if shape.submesh is not None:
                parts = [part.triangles for part in self._read_parts(shape, path)]
                vertices, faces = _join_triangles(parts)
            else:
                mesh = read_mesh(path)
                vertices, faces = mesh.vertices, mesh.faces
            _check_triangle_count(path, len(faces))
        except LinkwrightError as error:
            self._warn(error.diagnostics[0], element)
            return []
        vertices = vertices * np.asarray(shape.scale)
        if np.prod(shape.scale) < 0:
            faces = faces[:, ::-1]
        if fixed:
            pieces = convex_pieces(vertices, faces, _MAX_PIECES, _MAX_PATCHES)
        else:
            pieces = ([] if rolls else split_into_hulls(vertices, faces)) or [vertices[np.unique(faces)]]
        return [thicken(corners) for corners in pieces if not is_collinear(corners)]

    def _add_visual_meshes(self, shape: Mesh, path: Path, element: Element | None) -> Iterator[str]:
        try:
            parts = self._read_parts(shape, path)
        except LinkwrightError as error:
            self._warn(error.diagnostics[0], element)
            return
        for part in parts:
            triangles = part.triangles
            faces: NDArray[np.int64] = triangles.indices.reshape(-1, 3)
            positions = triangles.positions * np.asarray(shape.scale)
            if _compute_area(positions, faces) <= _MIN_AREA:
                continue
            faces = faces[:, ::-1] if np.prod(shape.scale) < 0 else faces
            name = self._add_visual_mesh(positions, faces, triangles.coordinates)
            self._add_material(name, part)
            yield name

    def _add_visual_mesh(self, positions: Array, faces: Any, coordinates: Array | None) -> str:
        """Add a mesh asset for a visual to the specification, and return the name of the asset."""
        name = f"mesh {len(self.spec.meshes)}"
        mesh = self.spec.add_mesh(name=name, inertia=load_mujoco().mjtMeshInertia.mjMESH_INERTIA_SHELL)
        mesh.uservert = _to_flat_list(_pad_to_four(positions))
        mesh.userface = _to_flat_list(faces, np.int32)
        if coordinates is not None:
            mesh.usertexcoord = _to_flat_list(_pad_to_four(coordinates))
            self._textured_meshes.add(name)
        return name

    def add_textured_shape(self, body: Any, visual: Visual, pose: Transform) -> list[Any]:
        """Add a textured simple shape to a body as a mesh, and return the added geoms.

        The list is empty if the visual has no texture, or its shape cannot be textured.
        """
        shape = visual.geometry
        triangles = create_textured_mesh(shape) if self.find_material(visual) else None
        if triangles is None:
            return []
        key = ("wrapped", shape)
        if key not in self._assets:
            faces = triangles.indices.reshape(-1, 3)
            self._assets[key] = [self._add_visual_mesh(triangles.positions, faces, triangles.coordinates)]
        if isinstance(shape, Plane):
            pose = compose(pose, (0.0, 0.0, 0.0, *rotation_from_z(shape.normal)))
        return [self._add_geom(body, pose, name) for name in self._assets[key]]

    def _add_material(self, mesh: str, part: MeshPart) -> None:
        if part.file_material is None:
            return
        material = self.spec.add_material(name=f"{mesh} look")
        material.rgba = [*part.file_material.color, 1.0]
        if part.file_material.image is not None and part.triangles.coordinates is not None:
            self._add_texture(material, part.file_material.image)

    def _add_texture(self, material: Any, image: bytes) -> None:
        """Add a PNG texture to a material of MuJoCo.

        Equal images share one texture, because each compilation of the specification decodes every texture.
        """
        mujoco = load_mujoco()
        image = limit_texture_size(image)
        if image not in self._textures:
            texture = self.spec.add_texture(name=material.name, type=mujoco.mjtTexture.mjTEXTURE_2D)
            texture.file = f"{material.name}.png"
            self.spec.assets = {**self.spec.assets, texture.file: image}
            self._textures[image] = texture.name
        material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = self._textures[image]

    def has_texture_coordinates(self, geom: Any) -> bool:
        """Return whether a geom is a mesh with texture coordinates."""
        return geom.meshname in self._textured_meshes

    def find_material(self, visual: Visual) -> str:
        """Return the name of a MuJoCo material with the texture of a visual.

        The name is empty if the visual has no texture.

        If there is no albedo map, the emissive map is used.
        """
        workflow = (
            visual.material and visual.material.pbr and (visual.material.pbr.metal or visual.material.pbr.specular)
        )
        if not workflow:
            return ""
        path = self._find_image(workflow.albedo_map or workflow.emissive_map, visual.element)
        if path is None:
            return ""
        is_emissive = not workflow.albedo_map
        key = ("image", path, get_modification_time_ns(path), is_emissive)
        if key not in self._assets:
            self._assets[key] = []
            image = read_png(path)
            if image is not None:
                material = self.spec.add_material(name=f"image {len(self.spec.materials)}", emission=float(is_emissive))
                self._add_texture(material, image)
                self._assets[key] = [material.name]
        return "".join(self._assets[key])

    def _find_image(self, uri: str, element: Element | None) -> Path | None:
        source = element.source if element is not None else None
        image_file = self._finder.file(uri, Path(source.name).parent if source is not None else Path()) if uri else None
        if isinstance(image_file, Missing):
            message = phrase("an image is left out: {reason}", reason=image_file.reason)
            self._report(Diagnostic("SIM112", message, severity=Severity.WARNING, hint=image_file.hint), element)
            return None
        return image_file

    def _read_parts(self, shape: Mesh, path: Path) -> list[MeshPart]:
        _check_triangle_count(path, count_declared_triangles(path) or 0)
        try:
            parts = read_parts(path, resolver=create_file_resolver(str(path)))
        except BadMeshError as error:
            raise unreadable_mesh_error(path, error.reason) from None
        _check_triangle_count(path, sum(len(part.triangles.indices) // 3 for part in parts))
        if shape.submesh is None:
            return parts
        submesh = shape.submesh
        selected = [part for part in parts if submesh.name in part.names]
        if submesh.center and selected:
            positions = np.concatenate([part.triangles.positions for part in selected])
            center = (positions.min(axis=0) + positions.max(axis=0)) / 2
            selected = [part.moved(-center) for part in selected]
        return selected

    def _add_hull(self, corners: Array) -> str:
        name = f"hull {len(self.spec.meshes)}"
        mesh = self.spec.add_mesh(name=name, maxhullvert=_MAX_HULL_VERTICES)
        mesh.uservert = _to_flat_list(corners)
        return name

    def _add_heightmap(self, body: Any, shape: Heightmap, pose: Transform, element: Element | None) -> list[Any]:
        path = self._find_shape_file(shape, element)
        if path is None:
            return []
        key = ("heights", shape, _create_cache_key(path))
        if key not in self._assets:
            try:
                heights = read_heights(path)
            except LinkwrightError as error:
                self._warn(error.diagnostics[0], element)
                self._assets[key] = []
                return []
            name = f"heights {len(self.spec.hfields)}"
            x, y, z = shape.size
            rows, columns = heights.values.shape
            span = float(np.ptp(heights.values))
            height_field = self.spec.add_hfield(name=name, nrow=rows, ncol=columns)
            height_field.size = [x / 2, y / 2, max(span * z, 1e-3), 1.0]
            height_field.userdata = _to_flat_list(heights.values)
            self._assets[key] = [name]
        for name in self._assets[key]:
            geom = body.add_geom(type=load_mujoco().mjtGeom.mjGEOM_HFIELD, hfieldname=name)
            px, py, pz = shape.position
            set_pose(geom, (pose[0] + px, pose[1] + py, pose[2] + pz, *pose[3:]))
            return [geom]
        return []

    def _find_shape_file(self, shape: Shape, element: Element | None) -> Path | None:
        """Return the file of a mesh or heightmap, and record its use.

        Returns None for other shapes and for a missing file, which is reported once.
        """
        path = self.file(shape.uri, element) if isinstance(shape, Mesh | Heightmap) else None
        if path is not None:
            self.used[path] = get_modification_time_ns(path)
        return path

    def file(self, uri: str, element: Element | None) -> Path | None:
        """Return the file to which a URI refers, or None if it is missing.

        A missing file is reported once.
        """
        if not uri:
            return None
        source = element.source if element is not None else None
        folder = Path(source.name).parent if source is not None else Path()
        key = (uri, folder)
        if key not in self._files:
            resolved = self._finder.file(uri, folder)
            if isinstance(resolved, Missing):
                self._warn(Diagnostic("SIM112", resolved.reason, hint=resolved.hint), element)
                self._files[key] = None
            else:
                self._files[key] = resolved
        return self._files[key]

    def _warn(self, finding: Diagnostic, element: Element | None) -> None:
        message = phrase("a shape is left out: {reason}", reason=finding.message)
        self._report(Diagnostic(finding.code, message, severity=Severity.WARNING, hint=finding.hint), element)

    def _report(self, finding: Diagnostic, element: Element | None) -> None:
        """Add a finding on an element, unless there is already a finding with the same message."""
        if finding.message in self._reported:
            return
        self._reported.add(finding.message)
        span = element.span() if element is not None else None
        source = element.source if element is not None else None
        self.diagnostics.append(finding.with_changes(span=span, source=source))


def _check_triangle_count(path: Path, count: int) -> None:
    """Raise an error if a mesh has too many triangles.

    Raises:
        LinkwrightError: SIM115, the mesh has more than `_MAX_TRIANGLES` triangles.
    """
    if count > _MAX_TRIANGLES:
        values = {"path": display_path(path), "count": count, "maximum": _MAX_TRIANGLES}
        message = phrase("mesh '{path}' has {count} triangles, but the maximum is {maximum}", **values)
        hint = phrase("simplify the mesh, or use a simple shape for the collision")
        raise LinkwrightError(Diagnostic("SIM115", message, hint=hint))


def _create_prisms(polyline: Polyline) -> Iterator[Array]:
    points = np.array(polyline.points, dtype=np.float64).reshape(-1, 2)
    for triangle in triangulate(polyline.points):
        base = points[list(triangle)]
        yield np.concatenate([np.insert(base, 2, height, axis=1) for height in (0.0, polyline.height)])


def _compute_area(positions: Array, faces: Any) -> float:
    """Return the total area of triangles in m2."""
    first, second, third = (positions[faces[:, corner]] for corner in range(3))
    with np.errstate(over="ignore", invalid="ignore"):
        return float(np.linalg.norm(np.cross(second - first, third - first), axis=1).sum() / 2)


def _pad_to_four(corners: Array) -> Array:
    """Return at least four vertices, as MuJoCo requires, by repeating the last one."""
    return np.concatenate([corners, np.repeat(corners[-1:], max(4 - len(corners), 0), axis=0)])


def _join_triangles(parts: Sequence[Triangles]) -> tuple[Array, Any]:
    counts = np.cumsum([0, *(len(part.positions) for part in parts)])
    vertices = np.concatenate([np.zeros((0, 3)), *(part.positions for part in parts)])
    faces = [part.indices.reshape(-1, 3) + count for part, count in zip(parts, counts, strict=False)]
    return vertices, np.concatenate([np.zeros((0, 3), dtype=np.int64), *faces])


def _to_flat_list(values: Any, kind: Any = np.float32) -> list[Any]:
    with np.errstate(over="ignore"):  # MuJoCo rejects and reports numbers that are too large.
        return list(np.asarray(values, dtype=kind).ravel().tolist())


def _create_cache_key(path: Path | None) -> tuple[Path | None, int]:
    """Return a cache key of a file.

    Saving the file changes the key.
    """
    return path, 0 if path is None else get_modification_time_ns(path)


def get_modification_time_ns(path: Path) -> int:
    """Return the modification time of a file in ns since the epoch, or 0 for a missing file."""
    try:
        return path.stat().st_mtime_ns
    except OSError:
        return 0
