"""The decomposition of surfaces into convex parts."""

from __future__ import annotations

import numpy as np

from linkwright.geometry.decomposition import THICKNESS, convex_pieces, thicken
from linkwright.geometry.polygon import triangulate

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
