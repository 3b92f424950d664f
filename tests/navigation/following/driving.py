"""A simulated robot that drives along a path in a costmap, without ROS.

It has exactly the commanded velocity.
"""

from __future__ import annotations

import itertools

import numpy as np

from linkwright.navigation.costmaps.costmap import LETHAL, Costmap
from linkwright.navigation.costmaps.footprints import make_circle
from linkwright.navigation.following.follower import ZERO_VELOCITY, ControlInput, predict_poses
from linkwright.navigation.following.path import FollowedPath
from linkwright.navigation.grids.grid import Grid

PERIOD_S = 0.05


def make_empty_floor(size=10.0, resolution=0.05):
    """Return an empty costmap around the origin."""
    cells = round(size / resolution)
    return Costmap(Grid(cells=np.zeros((cells, cells), np.uint8), resolution=resolution, x=-size / 2.0, y=-size / 2.0))


def put_box(costmap, x, y, width, depth, grow=0.0):
    """Mark a lethal box with its center at x, y, and inscribed cells around it up to `grow`."""
    grid = costmap.grid
    for margin, cost in ((grow, 253), (0.0, LETHAL)):
        corners = np.array(
            [[x - width / 2 - margin, y - depth / 2 - margin], [x + width / 2 + margin, y + depth / 2 + margin]]
        )
        (row, column), (last_row, last_column) = grid.cells_of(corners)
        grid.cells[row : last_row + 1, column : last_column + 1] = cost


def path_through(*points, spacing=0.05):
    """Return a path through some points; the headings follow the path."""
    segments = []
    for (x0, y0), (x1, y1) in itertools.pairwise(points):
        count = max(2, round(np.hypot(x1 - x0, y1 - y0) / spacing) + 1)
        heading = np.full(count, np.arctan2(y1 - y0, x1 - x0))
        segments.append(np.stack((np.linspace(x0, x1, count), np.linspace(y0, y1, count), heading), axis=-1))
    return np.concatenate(segments)


def control_input(path, pose=(0.0, 0.0, 0.0), velocity=ZERO_VELOCITY, costmap=None, footprint=None, xy_tolerance=0.25):
    return ControlInput(
        pose=pose,
        velocity=velocity,
        path=path,
        costmap=costmap or make_empty_floor(),
        footprint=make_circle(0.2) if footprint is None else footprint,
        period=PERIOD_S,
        xy_tolerance=xy_tolerance,
    )


def drive_along(follower, path, checker, *, pose=(0.0, 0.0, 0.0), costmap=None, cycles=2000, footprint=None):
    """Drive until the goal is reached, and return the poses and velocities of all cycles."""
    costmap = costmap or make_empty_floor()
    followed_path = FollowedPath(path, 2.0)
    velocity = ZERO_VELOCITY
    poses, velocities = [pose], [velocity]
    follower.reset()
    checker.reset()
    for _ in range(cycles):
        if checker.is_reached(pose, tuple(path[-1]), velocity):
            break
        followed_path.update_progress(pose[0], pose[1])
        cycle_input = control_input(
            followed_path.get_poses_ahead(3.0), pose, velocity, costmap, footprint, checker.xy_tolerance
        )
        velocity = follower.compute_velocity(cycle_input)
        pose = tuple(predict_poses(pose, np.array([velocity]), np.array([PERIOD_S]))[0, 0])
        poses.append(pose)
        velocities.append(velocity)
    return np.array(poses), np.array(velocities)
