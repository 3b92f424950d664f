# SPDX-License-Identifier: Apache-2.0
"""Finds a cube of a color in a picture: where it lies on the table, and how it is turned."""

import numpy as np

FEWEST_PIXELS = 60
COLORS = {'red': 0, 'green': 1, 'blue': 2}


def find_pixels(picture, color):
    """Return the pixels of a color as rows (column, line).

    `picture` has the shape (lines, columns, 3), red, green, blue. A pixel counts if its color is twice as bright as the
    other two.
    """
    values = picture.astype(float)
    wanted = values[..., COLORS[color]]
    others = np.delete(values, COLORS[color], axis=2).max(axis=2)
    lines, columns = np.nonzero((wanted > 40) & (wanted > 2.0 * others))
    return np.column_stack((columns, lines))


def to_table(pixels, matrix, position, rotation, height):
    """Return where the rays of pixels meet a plane z = height, as rows (x, y) in meters.

    `matrix` is k of the CameraInfo, shape (3, 3); `position` and `rotation` are those of the optical frame.
    """
    rays = np.column_stack((pixels, np.ones(len(pixels)))) @ np.linalg.inv(matrix).T @ rotation.T
    return (position + rays * ((height - position[2]) / rays[:, 2:]))[:, :2]


def find_square(points, camera, side):
    """Return the middle of the top of a cube, and its turn about z in radians, from 0 to a quarter turn.

    `points` are those of the top and of the sides that the camera sees; the rays of the sides meet the plane of the top
    between the cube and the camera. So the edges away from the camera, which is at `camera` (x, y), tell where a top
    with edges of the length `side` is. The turn is the one with the smallest rectangle around the points.
    """
    best = None
    for yaw in np.radians(np.arange(0, 90, 2)):
        axes = np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
        along = points @ axes.T
        low, high = np.percentile(along, 1, axis=0), np.percentile(along, 99, axis=0)
        area = float(np.prod(high - low))
        if best is None or area < best[0]:
            is_near_low = axes @ camera < (low + high) / 2
            best = area, np.where(is_near_low, high - side / 2, low + side / 2) @ axes, float(yaw)
    return best[1], best[2]
