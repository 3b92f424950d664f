"""The decomposition of surfaces into convex parts."""

from __future__ import annotations

import numpy as np

from linkwright.geometry.decomposition import THICKNESS, convex_pieces, thicken
from linkwright.geometry.polygon import triangulate
from linkwright.geometry.surface_patches import split_into_patches

CORNERS = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
BOX = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
     [1, 5, 7], [1, 7, 3]]
)  # fmt: skip


def test_box_is_one_piece():
    (piece,) = convex_pieces(CORNERS, BOX, 100)
    assert sorted(map(tuple, piece)) == sorted(map(tuple, CORNERS))


def test_two_boxes_are_two_pieces():
    corners = np.concatenate([CORNERS, CORNERS + np.array([3.0, 0.0, 0.0])])
    assert len(convex_pieces(corners, np.concatenate([BOX, BOX + 8]), 100)) == 2


def test_open_box_is_split_into_walls():
    open_box = BOX[:-2]  # without its lid
    pieces = convex_pieces(CORNERS, open_box, 100)
    assert len(pieces) == 5
    middle = np.array([0.5, 0.5, 0.5])
    for piece in pieces:
        size = np.ptp(piece, axis=0)
        assert sorted(size.round(9)) == [THICKNESS, 1.0, 1.0]
        assert ((piece.min(axis=0) > middle) | (piece.max(axis=0) < middle)).any()


def test_too_many_pieces_fall_back_to_hull():
    assert len(convex_pieces(CORNERS, BOX[:-2], 4)) == 1


def tunnel(rings: int = 60, corners: int = 24):
    """Return a tunnel along x, of length 12 m and radius 2 m, whose triangles face inwards."""
    x, angle = np.meshgrid(np.linspace(0.0, 12.0, rings), np.linspace(0.0, 2 * np.pi, corners, endpoint=False))
    ripple = 2.0 + 0.02 * np.sin(7.0 * x) * np.cos(5.0 * angle)
    points = np.stack([x, ripple * np.cos(angle), ripple * np.sin(angle)], axis=2).transpose(1, 0, 2).reshape(-1, 3)
    faces = []
    for ring in range(rings - 1):
        for corner in range(corners):
            near, next_near = ring * corners + corner, ring * corners + (corner + 1) % corners
            far, next_far = near + corners, next_near + corners
            faces += [(near, next_near, far), (next_near, next_far, far)]
    return points, np.array(faces)


def distance_outside(piece, points):
    """Return how far points are outside the bounding box of a piece, in m."""
    return np.maximum(np.maximum(piece.min(axis=0) - points, points - piece.max(axis=0)), 0.0).max(axis=1)


def test_rough_tunnel_stays_hollow():
    points, faces = tunnel()
    pieces = convex_pieces(points, faces, 100, 200)
    assert 20 < len(pieces) <= 200
    middle = np.stack([np.linspace(0.5, 11.5, 50), np.zeros(50), np.zeros(50)], axis=1)
    for piece in pieces:
        assert distance_outside(piece, middle).min() > 0.5
    covered = {tuple(corner) for piece in pieces for corner in piece.round(9)}
    assert {tuple(point) for point in points.round(9)} <= covered
    assert len(convex_pieces(points, faces, 100)) == 1


def test_outside_of_round_body_is_not_cut():
    angles, turns = np.meshgrid(np.linspace(0.0, np.pi, 30), np.linspace(0.0, 2 * np.pi, 60))
    ball = np.stack([np.sin(angles) * np.cos(turns), np.sin(angles) * np.sin(turns), np.cos(angles)], axis=2)
    corners = ball[:-1, :-1], ball[1:, :-1], ball[1:, 1:], ball[:-1, 1:]
    triangles = np.concatenate(
        [np.stack([corners[i] for i in ring], axis=2).reshape(-1, 3, 3) for ring in ((0, 2, 1), (0, 3, 2))]
    )
    assert len(split_into_patches(triangles, 100, is_solid=True)) == 1
    assert len(split_into_patches(triangles[:, ::-1], 100, is_solid=True)) > 1


def test_flat_wall_keeps_its_door():
    outline = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (3.0, 2.0), (3.0, 0.0), (5.0, 0.0), (5.0, 3.0), (0.0, 3.0)]
    wall = np.array([[x, 0.0, z] for x, z in outline])
    triangles = wall[np.array(triangulate(outline))]
    patches = split_into_patches(triangles, 100, is_solid=False)
    door = np.array([[2.5, 0.0, 1.0]])
    assert len(patches) > 1
    assert all(distance_outside(patch.reshape(-1, 3), door).min() > 0.4 for patch in patches)


def test_concave_face_is_triangulated():
    outline = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)]
    triangles = triangulate(outline)
    assert len(triangles) == 4
    flat_points = np.array([[x, y, 0.0] for x, y in outline])
    assert len(convex_pieces(flat_points, np.array(triangles), 100)) == 4


def test_flat_surface_is_thickened():
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    assert np.ptp(thicken(square), axis=0).tolist() == [1.0, 1.0, THICKNESS]
    assert thicken(CORNERS) is CORNERS


def test_triangulation_keeps_area_in_both_orientations():
    star = [(0.0, 0.0), (4.0, 1.0), (5.0, 5.0), (3.0, 2.0), (0.0, 4.0), (1.5, 1.5)]
    for points in (star, star[::-1], [*star, star[0]]):
        triangles = triangulate(points)
        corners = np.array(points)
        area = sum(
            np.cross(np.append(corners[b] - corners[a], 0), np.append(corners[c] - corners[a], 0))[2] / 2
            for a, b, c in triangles
        )
        x, y = np.array(star).T
        assert area == abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2
