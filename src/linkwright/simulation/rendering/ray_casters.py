"""Ray casting against all visible geoms, with Embree or with MuJoCo."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from linkwright.diagnostics import Phrase, phrase
from linkwright.geometry.arrays import Array
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.ray_casting import GROUP_COUNT
from linkwright.simulation.rendering.movable_geoms import CameraView, MovableGeoms, find_covered_pixels
from linkwright.simulation.rendering.triangles import Mesh, create_triangle_mesh, is_infinite_plane
from linkwright.simulation.scene.bodies import VISUAL_GROUP
from linkwright.simulation.simulation import Simulation


@dataclass(slots=True)
class Hits:
    """The first hits of rays.

    Attributes:
        distances: the distances in multiples of the ray's length, shape (n,), float32; inf for no hit.
        geoms: the indices of the geoms in MuJoCo's model, shape (n,), int32; -1 for no hit.
        normals: the unit normals of the surfaces, which may point to either side, shape (n, 3), float32; None if they
            were not requested.
    """

    distances: Any
    geoms: Any
    normals: Any


class Caster(Protocol):
    """The interface of ray casters for images."""

    method: Phrase

    def cast(self, view: CameraView, *, normals: bool) -> Hits:
        """Cast the rays of an image into the current world, from the camera's near clip plane.

        Args:
            view: the camera's view, with the rays of its pixels.
            normals: whether to return the normals of the surfaces.
        """


class MujocoCaster:
    """Exact but slow ray casting with MuJoCo."""

    method = phrase("slow ray casting with MuJoCo, because EGL, OSMesa and embreex are not available")

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._mujoco = load_mujoco()
        self._groups = np.zeros(GROUP_COUNT, dtype=np.uint8)
        self._groups[VISUAL_GROUP] = 1

    def cast(self, view: CameraView, *, normals: bool) -> Hits:
        """Cast the rays of an image with MuJoCo."""
        del normals  # MuJoCo always returns normals.
        origin, rays, near = view.origin, view.rays, view.optics.near
        simulation = self._simulation
        simulation.refresh()
        count = len(rays)
        rays = rays.astype(np.float64)
        lengths = np.linalg.norm(rays, axis=1)
        directions = (rays / lengths[:, None]).ravel()
        distances, geoms, flat_normals = np.empty(count), np.empty(count, dtype=np.int32), np.zeros(3 * count)
        self._mujoco.mj_multiRay(
            simulation.model, simulation.data, origin, directions, self._groups, 1, -1, geoms, distances, flat_normals,
            count, self._mujoco.mjMAXVAL,
        )  # fmt: skip
        surface_normals = flat_normals.reshape(-1, 3)
        for ray in np.nonzero((geoms >= 0) & (distances < near * lengths))[0]:
            geoms[ray], distances[ray], surface_normals[ray] = self._find_hit_beyond_near(
                origin, rays[ray], lengths[ray], near
            )
        relative_distances = np.where(geoms >= 0, distances / lengths, np.inf)
        return Hits(relative_distances.astype(np.float32), geoms, surface_normals.astype(np.float32))

    def _find_hit_beyond_near(self, origin: Array, ray: Array, length: float, start: float) -> tuple[int, float, Array]:
        """Return a ray's first hit beyond the near clip plane: geom, distance and normal.

        The geom is -1 if there is no hit. The distance is in m.
        """
        model, data, geom, normal = self._simulation.model, self._simulation.data, np.zeros(1, np.int32), np.zeros(3)
        near_point, direction = origin + start * ray, ray / length
        remaining_distance = self._mujoco.mj_ray(model, data, near_point, direction, self._groups, 1, -1, geom, normal)
        return int(geom[0]), start * length + remaining_distance, normal


class _TriangleTree:
    """The triangles of geoms at their current poses, in an Embree tree."""

    def __init__(self, meshes: dict[int, Mesh], data: Any) -> None:
        from embreex.mesh_construction import TriangleMesh  # type: ignore[import-not-found, import-untyped, unused-ignore]
        from embreex.rtcore_scene import EmbreeScene  # type: ignore[import-not-found, import-untyped, unused-ignore]

        self._triangle_geoms = np.repeat(list(meshes), [len(faces) for _, faces in meshes.values()]).astype(np.int32)
        starts = np.cumsum([0, *(len(corners) for corners, _ in meshes.values())])
        shifted_faces = [faces + start for (_, faces), start in zip(meshes.values(), starts, strict=False)]
        faces = np.concatenate(shifted_faces).astype(np.int32)
        world_corners = [
            corners @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]
            for geom, (corners, _) in meshes.items()
        ]
        corners = np.concatenate(world_corners).astype(np.float32)
        self._tree: Any = EmbreeScene()
        TriangleMesh(self._tree, corners, faces)
        first, second, third = (corners[faces[:, corner]] for corner in range(3))
        cross_products = np.cross(second - first, third - first)
        self._normals = cross_products / np.maximum(np.linalg.norm(cross_products, axis=1), 1e-20)[:, None].astype(
            np.float32
        )

    def cast_into(self, hits: Hits, origins: Any, rays: Any, start: float, ray_indices: Any = None) -> None:
        """Cast rays at the triangles, and replace the hits in `hits` that are farther away.

        Args:
            hits: the hits found so far, which are updated.
            origins: the origins of the rays in m, shape (n, 3).
            rays: the directions of the rays, shape (n, 3).
            start: the distance from the camera to the origins, in multiples of the ray's length.
            ray_indices: the indices of the rays to cast; None for all.
        """
        if ray_indices is not None:
            origins, rays = origins[ray_indices], rays[ray_indices]
        tree_hits = self._tree.run(origins, rays, output=1)
        distances = tree_hits["tfar"] + np.float32(start)
        previous_distances = hits.distances if ray_indices is None else hits.distances[ray_indices]
        nearer = np.flatnonzero((tree_hits["primID"] >= 0) & (distances < previous_distances))
        triangles = tree_hits["primID"][nearer]
        updated_rays = nearer if ray_indices is None else ray_indices[nearer]
        hits.distances[updated_rays] = distances[nearer]
        hits.geoms[updated_rays] = self._triangle_geoms[triangles]
        if hits.normals is not None:
            hits.normals[updated_rays] = self._normals[triangles]


class EmbreeCaster:
    """Ray casting with Embree against triangles.

    One tree of all static geoms is reused for many images.

    Raises:
        ImportError: embreex is not installed.
    """

    method = phrase("ray casting with Embree, because neither EGL nor OSMesa is available")

    def __init__(self, simulation: Simulation) -> None:
        import embreex  # type: ignore[import-not-found, import-untyped, unused-ignore]  # noqa: F401 - is it installed?

        self._simulation = simulation
        self._revision = -1
        self._static_tree: _TriangleTree | None = None
        self._movable_geoms = MovableGeoms(simulation, {})
        self._static_meshes: dict[int, Mesh] = {}
        self._static_poses: Any = np.empty((0, 12))
        self._geom_sizes: Any = np.empty((0, 3))
        self._movable_meshes: dict[int, Mesh] = {}
        self._planes: list[int] = []

    def cast(self, view: CameraView, *, normals: bool) -> Hits:
        """Cast the rays of an image with Embree."""
        origin, rays, near = view.origin, view.rays, view.optics.near
        simulation = self._simulation
        simulation.refresh()
        if self._revision != simulation.revision:
            self._read_model(simulation.model)
            self._revision = simulation.revision
        else:
            self._release_changed_geoms()
        count = len(rays)
        hits = Hits(
            np.full(count, np.inf, np.float32),
            np.full(count, -1, np.int32),
            np.zeros((count, 3), np.float32) if normals else None,
        )
        self._cast_to_planes(hits, origin, rays)
        origins = rays * np.float32(near)
        origins += origin.astype(np.float32)
        if self._movable_geoms.update_resting(origin):
            self._build_static_tree()
        if self._static_tree is not None:
            self._static_tree.cast_into(hits, origins, rays, near)
        visible_boxes = self._movable_geoms.find_visible_geoms(view)
        if visible_boxes:
            moving_triangles = _TriangleTree(
                {geom: self._movable_meshes[geom] for geom in visible_boxes}, simulation.data
            )
            moving_triangles.cast_into(
                hits, origins, rays, near, find_covered_pixels(view.optics, list(visible_boxes.values()))
            )
        return hits

    def _read_model(self, model: Any) -> None:
        self._static_meshes, self._movable_meshes, self._planes = {}, {}, []
        for geom in range(model.ngeom):
            if model.geom_group[geom] != VISUAL_GROUP or is_invisible(model, geom):
                continue
            if is_infinite_plane(model, geom):
                self._planes.append(geom)
            elif (mesh := create_triangle_mesh(model, geom)) is not None:
                meshes = (
                    self._static_meshes if model.body_weldid[model.geom_bodyid[geom]] == 0 else self._movable_meshes
                )
                meshes[geom] = mesh
        self._reset_movable()
        self._build_static_tree()

    def _reset_movable(self) -> None:
        self._movable_geoms = MovableGeoms(self._simulation, self._movable_meshes)
        self._static_poses, self._geom_sizes = self._get_static_poses(), self._simulation.model.geom_size.copy()

    def _release_changed_geoms(self) -> None:
        """Move geoms whose pose or size has changed out of the static tree.

        Static geoms change while a data set is generated, because each of its images shows a different scene.
        """
        model = self._simulation.model
        static_geoms = np.array(list(self._static_meshes), dtype=np.int64)
        moved_geoms = static_geoms[(self._get_static_poses() != self._static_poses).any(axis=1)]
        resized_geoms = np.flatnonzero((model.geom_size != self._geom_sizes).any(axis=1))
        if not len(moved_geoms) and not len(resized_geoms):
            return
        static_count, resting_geoms = len(self._static_meshes), self._movable_geoms.resting
        for geom in (*moved_geoms.tolist(), *resized_geoms.tolist()):
            if geom in self._static_meshes:
                self._movable_meshes[geom] = self._static_meshes.pop(geom)
        for geom in resized_geoms.tolist():
            if geom in self._movable_meshes and (mesh := create_triangle_mesh(model, geom)) is not None:
                self._movable_meshes[geom] = mesh
        self._reset_movable()
        if resting_geoms or len(self._static_meshes) != static_count:
            self._build_static_tree()

    def _get_static_poses(self) -> Any:
        data, geoms = self._simulation.data, list(self._static_meshes)
        return np.concatenate([data.geom_xpos[geoms], data.geom_xmat[geoms]], axis=1)

    def _build_static_tree(self) -> None:
        """Build the tree of the static and resting geoms."""
        meshes = self._static_meshes | {geom: self._movable_meshes[geom] for geom in self._movable_geoms.resting}
        self._static_tree = _TriangleTree(meshes, self._simulation.data) if meshes else None

    def _cast_to_planes(self, hits: Hits, origin: Array, rays: Any) -> None:
        data = self._simulation.data
        for geom in self._planes:
            normal = data.geom_xmat[geom].reshape(3, 3)[:, 2]
            height = float((origin - data.geom_xpos[geom]) @ normal)
            if height <= 0:
                continue
            with np.errstate(divide="ignore"):
                distances = np.float32(-height) / (rays @ normal.astype(np.float32))
            nearer = np.flatnonzero((distances > 0) & (distances < hits.distances))
            hits.distances[nearer], hits.geoms[nearer] = distances[nearer], geom
            if hits.normals is not None:
                hits.normals[nearer] = normal


def is_invisible(model: Any, geom: int) -> bool:
    """Return whether a geom is fully transparent."""
    material = model.geom_matid[geom]
    rgba = model.geom_rgba[geom] if material < 0 else model.mat_rgba[material]
    return bool(rgba[3] == 0)
