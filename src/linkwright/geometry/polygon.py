"""Triangulate polygons in a plane, and test whether points are inside a polygon."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Point = tuple[float, float]


def triangulate(points: Sequence[Point]) -> list[tuple[int, int, int]]:
    """Triangulate a simple polygon by ear clipping.

    Source: Meisters, *Polygons have ears*, 1975.

    Args:
        points: the corners in either direction; the last is joined to the first, which may be repeated at the end.

    Returns:
        The indices of each triangle's corners, counterclockwise. For a polygon that crosses itself, only the triangles
        that could be cut off.
    """
    ring = [index for index, point in enumerate(points) if point != points[index - 1]]
    if _twice_area(points, ring) < 0:
        ring.reverse()
    triangles: list[tuple[int, int, int]] = []
    start = tried_count = 0
    while len(ring) >= 3 and tried_count < len(ring):
        a, b, c = (ring[(start + step) % len(ring)] for step in range(3))
        orientation = signed_double_area(points[a], points[b], points[c])
        if orientation > 0 and not any(
            _is_inside(points[corner], points[a], points[b], points[c]) for corner in ring if corner not in (a, b, c)
        ):
            triangles.append((a, b, c))
        if orientation == 0 or (triangles and triangles[-1] == (a, b, c)):
            ring.remove(b)
            tried_count = 0
        else:
            start, tried_count = start + 1, tried_count + 1
    return triangles


def within_polygon(points: NDArray[np.float64], corners: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return a mask of the points that are inside a polygon.

    The even-odd rule counts the edges that a ray from the point crosses.

    Args:
        points: shape (..., 2).
        corners: shape (corners, 2), in the same frame; the last is joined to the first.

    Returns:
        Shape (...).
    """
    import numpy as np  # Readers of descriptions triangulate polygons without numpy.

    x, y = points[..., 0], points[..., 1]
    is_inside = np.zeros(x.shape, np.bool_)
    for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if y0 != y1:
            is_inside ^= ((y0 > y) != (y1 > y)) & (x < (x1 - x0) * (y - y0) / (y1 - y0) + x0)
    return is_inside


def _twice_area(points: Sequence[Point], ring: Sequence[int]) -> float:
    return sum(
        points[a][0] * points[b][1] - points[b][0] * points[a][1]
        for a, b in zip(ring, [*ring[1:], *ring[:1]], strict=True)
    )


def signed_double_area(a: Point, b: Point, c: Point) -> float:
    """Return twice the area of a triangle, positive if its corners are counterclockwise."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _is_inside(point: Point, a: Point, b: Point, c: Point) -> bool:
    return (
        signed_double_area(a, b, point) >= 0
        and signed_double_area(b, c, point) >= 0
        and signed_double_area(c, a, point) >= 0
    )
