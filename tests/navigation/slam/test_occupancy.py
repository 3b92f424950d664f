"""The occupancy grid of known scans."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.navigation.grids.grid import FREE, OCCUPIED, UNKNOWN
from linkwright.navigation.slam.occupancy import OccupancyMap
from linkwright.navigation.slam.scan import PlanarScan
from tests.navigation.slam.scenes import flat_walls, make_scan


def make_ray(*points, passed=()):
    return PlanarScan(np.array(points).reshape(-1, 2), np.array(passed).reshape(-1, 2), np.zeros(2), 0)


def test_cell_is_known_after_minimum_number_of_rays():
    occupancy = OccupancyMap(1.0)
    pose = np.array([0.5, 0.5, 0.0])
    for number in range(3):
        assert occupancy.grid() is None or (occupancy.grid().cells == UNKNOWN).all()
        occupancy.draw(number, make_ray((3.0, 0.0)), pose)
    grid = occupancy.grid()
    assert grid.cells.tolist() == [[FREE, FREE, FREE, OCCUPIED]]
    assert (grid.x, grid.y, grid.resolution) == (0.0, 0.0, 1.0)


def test_cell_that_most_rays_pass_is_free():
    occupancy = OccupancyMap(1.0)
    pose = np.array([0.5, 0.5, 0.0])
    for number in range(9):
        occupancy.draw(number, make_ray((3.0, 0.0)), pose)
    occupancy.draw(9, make_ray((1.0, 0.0)), pose)
    assert occupancy.grid().cells.tolist() == [[FREE, FREE, FREE, OCCUPIED]]  # a ratio of 1 to 10 is not more than 0.1
    occupancy.draw(10, make_ray((1.0, 0.0)), pose)
    assert occupancy.grid().cells.tolist() == [[FREE, OCCUPIED, FREE, OCCUPIED]]


def test_truncated_ray_frees_cells_and_marks_no_end():
    occupancy = OccupancyMap(1.0, min_pass_through=0)
    occupancy.draw(0, make_ray(passed=(0.0, -3.0)), np.array([0.5, 0.5, 0.0]))
    assert occupancy.grid().cells.tolist() == [[FREE]] * 4
    assert occupancy.grid().y == -3.0


def test_redrawn_scan_leaves_no_trace_at_old_pose():
    rng = np.random.default_rng(0)
    walls, redrawn_map = flat_walls(), OccupancyMap(0.05)
    poses = np.array([[-4.0, -3.0, 0.1], [4.0, -3.0, 1.0], [4.0, 3.0, 2.0]])
    scans = [make_scan(walls, pose, rng=rng) for pose in poses]
    for number, scan in enumerate(scans):
        redrawn_map.draw(number, scan, poses[number] + (0.4, -0.3, 0.2))
    for number in (1, 0, 2):
        redrawn_map.draw(number, scans[number], poses[number])
    expected_map = OccupancyMap(0.05)
    for number, scan in enumerate(scans):
        expected_map.draw(number, scan, poses[number])
    assert (redrawn_map.grid().cells == expected_map.grid().cells).all()
    assert (redrawn_map.grid().x, redrawn_map.grid().y) == (expected_map.grid().x, expected_map.grid().y)
    for number in range(3):
        redrawn_map.erase(number)
    assert redrawn_map.grid() is None
    assert redrawn_map.get_drawn_pose(0) is None


def test_map_matches_apartment():
    walls, occupancy = flat_walls(), OccupancyMap(0.05)
    poses = [(-4, -3), (0, -3), (4, -3), (4, 0), (4, 3), (0, 3), (-4, 3), (-4, 0), (-3.2, -3.4), (3.4, 3.4)]
    for number, (x, y) in enumerate(poses):
        pose = np.array([x, y, 0.3 * number])
        occupancy.draw(number, make_scan(walls, pose, count=720), pose)
    grid = occupancy.grid()
    occupied_centers = grid.centers_of(np.argwhere(grid.cells == OCCUPIED))
    start, directions = walls[:, 0], walls[:, 1] - walls[:, 0]
    offsets = occupied_centers[:, None] - start
    share = np.clip((offsets * directions).sum(axis=2) / (directions**2).sum(axis=1), 0, 1)
    distances = np.linalg.norm(offsets - share[..., None] * directions, axis=2).min(axis=1)
    assert len(occupied_centers) > 500
    assert distances.max() < 0.05 * 0.7072  # half the diagonal of a cell
    free = grid.cells == FREE
    assert free.sum() * 0.05**2 == pytest.approx(12 * 9 - 5 * 3.4, rel=0.1)
