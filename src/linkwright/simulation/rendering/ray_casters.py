"""Ray casting against all visible geoms, by Embree or by MuJoCo itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from linkwright.diagnostics import Phrase, phrase
from linkwright.geometry.arrays import Array
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.ray_casting import GROUPS
from linkwright.simulation.rendering.movable import MovableGeoms, View, pixels_towards
from linkwright.simulation.rendering.triangles import Mesh, is_endless, triangles_of
from linkwright.simulation.scene.bodies import VISUAL_GROUP
from linkwright.simulation.simulation import Simulation


@dataclass(slots=True)
class Hits:
    """The first hits of rays.

    Attributes:
        distances: the distances in multiples of the ray's length, inf for no hit: shape (n,), float32.
        geoms: the indices of the geoms in MuJoCo's model, -1 for no hit: shape (n,), int32.
        normals: unit normals of the surface, facing either side: shape (n, 3), float32; None if not requested.
    """

    distances: Any
    geoms: Any
    normals: Any


class Caster(Protocol):
    """The interface of ray casters for images."""

    way: Phrase

    def cast(self, view: View, *, normals: bool) -> Hits:
        """Cast the rays of an image into the current world, from the camera's near clip plane on.

        Args:
            view: the view of the image.
            normals: whether to return normals.
        """


class MujocoCaster:
    """Ray casting by MuJoCo, which is exact and slow."""

    way = phrase("slow ray casting by MuJoCo, because EGL, OSMesa and embreex are not available")

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._mujoco = load_mujoco()
        self._groups = np.zeros(GROUPS, dtype=np.uint8)
        self._groups[VISUAL_GROUP] = 1

    def cast(self, view: View, *, normals: bool) -> Hits:
        """Cast the rays of an image with MuJoCo."""
        del normals  # MuJoCo always returns normals.
        origin, rays, start = view.origin, view.rays, view.optics.near
        simulation = self._simulation
        simulation.refresh()
        count = len(rays)
        rays = rays.astype(np.float64)
        lengths = np.linalg.norm(rays, axis=1)
        directions = (rays / lengths[:, None]).ravel()
        distances, geoms, found = np.empty(count), np.empty(count, dtype=np.int32), np.zeros(3 * count)
        self._mujoco.mj_multiRay(
            simulation.model, simulation.data, origin, directions, self._groups, 1, -1, geoms, distances, found,
            count, self._mujoco.mjMAXVAL,
        )  # fmt: skip
        sides = found.reshape(-1, 3)
        for ray in np.nonzero((geoms >= 0) & (distances < start * lengths))[0]:
            geoms[ray], distances[ray], sides[ray] = self._beyond(origin, rays[ray], lengths[ray], start)
        reached = np.where(geoms >= 0, distances / lengths, np.inf)
        return Hits(reached.astype(np.float32), geoms, sides.astype(np.float32))

    def _beyond(self, origin: Array, ray: Array, length: float, start: float) -> tuple[int, float, Array]:
        """Return the first hit of one ray beyond the near clip plane: geom, distance in m and normal."""
        model, data, geom, normal = self._simulation.model, self._simulation.data, np.zeros(1, np.int32), np.zeros(3)
        begin, along = origin + start * ray, ray / length
        further = self._mujoco.mj_ray(model, data, begin, along, self._groups, 1, -1, geom, normal)
        return int(geom[0]), start * length + further, normal


class _Triangles:
    """Triangles of geoms in the world, with their Embree tree."""

    def __init__(self, meshes: dict[int, Mesh], data: Any) -> None:
        from embreex.mesh_construction import TriangleMesh  # type: ignore[import-not-found, import-untyped, unused-ignore]
        from embreex.rtcore_scene import EmbreeScene  # type: ignore[import-not-found, import-untyped, unused-ignore]

        self._owners = np.repeat(list(meshes), [len(faces) for _, faces in meshes.values()]).astype(np.int32)
        starts = np.cumsum([0, *(len(corners) for corners, _ in meshes.values())])
        shifted = [faces + start for (_, faces), start in zip(meshes.values(), starts, strict=False)]
        faces = np.concatenate(shifted).astype(np.int32)
        placed = [
            corners @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]
            for geom, (corners, _) in meshes.items()
        ]
        corners = np.concatenate(placed).astype(np.float32)
        self._tree: Any = EmbreeScene()
        TriangleMesh(self._tree, corners, faces)
        first, second, third = (corners[faces[:, corner]] for corner in range(3))
        across = np.cross(second - first, third - first)
        self._normals = across / np.maximum(np.linalg.norm(across, axis=1), 1e-20)[:, None].astype(np.float32)

    def cast_into(self, hits: Hits, origins: Any, rays: Any, start: float, numbers: Any = None) -> None:
        """Update `hits` with the hits that are nearer than the recorded ones.

        Args:
            hits: the hits recorded so far.
            origins: the origin of each ray.
            rays: the direction of each ray.
            start: the distance from the camera to the origin along the ray.
            numbers: the indices of the rays to cast; None for all.
        """
        if numbers is not None:
            origins, rays = origins[numbers], rays[numbers]
        found = self._tree.run(origins, rays, output=1)
        distances = found["tfar"] + np.float32(start)
        before = hits.distances if numbers is None else hits.distances[numbers]
        nearer = np.flatnonzero((found["primID"] >= 0) & (distances < before))
        triangles = found["primID"][nearer]
        changed = nearer if numbers is None else numbers[nearer]
        hits.distances[changed] = distances[nearer]
        hits.geoms[changed] = self._owners[triangles]
        if hits.normals is not None:
            hits.normals[changed] = self._normals[triangles]


class EmbreeCaster:
    """Ray casting by Embree against triangles, with one tree that is reused for all static geoms.

    Raises:
        ImportError: embreex is not installed.
    """

    way = phrase("ray casting by Embree, because neither EGL nor OSMesa is available")

    def __init__(self, simulation: Simulation) -> None:
        import embreex  # type: ignore[import-not-found, import-untyped, unused-ignore]  # noqa: F401 - is it installed?

        self._simulation = simulation
        self._revision = -1
        self._standing: _Triangles | None = None
        self._movable = MovableGeoms(simulation, {})
        self._fixed: dict[int, Mesh] = {}
        self._places: Any = np.empty((0, 12))
        self._sizes: Any = np.empty((0, 3))
        self._loose: dict[int, Mesh] = {}
        self._planes: list[int] = []

    def cast(self, view: View, *, normals: bool) -> Hits:
        """Cast the rays of an image with Embree."""
        origin, rays, start = view.origin, view.rays, view.optics.near
        simulation = self._simulation
        simulation.refresh()
        if self._revision != simulation.revision:
            self._read(simulation.model)
            self._revision = simulation.revision
        else:
            self._release_changed()
        count = len(rays)
        hits = Hits(
            np.full(count, np.inf, np.float32),
            np.full(count, -1, np.int32),
            np.zeros((count, 3), np.float32) if normals else None,
        )
        self._cast_to_planes(hits, origin, rays)
        origins = rays * np.float32(start)
        origins += origin.astype(np.float32)
        if self._movable.settle(origin):
            self._build_static()
        if self._standing is not None:
            self._standing.cast_into(hits, origins, rays, start)
        seen = self._movable.in_view(view)
        if seen:
            moving = _Triangles({geom: self._loose[geom] for geom in seen}, simulation.data)
            moving.cast_into(hits, origins, rays, start, pixels_towards(view.optics, list(seen.values())))
        return hits

    def _read(self, model: Any) -> None:
        self._fixed, self._loose, self._planes = {}, {}, []
        for geom in range(model.ngeom):
            if model.geom_group[geom] != VISUAL_GROUP or is_invisible(model, geom):
                continue
            if is_endless(model, geom):
                self._planes.append(geom)
            elif (mesh := triangles_of(model, geom)) is not None:
                where = self._fixed if model.body_weldid[model.geom_bodyid[geom]] == 0 else self._loose
                where[geom] = mesh
        self._reset_movable()
        self._build_static()

    def _reset_movable(self) -> None:
        self._movable = MovableGeoms(self._simulation, self._loose)
        self._places, self._sizes = self._fixed_poses(), self._simulation.model.geom_size.copy()

    def _release_changed(self) -> None:
        """Move geoms whose pose or size has changed out of the static tree.

        Static geoms change when a data set is generated, because each of its images shows a different scene.
        """
        model = self._simulation.model
        still = np.array(list(self._fixed), dtype=np.int64)
        moved = still[(self._fixed_poses() != self._places).any(axis=1)]
        shaped = np.flatnonzero((model.geom_size != self._sizes).any(axis=1))
        if not len(moved) and not len(shaped):
            return
        before, rested = len(self._fixed), self._movable.resting
        for geom in (*moved.tolist(), *shaped.tolist()):
            if geom in self._fixed:
                self._loose[geom] = self._fixed.pop(geom)
        for geom in shaped.tolist():
            if geom in self._loose and (mesh := triangles_of(model, geom)) is not None:
                self._loose[geom] = mesh
        self._reset_movable()
        if rested or len(self._fixed) != before:
            self._build_static()

    def _fixed_poses(self) -> Any:
        data, geoms = self._simulation.data, list(self._fixed)
        return np.concatenate([data.geom_xpos[geoms], data.geom_xmat[geoms]], axis=1)

    def _build_static(self) -> None:
        """Build the tree of the static and resting geoms."""
        meshes = self._fixed | {geom: self._loose[geom] for geom in self._movable.resting}
        self._standing = _Triangles(meshes, self._simulation.data) if meshes else None

    def _cast_to_planes(self, hits: Hits, origin: Array, rays: Any) -> None:
        data = self._simulation.data
        for geom in self._planes:
            normal = data.geom_xmat[geom].reshape(3, 3)[:, 2]
            above = float((origin - data.geom_xpos[geom]) @ normal)
            if above <= 0:
                continue
            with np.errstate(divide="ignore"):
                distances = np.float32(-above) / (rays @ normal.astype(np.float32))
            nearer = np.flatnonzero((distances > 0) & (distances < hits.distances))
            hits.distances[nearer], hits.geoms[nearer] = distances[nearer], geom
            if hits.normals is not None:
                hits.normals[nearer] = normal


def is_invisible(model: Any, geom: int) -> bool:
    """Return whether a geom is fully transparent."""
    material = model.geom_matid[geom]
    rgba = model.geom_rgba[geom] if material < 0 else model.mat_rgba[material]
    return bool(rgba[3] == 0)
