"""Convex decomposition of surfaces for physics engines."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array
from linkwright.geometry.hull import convex_hull
from linkwright.geometry.polyhedron import Faces, is_closed, merge_corners, polyhedron_properties
from linkwright.geometry.surface_patches import Triangles, split_into_patches

THICKNESS = 0.02
"""The thickness, in m, of a face that becomes a separate piece."""

_MIN_WIDTH = 1e-6
"""The maximum width, in m, of a piece that has no surface."""
_NEARLY_CONVEX_RATIO = 0.95
"""A closed surface that fills at least this fraction of its hull counts as convex."""
_COPLANAR_TOLERANCE = 1e-4
"""Two triangles are coplanar if the cosine between their normals differs from 1 by at most this."""
_MAX_CORNERS = 2000
"""A part with more corners is not tested for convexity, because it is neither a box nor a wall."""


def convex_pieces(vertices: Array, faces: Faces, max_pieces: int, max_patches: int = 1) -> list[Array]:
    """Decompose a static surface into convex pieces.

    A connected part that is nearly convex becomes one piece, its hull. In all other parts, each flat face becomes a
    plate that extends `THICKNESS` inwards; if the face is not convex, each of its triangles becomes a plate. Rooms
    therefore stay hollow, and tables keep their legs. If there would be too many pieces, the parts with the most plates
    become the hulls of patches of their surface: caves and terrains stay hollow, and are coarser than their triangles.

    Args:
        vertices: corners in m, shape (vertices, 3).
        faces: indices of corners, shape (faces, 3), counterclockwise from outside.
        max_pieces: the maximum number of pieces, patches excluded.
        max_patches: the maximum number of patches; with 1, a part with too many plates becomes its hull.

    Returns:
        The corners of each piece, shape (corners, 3).
    """
    vertices, faces = merge_corners(vertices, faces)
    if not len(faces):
        return []
    components = [faces[component] for component in _find_components(faces, len(vertices))]
    pieces: list[Array] = []
    concave: list[tuple[Faces, list[Array]]] = []
    for component_faces in components:
        corners = vertices[np.unique(component_faces)]
        if _is_nearly_convex(vertices, component_faces, corners):
            pieces.append(corners)
        else:
            concave.append((component_faces, _list_plates(vertices, component_faces, max_pieces)))
    concave.sort(key=lambda item: len(item[1]))
    remaining = max_pieces - len(pieces) - len(concave)
    coarse: list[Faces] = []
    for component_faces, plates in concave:
        if len(plates) - 1 <= remaining:
            pieces += plates
            remaining -= len(plates) - 1
        else:
            coarse.append(component_faces)
    for number, component_faces in enumerate(coarse):
        patches = _list_patches(vertices, component_faces, max(max_patches // (len(coarse) - number), 1))
        max_patches -= len(patches)
        pieces += patches
    return pieces


def _list_patches(vertices: Array, faces: Faces, max_patches: int) -> list[Array]:
    """Return the corners of hulls for the patches of a part; only its hull if it needs no patches."""
    is_solid = is_closed(faces)
    if is_solid and polyhedron_properties(vertices, faces).mass < 0.0:
        faces = faces[:, ::-1]
    patches = split_into_patches(vertices[faces], max_patches, is_solid=is_solid)
    return [_make_shell(patch) for patch in patches] if len(patches) > 1 else [vertices[np.unique(faces)]]


def _make_shell(patch: Triangles) -> Array:
    """Return the corners of a patch, and the same corners below the side that its triangles face on average."""
    corners: Array = np.unique(patch.reshape(-1, 3), axis=0)
    normal = np.cross(patch[:, 1] - patch[:, 0], patch[:, 2] - patch[:, 0]).sum(axis=0)
    length = float(np.linalg.norm(normal))
    return _make_plate(corners, normal / length) if length > 0.0 else corners


def thicken(corners: Array) -> Array:
    """Return the corners of a convex piece, thickened on both sides if they are nearly coplanar."""
    center = corners.mean(axis=0)
    _, sizes, axes = np.linalg.svd(corners - center, full_matrices=False)
    extent = np.ptp((corners - center) @ axes[2]) if len(corners) > 2 and len(sizes) > 2 else 0.0
    if len(sizes) > 2 and extent > 1e-3:
        return corners
    normal = axes[2] if len(axes) > 2 else np.array([0.0, 0.0, 1.0])
    return np.concatenate([corners + normal * THICKNESS / 2, corners - normal * THICKNESS / 2])


def is_collinear(corners: Array) -> bool:
    """Return whether the corners of a piece are collinear, so that it has no surface."""
    sizes = np.linalg.svd(corners - corners.mean(axis=0), compute_uv=False)
    return len(sizes) < 2 or float(sizes[1]) <= _MIN_WIDTH


def _find_components(faces: Faces, count: int) -> list[NDArray[np.int64]]:
    """Return the indices of the faces in each connected component."""
    labels = _label_components(faces, count)[faces[:, 0]]
    order = np.argsort(labels, kind="stable")
    starts = np.flatnonzero(np.diff(labels[order], prepend=-1))
    return np.split(order, starts[1:])


def _label_components(groups: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    """Return, for each index below a count, the smallest index connected to it.

    Each row of `groups` connects its indices with each other.
    """
    labels = np.arange(count)
    while True:
        smallest = labels[groups].min(axis=1)
        new_labels = labels.copy()
        np.minimum.at(new_labels, groups.reshape(-1), np.repeat(smallest, groups.shape[1]))
        new_labels = new_labels[new_labels]
        if np.array_equal(new_labels, labels):
            return labels
        labels = new_labels


def _is_nearly_convex(vertices: Array, faces: Faces, corners: Array) -> bool:
    if len(corners) > _MAX_CORNERS or not is_closed(faces):
        return False
    hull = convex_hull(corners)
    if hull is None:
        return False
    volume = abs(polyhedron_properties(vertices, faces).mass)
    return volume >= _NEARLY_CONVEX_RATIO * polyhedron_properties(corners, hull).mass


def _list_plates(vertices: Array, faces: Faces, max_plates: int) -> list[Array]:
    """Return plates for the flat faces of a part, and stop after more than `max_plates`."""
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    faces, normals = faces[lengths > 0], normals[lengths > 0] / lengths[lengths > 0, None]
    plates: list[Array] = []
    for group in _find_flat_groups(faces, normals):
        if len(plates) > max_plates:
            break
        ring = vertices[np.unique(faces[group])]
        triangles = vertices[faces[group]]
        area = np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1)
        normal = normals[group[0]]
        hull_area = _compute_hull_area(ring, normal)
        if area.sum() / 2 >= _NEARLY_CONVEX_RATIO * hull_area:
            plates.append(_make_plate(ring, normal))
        else:
            plates += [_make_plate(triangle, normal) for triangle in triangles]
    return plates


def _make_plate(corners: Array, normal: Array) -> Array:
    return np.concatenate([corners, corners - THICKNESS * normal])


def _find_flat_groups(faces: Faces, normals: Array) -> list[NDArray[np.int64]]:
    """Return the indices of the triangles in each flat, connected group."""
    edges = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    edge_faces = np.repeat(np.arange(len(faces)), 3)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    edges, edge_faces = edges[order], edge_faces[order]
    shared = np.flatnonzero((edges[1:] == edges[:-1]).all(axis=1))
    pairs = np.stack([edge_faces[shared], edge_faces[shared + 1]], axis=1)
    is_flat = (normals[pairs[:, 0]] * normals[pairs[:, 1]]).sum(axis=1) > 1.0 - _COPLANAR_TOLERANCE
    labels = _label_components(pairs[is_flat], len(faces)) if is_flat.any() else np.arange(len(faces))
    order = np.argsort(labels, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(labels[order], prepend=-1))[1:])


def _compute_hull_area(points: Array, normal: Array) -> float:
    """Return the area of the convex hull of coplanar points (Andrew's monotone chain)."""
    first_axis = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    first_axis /= np.linalg.norm(first_axis)
    plane = np.stack([points @ first_axis, points @ np.cross(normal, first_axis)], axis=1)
    ordered = plane[np.lexsort((plane[:, 1], plane[:, 0]))].tolist()
    ring: list[list[float]] = []
    for direction in (ordered, ordered[::-1]):
        start = len(ring)
        for x, y in direction:
            while len(ring) >= start + 2:
                (ax, ay), (bx, by) = ring[-2], ring[-1]
                if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0:
                    break
                ring.pop()
            ring.append([x, y])
        ring.pop()
    x, y = np.array(ring or [[0.0, 0.0]]).T
    return float(abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2)
