"""Scan matching at known poses."""

from __future__ import annotations

from itertools import product
from math import inf

import numpy as np
import pytest

from linkwright.navigation.slam.contradiction import compute_contradiction_share
from linkwright.navigation.slam.matching import match_scan
from linkwright.navigation.slam.poses import compose, relative_pose
from linkwright.navigation.slam.reference import LikelihoodField, Reference
from linkwright.navigation.slam.scan import PlanarScan
from linkwright.navigation.slam.search import Search, find_best_pose
from linkwright.navigation.slam.steps import run_to_end
from tests.navigation.slam.scenes import box_walls, flat_walls, make_scan

FLAT_WALLS = flat_walls()
WIDE_SEARCH = Search(
    dimension=8.0, resolution=0.05, smear_deviation=0.03, distance_variance_penalty=inf, angle_variance_penalty=inf
)


@pytest.fixture(scope="module")
def reference():
    rng = np.random.default_rng(3)
    poses = np.array([[-4.0 + 0.4 * step, -3.0, 0.02 * step] for step in range(10)])
    return Reference([make_scan(FLAT_WALLS, pose, rng=rng) for pose in poses], poses)


@pytest.mark.parametrize(
    "offset", [(0, 0, 0), (0.2, -0.2, 0.3), (-0.24, 0.1, -0.3), (0.05, 0.24, 0.1), (0.0, -0.1, -0.34)]
)
def test_scan_is_matched_within_millimeters(reference, offset):
    true_pose = np.array([-1.8, -2.9, 0.4])
    scan = make_scan(FLAT_WALLS, true_pose, rng=np.random.default_rng(5))
    match = run_to_end(match_scan(reference, scan, true_pose + offset, Search()))
    error = relative_pose(true_pose, match.pose)
    assert np.hypot(error[0], error[1]) < 0.005
    assert abs(error[2]) < 0.002
    assert match.response > 0.7
    assert match.inliers > 0.8
    deviations = np.sqrt(np.diag(np.linalg.inv(match.information)))
    assert (np.abs(error) < 4 * deviations).all()
    assert deviations.max() < 0.02


def test_loop_search_corrects_error_of_meters(reference):
    true_pose = np.array([-1.8, -2.9, 0.4])
    scan = make_scan(FLAT_WALLS, true_pose, rng=np.random.default_rng(6))
    match = run_to_end(match_scan(reference, scan, true_pose + np.array([1.9, 1.2, -0.3]), WIDE_SEARCH))
    assert relative_pose(true_pose, match.pose) == pytest.approx([0, 0, 0], abs=0.006)


def test_branch_and_bound_matches_exhaustive_search(reference):
    scan = make_scan(FLAT_WALLS, np.array([-2.0, -3.1, 0.2]), count=60)
    search = Search(dimension=0.6, resolution=0.05, smear_deviation=0.1, angle_offset=0.2, angle_resolution=0.02)
    initial_pose = np.array([-1.9, -3.0, 0.1])
    likelihood = LikelihoodField(reference.points, search.cell, search.smear_deviation)
    pose, response = run_to_end(find_best_pose(likelihood, scan.points, initial_pose, search))
    grid, _ = likelihood.get_level(0)
    step = min(search.angle_resolution, 1.5 * 0.05 / np.quantile(np.hypot(*scan.points.T), 0.8))
    count = int(np.ceil(search.angle_offset / step - 1e-9))
    best_score = 0.0
    for angle_index, row, column in product(range(-count, count + 1), range(-6, 7), range(-6, 7)):
        yaw = initial_pose[2] + angle_index * step
        x = np.cos(yaw) * scan.points[:, 0] - np.sin(yaw) * scan.points[:, 1] + initial_pose[0] - likelihood.corner[0]
        y = np.sin(yaw) * scan.points[:, 0] + np.cos(yaw) * scan.points[:, 1] + initial_pose[1] - likelihood.corner[1]
        cells = np.floor(np.stack((y, x)) / search.cell).astype(int) + np.array([[row], [column]])
        is_inside = (cells >= 0).all(axis=0) & (cells[0] < grid.shape[0]) & (cells[1] < grid.shape[1])
        score = np.where(is_inside, grid[np.where(is_inside, cells[0], 0), np.where(is_inside, cells[1], 0)], 0).mean()
        distance = max(1 - 0.2 * (row**2 + column**2) * 0.05**2 / 0.5, 0.5)
        best_score = max(best_score, score * distance * max(1 - 0.2 * (angle_index * step) ** 2, 0.9))
    assert response == pytest.approx(best_score, abs=1e-6)
    assert np.abs(relative_pose(np.array([-2.0, -3.1, 0.2]), pose))[:2].max() < 0.05


def test_match_in_corridor_keeps_odometry_along_it():
    walls = np.array([[(-50, -1), (50, -1)], [(-50, 1), (50, 1)]], dtype=float)
    rng = np.random.default_rng(2)
    poses = np.array([[0.2 * step, 0.0, 0.0] for step in range(5)])
    reference = Reference([make_scan(walls, pose, rng=rng, farthest=6) for pose in poses], poses)
    true_pose, initial_pose = np.array([1.3, 0.1, 0.05]), np.array([1.1, 0.0, 0.0])
    match = run_to_end(match_scan(reference, make_scan(walls, true_pose, rng=rng, farthest=6), initial_pose, Search()))
    assert match.pose[0] == pytest.approx(initial_pose[0], abs=0.01)
    assert match.pose[1:] == pytest.approx(true_pose[1:], abs=0.005)
    assert match.information[0, 0] < 1e-2 * match.information[1, 1]


def test_empty_scan_is_not_matched(reference):
    empty_scan = PlanarScan(np.zeros((3, 2)), np.zeros((0, 2)), np.zeros(2), 0)
    assert run_to_end(match_scan(reference, empty_scan, np.zeros(3), Search())) is None
    empty = Reference([empty_scan], np.zeros((1, 3)))
    assert (
        run_to_end(match_scan(empty, make_scan(FLAT_WALLS, np.array([-4.0, -3.0, 0.0])), np.zeros(3), Search())) is None
    )


def test_other_side_of_thin_wall_does_not_shift_match():
    thin_wall, room = box_walls(0, 1.05, 6, 0.1), box_walls(0, 1, 8, 7)
    walls = np.array([*thin_wall, *room], dtype=float)
    poses = np.array([[-0.5, 2.0, 0.0], [0.5, 2.0, 0.0]])  # from above the wall
    reference = Reference([make_scan(walls, pose) for pose in poses], poses)
    scan = make_scan(walls, np.array([0.0, 0.0, 0.0]))  # from below it
    match = run_to_end(match_scan(reference, scan, np.zeros(3), Search(dimension=0.2)))
    assert match.pose == pytest.approx([0, 0, 0], abs=0.01)


def test_rotated_scan_is_found_with_larger_angle_search(reference):
    search = Search(dimension=0.1, angle_offset=0.01, smear_deviation=0.02)
    true_pose = np.array([-1.8, -2.9, 0.0])
    rotated_scan = PlanarScan(
        compose(np.array([100.0, 0, 0]), np.zeros(3))[None, :2].repeat(20, 0), np.zeros((0, 2)), np.zeros(2), 0
    )
    assert run_to_end(match_scan(reference, rotated_scan, true_pose, search, expand=True)).response == 0
    assert (
        run_to_end(match_scan(reference, make_scan(FLAT_WALLS, true_pose), true_pose, search, expand=True)).response
        > 0.5
    )


def test_contradiction_share_separates_scans_of_different_rooms():
    pose, near_pose = np.array([-4.0, -3.0, 0.3]), np.array([-3.2, -2.8, 1.0])
    first, second = make_scan(FLAT_WALLS, pose), make_scan(FLAT_WALLS, near_pose)
    assert compute_contradiction_share(first, pose, second, near_pose) < 0.05
    other_scan = make_scan(FLAT_WALLS, np.array([4.5, 0.0, 0.0]))
    assert compute_contradiction_share(first, pose, other_scan, near_pose) > 0.2
