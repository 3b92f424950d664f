"""Rays against everything that is seen: by Embree, or by MuJoCo itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from linkwright.diagnostics import Phrase, phrase
from linkwright.geometry.arrays import Array
from linkwright.simulation.casting import GROUPS
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.rendering.triangles import Mesh, is_endless, triangles_of
from linkwright.simulation.scene.bodies import VISUAL_GROUP
from linkwright.simulation.simulation import Simulation

_THIN = 1e-6
"""In m: what is on the surface of a box is in it."""


@dataclass(slots=True)
class Hits:
    """What rays hit first.

    Attributes:
        distances: in lengths of the ray, inf for nothing: shape (n,), float32.
        geoms: of MuJoCo's model, -1 for none: shape (n,), int32.
        normals: of the surface, unit vectors to either side: shape (n, 3), float32.
    """

    distances: Any
    geoms: Any
    normals: Any


class Caster(Protocol):
    """Casts rays."""

    way: Phrase

    def cast(self, origin: Array, rays: Any, start: float) -> Hits:
        """What rays from one point hit, as the world is now.

        Args:
            origin: the point, in m.
            rays: where they go, shape (n, 3), float32.
            start: how far away they begin, in lengths of the ray.
        """


class MujocoCaster:
    """MuJoCo's own rays: exact and slow."""

    way = phrase("rays of MuJoCo, as there is neither EGL nor OSMesa nor embreex: slow")

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._mujoco = load_mujoco()
        self._groups = np.zeros(GROUPS, dtype=np.uint8)
        self._groups[VISUAL_GROUP] = 1

    def cast(self, origin: Array, rays: Any, start: float) -> Hits:
        """What rays hit."""
        simulation = self._simulation
        simulation.refresh()
        count = len(rays)
        rays = rays.astype(np.float64)
        lengths = np.linalg.norm(rays, axis=1)
        directions = (rays / lengths[:, None]).ravel()
        distances, geoms, normals = np.empty(count), np.empty(count, dtype=np.int32), np.zeros(3 * count)
        self._mujoco.mj_multiRay(
            simulation.model, simulation.data, origin, directions, self._groups, 1, -1, geoms, distances, normals,
            count, self._mujoco.mjMAXVAL,
        )  # fmt: skip
        sides = normals.reshape(-1, 3)
        for ray in np.nonzero((geoms >= 0) & (distances < start * lengths))[0]:
            geoms[ray], distances[ray], sides[ray] = self._beyond(origin, rays[ray], lengths[ray], start)
        reached = np.where(geoms >= 0, distances / lengths, np.inf)
        return Hits(reached.astype(np.float32), geoms, sides.astype(np.float32))

    def _beyond(self, origin: Array, ray: Array, length: float, start: float) -> tuple[int, float, Array]:
        """What one ray hits: the geom, the distance in m, and the normal."""
        model, data, geom, normal = self._simulation.model, self._simulation.data, np.zeros(1, np.int32), np.zeros(3)
        begin, along = origin + start * ray, ray / length
        further = self._mujoco.mj_ray(model, data, begin, along, self._groups, 1, -1, geom, normal)
        return int(geom[0]), start * length + further, normal


class _Triangles:
    """Triangles of geoms, and Embree's tree of them."""

    def __init__(self, meshes: dict[int, Mesh]) -> None:
        self._meshes = meshes
        self._owners = np.repeat(list(meshes), [len(faces) for _, faces in meshes.values()]).astype(np.int32)
        starts = np.cumsum([0, *(len(corners) for corners, _ in meshes.values())])
        shifted = [faces + start for (_, faces), start in zip(meshes.values(), starts, strict=False)]
        self._faces = np.concatenate(shifted).astype(np.int32)
        self._tree: Any = None
        self._normals: Any = None

    def place(self, data: Any) -> None:
        """Put the geoms where they are."""
        from embreex.mesh_construction import TriangleMesh  # type: ignore[import-not-found, import-untyped, unused-ignore]
        from embreex.rtcore_scene import EmbreeScene  # type: ignore[import-not-found, import-untyped, unused-ignore]

        placed = [
            corners @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]
            for geom, (corners, _) in self._meshes.items()
        ]
        self._corners = np.concatenate(placed).astype(np.float32)
        self._tree = EmbreeScene()
        TriangleMesh(self._tree, self._corners, self._faces)
        first, second, third = (self._corners[self._faces[:, corner]] for corner in range(3))
        across = np.cross(second - first, third - first)
        self._normals = across / np.maximum(np.linalg.norm(across, axis=1), 1e-20)[:, None].astype(np.float32)

    def cast_into(self, hits: Hits, origins: Any, rays: Any, start: float) -> None:
        """Note what is hit nearer than what was hit already, by rays that begin at `start`."""
        found = self._tree.run(origins, rays, output=1)
        triangle, distances = found["primID"], found["tfar"] + np.float32(start)
        nearer = (triangle >= 0) & (distances < hits.distances)
        np.copyto(hits.distances, distances, where=nearer)
        np.copyto(hits.geoms, self._owners.take(triangle, mode="wrap"), where=nearer)
        np.copyto(hits.normals, self._normals.take(triangle, axis=0, mode="wrap"), where=nearer[:, None])


class EmbreeCaster:
    """Embree's rays against triangles: those of what stands still are put into its tree once.

    Raises:
        ImportError: embreex is not installed.
    """

    way = phrase("ray casting by Embree, as there is neither EGL nor OSMesa")

    def __init__(self, simulation: Simulation) -> None:
        import embreex  # type: ignore[import-not-found, import-untyped, unused-ignore]  # noqa: F401 - whether it is there

        self._simulation = simulation
        self._mujoco = load_mujoco()
        self._revision = -1
        self._standing: _Triangles | None = None
        self._moving: dict[int, Mesh] = {}
        self._planes: list[int] = []

    def cast(self, origin: Array, rays: Any, start: float) -> Hits:
        """What rays hit."""
        simulation = self._simulation
        simulation.refresh()
        if self._revision != simulation.revision:
            self._read(simulation.model)
            self._revision = simulation.revision
        count = len(rays)
        hits = Hits(np.full(count, np.inf, np.float32), np.full(count, -1, np.int32), np.zeros((count, 3), np.float32))
        self._cast_at_planes(hits, origin, rays)
        origins = rays * np.float32(start)
        origins += origin.astype(np.float32)
        if self._standing is not None:
            self._standing.cast_into(hits, origins, rays, start)
        seen = self._in_view(origin, rays)
        if seen:
            moving = _Triangles({geom: self._moving[geom] for geom in seen})
            moving.place(simulation.data)
            moving.cast_into(hits, origins, rays, start)
        return hits

    def _in_view(self, origin: Array, rays: Any) -> list[int]:
        """The geoms that move and that rays may hit, without boxes that the point is in: their insides are not seen."""
        if not self._moving:
            return []
        model, data, geoms = self._simulation.model, self._simulation.data, np.array(list(self._moving))
        axis = rays.mean(axis=0)
        axis /= max(np.linalg.norm(axis), 1e-9)
        half = np.arccos(np.clip((rays @ axis / np.sqrt(np.einsum("ij,ij->i", rays, rays))).min(), -1, 1))
        away = data.geom_xpos[geoms] - origin
        distances = np.maximum(np.linalg.norm(away, axis=1), 1e-9)
        reach = np.arcsin(np.minimum(model.geom_rbound[geoms] / distances, 1.0))
        beside = np.arccos(np.clip(away @ axis / distances, -1, 1))
        inside = np.einsum("ijk,ij->ik", data.geom_xmat[geoms].reshape(-1, 3, 3), away)
        around = (np.abs(inside) < model.geom_size[geoms] + _THIN).all(axis=1) & (
            model.geom_type[geoms] == self._mujoco.mjtGeom.mjGEOM_BOX
        )
        touching = (distances < model.geom_rbound[geoms]) | (beside <= half + reach)
        return [int(geom) for geom in geoms[touching & ~around]]

    def _read(self, model: Any) -> None:
        standing: dict[int, Mesh] = {}
        self._moving, self._planes = {}, []
        for geom in range(model.ngeom):
            if model.geom_group[geom] != VISUAL_GROUP or is_invisible(model, geom):
                continue
            if is_endless(model, geom):
                self._planes.append(geom)
            elif (mesh := triangles_of(model, geom)) is not None:
                where = standing if model.body_weldid[model.geom_bodyid[geom]] == 0 else self._moving
                where[geom] = mesh
        self._standing = _Triangles(standing) if standing else None
        if self._standing is not None:
            self._standing.place(self._simulation.data)

    def _cast_at_planes(self, hits: Hits, origin: Array, rays: Any) -> None:
        data = self._simulation.data
        for geom in self._planes:
            normal = data.geom_xmat[geom].reshape(3, 3)[:, 2]
            above = float((origin - data.geom_xpos[geom]) @ normal)
            if above <= 0:
                continue
            with np.errstate(divide="ignore"):
                distances = np.float32(-above) / (rays @ normal.astype(np.float32))
            nearer = (distances > 0) & (distances < hits.distances)
            np.copyto(hits.distances, distances, where=nearer)
            hits.geoms[nearer], hits.normals[nearer] = geom, normal


def is_invisible(model: Any, geom: int) -> bool:
    """Whether nothing is drawn of a geom."""
    material = model.geom_matid[geom]
    rgba = model.geom_rgba[geom] if material < 0 else model.mat_rgba[material]
    return bool(rgba[3] == 0)
