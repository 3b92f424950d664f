"""Normals of triangle meshes: smooth over curved surfaces, and sharp at creases."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.picture.vectors import (
    Indices,
    cross_products,
    dot_products,
    repeat_indices,
    sum_by_index,
    unit_vectors,
)

CREASE_COSINE = 0.8
"""The cosine of about 37 degrees. Triangles that meet at a larger angle form a crease."""
_WELDED_STEPS = (1 << 20) - 1
"""Corners closer than this fraction of the mesh's extent are treated as one vertex."""
_MAX_NEIGHBORS = 48
"""The maximum number of triangles compared at a corner on a crease. With more triangles, the shading is flat."""
_NORMAL_GRID = 4096.0
"""Components of normals are rounded to multiples of 1 / _NORMAL_GRID."""


@dataclass(frozen=True, slots=True)
class SmoothMesh:
    """A mesh with one normal per vertex.

    Attributes:
        sources: the index of each vertex in the mesh that it comes from, shape (n,).
        normals: the unit normal of each vertex, shape (n, 3).
        faces: the triangles, as indices of vertices, shape (m, 3).
    """

    sources: Indices
    normals: Array
    faces: Indices


def smooth_mesh(points: Array, faces: Indices, *, merged: bool = True) -> SmoothMesh:
    """Split the vertices of a mesh at its creases, and compute their normals.

    Args:
        points: the corners, shape (n, 3); corners at the same place count as one.
        faces: the triangles, shape (m, 3).
        merged: whether corners at the same place become one vertex; false if they differ in texture coordinates or
            colors.
    """
    corners = faces.reshape(-1)
    position_ids = _weld_points(points)
    corner_position_ids = position_ids[corners]
    face_normals, weights = _compute_corner_weights(points, faces)
    count = int(corner_position_ids.max()) + 1
    face_of_corner = np.repeat(np.arange(len(faces)), 3)
    mean_normals = unit_vectors(
        sum_by_index(corner_position_ids, face_normals[face_of_corner] * weights[:, None], count)
    )
    is_smooth_corner = dot_products(face_normals[face_of_corner], mean_normals[corner_position_ids]) >= CREASE_COSINE
    is_rough = np.zeros(count, dtype=bool)
    is_rough[corner_position_ids[~is_smooth_corner]] = True
    rough_corners = np.flatnonzero(is_rough[corner_position_ids])
    rough_normals = _compute_creased_normals(rough_corners, corner_position_ids, face_normals, weights)
    # Smooth vertices come first, then a vertex for each rough corner.
    groups = corner_position_ids if merged else corners
    sources_of_groups = np.full(count if merged else len(points), -1)
    sources_of_groups[groups[::-1]] = corners[::-1]
    sources_of_groups[groups[rough_corners]] = -1
    smooth_groups = np.flatnonzero(sources_of_groups >= 0)
    new_index = np.zeros(len(sources_of_groups), dtype=np.int64)
    new_index[smooth_groups] = np.arange(len(smooth_groups))
    new_faces = new_index[groups]
    new_faces[rough_corners] = len(smooth_groups) + np.arange(len(rough_corners))
    sources = np.concatenate((sources_of_groups[smooth_groups], corners[rough_corners]))
    normals = np.concatenate((mean_normals[position_ids[sources_of_groups[smooth_groups]]], rough_normals))
    return SmoothMesh(sources, np.rint(normals * _NORMAL_GRID) / _NORMAL_GRID, new_faces.reshape(-1, 3))


def _weld_points(points: Array) -> Indices:
    """Return a number for each point, equal for points at the same position."""
    low = points.min(axis=0)
    extent = float((points.max(axis=0) - low).max())
    steps = np.rint((points - low) * (_WELDED_STEPS / extent if extent > 0 else 0.0)).astype(np.int64)
    keys = (steps[:, 0] << 42) | (steps[:, 1] << 21) | steps[:, 2]
    return np.asarray(np.unique(keys, return_inverse=True)[1], dtype=np.int64).reshape(-1)


def _compute_corner_weights(points: Array, faces: Indices) -> tuple[Array, Array]:
    """Return the unit normals of triangles, and the weight of each triangle at its corners.

    The weights are a flat array. They are those of N. Max, "Weights for computing vertex normals from facet normals"
    (1999): for points on a sphere the normals are exact, and how a rectangle is split into triangles does not matter.
    """
    sides = [points[faces[:, (corner + 1) % 3]] - points[faces[:, corner]] for corner in range(3)]
    squared_lengths = [dot_products(side, side) for side in sides]
    areas = cross_products(sides[0], sides[1])
    normals = unit_vectors(areas)
    doubled_areas = dot_products(areas, normals)
    weights = np.empty(faces.shape)
    for corner in range(3):
        divisor = squared_lengths[corner] * squared_lengths[(corner + 2) % 3]
        weights[:, corner] = np.where(divisor > 0, doubled_areas / np.where(divisor > 0, divisor, 1.0), 0.0)
    return normals, weights.reshape(-1)


def _compute_creased_normals(
    rough_corners: Indices, corner_position_ids: Indices, face_normals: Array, weights: Array
) -> Array:
    """Return a normal for each corner at a crease.

    The normal is the mean over the adjacent triangles that meet smoothly.
    """
    faces = rough_corners // 3
    position_ids = corner_position_ids[rough_corners]
    order = np.argsort(position_ids, kind="stable")
    sorted_ids = position_ids[order]
    starts = np.searchsorted(sorted_ids, sorted_ids, side="left")
    neighbor_counts = np.searchsorted(sorted_ids, sorted_ids, side="right") - starts
    neighbor_counts[neighbor_counts > _MAX_NEIGHBORS] = 0
    weighted = face_normals[faces[order]] * weights[rough_corners[order], None]
    sums = weighted.copy()
    corner_indices, neighbor_steps = repeat_indices(neighbor_counts)
    neighbors = starts[corner_indices] + neighbor_steps
    own_faces, other_faces = faces[order][corner_indices], faces[order][neighbors]
    is_smooth_pair = (own_faces != other_faces) & (
        dot_products(face_normals[own_faces], face_normals[other_faces]) >= CREASE_COSINE
    )
    sums += sum_by_index(corner_indices[is_smooth_pair], weighted[neighbors[is_smooth_pair]], len(order))
    normals = np.empty_like(sums)
    normals[order] = unit_vectors(sums)
    return normals
