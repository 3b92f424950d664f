"""Triangles as samples."""

from __future__ import annotations

import numpy as np

from linkwright.picture.rasterizer import DepthBuffer, ScreenTriangles, rasterize


def make_triangles(points: list[tuple[float, float, float]]) -> ScreenTriangles:
    x, y, nearness = np.array(points, float).T
    return ScreenTriangles.from_faces(x, y, nearness, np.arange(len(points)).reshape(-1, 3))


def test_adjacent_triangles_cover_each_sample_once() -> None:
    random = np.random.default_rng(3)
    corners = random.uniform(0, 40, (9, 2))
    middle = corners.mean(axis=0)
    angles = np.arctan2(*(corners - middle).T)
    corners = corners[np.argsort(angles)]
    fan = [
        point
        for first, second in zip(corners, np.roll(corners, -1, axis=0), strict=True)
        for point in ((*middle, 0.0), (*first, 0.0), (*second, 0.0))
    ]
    counts = np.zeros(40 * 40, int)
    for part in rasterize(make_triangles(fan), np.arange(9), 40, 0, 40):
        np.add.at(counts, part.samples, 1)
    assert counts.max() == 1
    grid = counts.reshape(40, 40)
    inside = (np.abs(np.arange(40) + 0.5 - middle[0]) < 2)[None, :] & (np.abs(np.arange(40) + 0.5 - middle[1]) < 2)[
        :, None
    ]
    assert (grid[inside] == 1).all()


def test_nearest_triangle_is_kept_at_each_sample() -> None:
    crossing = make_triangles([(0, 0, 0.0), (20, 0, 1.0), (0, 20, 0.0), (0, 0, 0.5), (20, 0, 0.5), (0, 20, 0.5)])
    for order in ([0, 1], [1, 0]):
        buffer = DepthBuffer(20, 0, 20, 1.0, 0.0)
        for index in order:
            buffer.add(crossing, np.array([index]))
        visible = buffer.visible_triangles(1)
        assert visible is not None
        row = visible.triangles[visible.y == 0.5]
        assert row.tolist() == [1] * 10 + [0] * 10 or row.tolist() == [1] * 10 + [0] * 9


def test_triangles_are_clipped_at_borders() -> None:
    buffer = DepthBuffer(10, 5, 8, 1.0, 0.0)
    buffer.add(make_triangles([(-1e6, -1e6, 0.5), (1e6, -1e6, 0.5), (0, 1e6, 0.5)]), np.array([0]))
    visible = buffer.visible_triangles(1)
    assert visible is not None
    assert visible.mask.all()
    assert visible.mask.shape == (3, 10)


def test_triangle_seen_edge_on_has_no_samples() -> None:
    buffer = DepthBuffer(10, 0, 10, 1.0, 0.0)
    buffer.add(make_triangles([(1, 1, 0.0), (9, 9, 1.0), (5, 5, 0.5)]), np.array([0]))
    assert buffer.visible_triangles(1) is None
