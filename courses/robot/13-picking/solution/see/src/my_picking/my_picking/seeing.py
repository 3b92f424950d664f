import numpy as np

COLORS = {'red': 0, 'green': 1, 'blue': 2}


def find_pixels(picture, color):
    values = picture.astype(float)
    wanted = values[:, :, COLORS[color]]
    others = np.delete(values, COLORS[color], axis=2).max(axis=2)
    rows, columns = np.nonzero((wanted > 40) & (wanted > 2 * others))
    return np.column_stack((columns, rows))


def to_plane(pixels, k, position, rotation, height):
    rays = np.column_stack((pixels, np.ones(len(pixels)))) @ np.linalg.inv(k).T @ rotation.T
    lengths = (height - position[2]) / rays[:, 2]
    return position[:2] + rays[:, :2] * lengths[:, np.newaxis]


def find_square(points, camera, side):
    """Return the middle of the top of a cube, and its turn about z in rad.

    The camera also sees sides of the cube. They appear between the top and the camera,
    so only the edges away from the camera (x, y) are those of the top.
    """
    best = None
    for yaw in np.radians(np.arange(0, 90, 2)):
        axes = np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
        along = points @ axes.T
        low, high = np.percentile(along, 1, axis=0), np.percentile(along, 99, axis=0)
        area = np.prod(high - low)
        if best is None or area < best[0]:
            near_low = axes @ camera < (low + high) / 2
            middle = np.where(near_low, high - side / 2, low + side / 2)
            best = area, middle @ axes, float(yaw)
    return best[1], best[2]
