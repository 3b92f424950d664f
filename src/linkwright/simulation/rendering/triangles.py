"""Triangle meshes of the geoms in MuJoCo's model."""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.simulation.library import load_mujoco

_VERTICES_AROUND = 32
_RINGS_ALONG = 16
"""The number of vertices around the axis of a round shape, and of rings along the axis of an ellipsoid."""
Mesh = tuple[Array, Any]
"""The vertices in m, shape (n, 3), and the vertex indices of the triangles, shape (m, 3)."""


def is_infinite_plane(model: Any, geom: int) -> bool:
    """Return whether a geom is an infinite plane."""
    plane = model.geom_type[geom] == load_mujoco().mjtGeom.mjGEOM_PLANE
    return bool(plane and (model.geom_size[geom, 0] <= 0 or model.geom_size[geom, 1] <= 0))


def create_triangle_mesh(model: Any, geom: int) -> Mesh | None:
    """Return the triangles of a geom in its own frame, or None if it has no triangles.

    Infinite planes and geoms of unsupported types have no triangles.
    """
    kinds = load_mujoco().mjtGeom
    kind, size = model.geom_type[geom], model.geom_size[geom]
    if kind == kinds.mjGEOM_BOX:
        return _create_box(size)
    if kind == kinds.mjGEOM_SPHERE:
        return _create_ellipsoid(size[[0, 0, 0]], 0.0)
    if kind == kinds.mjGEOM_ELLIPSOID:
        return _create_ellipsoid(size, 0.0)
    if kind == kinds.mjGEOM_CAPSULE:
        return _create_ellipsoid(size[[0, 0, 0]], size[1])
    if kind == kinds.mjGEOM_CYLINDER:
        return _create_cylinder(size[0], size[1])
    if kind == kinds.mjGEOM_MESH:
        return _read_mesh(model, model.geom_dataid[geom])
    if kind == kinds.mjGEOM_HFIELD:
        return _read_height_field(model, model.geom_dataid[geom])
    if kind == kinds.mjGEOM_PLANE and not is_infinite_plane(model, geom):
        corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) * [size[0], size[1], 0]
        return corners, np.array([[0, 1, 2], [0, 2, 3]])
    return None


def _create_box(half: Array) -> Mesh:
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * half
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return corners, np.array([face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))])


def _create_grid(rows: int, columns: int, *, closed: bool) -> Any:
    """Return the triangles between successive rows of vertices.

    If `closed`, each row is a closed ring.
    """
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(columns if closed else columns - 1), indexing="ij")
    right = (column + 1) % columns
    lower_left, lower_right = row * columns + column, row * columns + right
    upper_left, upper_right = lower_left + columns, lower_right + columns
    return np.concatenate(
        [
            np.stack([lower_left, lower_right, upper_right], -1).reshape(-1, 3),
            np.stack([lower_left, upper_right, upper_left], -1).reshape(-1, 3),
        ]
    )


def _create_ellipsoid(radii: Array, half: float) -> Mesh:
    """Return the mesh of an ellipsoid whose two halves are moved apart along z.

    Each half moves by `half`.

    With equal radii, the mesh is a capsule.
    """
    elevations = np.linspace(-np.pi / 2, np.pi / 2, _RINGS_ALONG)
    azimuths = np.linspace(0, 2 * np.pi, _VERTICES_AROUND, endpoint=False)
    elevation, azimuth = np.meshgrid(elevations, azimuths, indexing="ij")
    z = np.sin(elevation) * radii[2] + np.sign(elevation) * half
    corners = np.stack(
        [np.cos(elevation) * np.cos(azimuth) * radii[0], np.cos(elevation) * np.sin(azimuth) * radii[1], z], -1
    )
    return corners.reshape(-1, 3), _create_grid(_RINGS_ALONG, _VERTICES_AROUND, closed=True)


def _create_cylinder(radius: float, half: float) -> Mesh:
    azimuths = np.linspace(0, 2 * np.pi, _VERTICES_AROUND, endpoint=False)
    ring = np.stack([np.cos(azimuths) * radius, np.sin(azimuths) * radius], -1)
    rows = [
        np.column_stack([scale * ring, np.full(_VERTICES_AROUND, z)])
        for scale, z in ((0, -half), (1, -half), (1, half), (0, half))
    ]
    return np.concatenate(rows), _create_grid(4, _VERTICES_AROUND, closed=True)


def _read_mesh(model: Any, index: int) -> Mesh:
    vertex, face = model.mesh_vertadr[index], model.mesh_faceadr[index]
    corners = model.mesh_vert[vertex : vertex + model.mesh_vertnum[index]]
    return np.array(corners, dtype=np.float64), np.array(model.mesh_face[face : face + model.mesh_facenum[index]])


def _read_height_field(model: Any, index: int) -> Mesh:
    rows, columns = model.hfield_nrow[index], model.hfield_ncol[index]
    half_length_x, half_length_y, max_height, _ = model.hfield_size[index]
    first = model.hfield_adr[index]
    heights = model.hfield_data[first : first + rows * columns].reshape(rows, columns) * max_height
    y, x = np.meshgrid(
        np.linspace(-half_length_y, half_length_y, rows),
        np.linspace(-half_length_x, half_length_x, columns),
        indexing="ij",
    )
    return np.stack([x, y, heights], -1).reshape(-1, 3), _create_grid(rows, columns, closed=False)
