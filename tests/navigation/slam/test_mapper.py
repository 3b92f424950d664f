"""Mapping of simulated flats with drifting odometry."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from linkwright.navigation.slam.mapper import Mapper
from linkwright.navigation.slam.occupancy import OccupancyMap
from linkwright.navigation.slam.poses import compose, relative_pose
from linkwright.navigation.slam.scan import PlanarScan
from linkwright.navigation.slam.settings import MapperSettings
from linkwright.navigation.slam.steps import run_to_end
from tests.navigation.slam.scenes import add_drift, box_walls, flat_walls, make_scan, path_along

HALF_SECOND_NS = 500_000_000
CORRIDOR_CORNERS = [(-4, -3), (4, -3), (4, 3), (-4, 3), (-4, -3), (1, -3)]
CORRIDOR_PATH = path_along(CORRIDOR_CORNERS, step=0.25, turn=0.25)


def map_path(walls, path, odometry, settings=None, farthest=12.0, count=180):
    """Map a path; return the mapper, the outcome of each scan, and the true poses of the scans."""
    mapper = Mapper(settings or MapperSettings(), OccupancyMap(0.05))
    rng = np.random.default_rng(9)
    outcomes, true_poses = [], []
    for number, (pose, text) in enumerate(zip(path, odometry, strict=True)):
        stamp_ns = number * HALF_SECOND_NS
        if mapper.should_process(text, stamp_ns):
            scan = make_scan(walls, pose, stamp_ns, rng, count, farthest)
            outcomes.append(run_to_end(mapper.process(scan, text)))
            true_poses.append(pose)
    return mapper, outcomes, np.array(true_poses)


def max_error(errors):
    return float(np.hypot(errors[:, 0], errors[:, 1]).max())


@pytest.mark.parametrize("yaw_per_meter", [0.0, 0.03, 0.08])
def test_apartment_is_mapped_despite_odometry_drift(yaw_per_meter):
    path = CORRIDOR_PATH
    odometry = add_drift(path, 1.03, yaw_per_meter, 0.02, np.random.default_rng(1))
    mapper, outcomes, true_poses = map_path(flat_walls(), path, odometry)
    errors = relative_pose(true_poses, mapper.graph.poses)
    assert max_error(errors) < 0.02
    assert np.abs(errors[:, 2]).max() < 0.004
    assert all(outcome.is_matched for outcome in outcomes[1:])
    assert outcomes[-1].pose == pytest.approx(mapper.graph.poses[-1])


def test_loop_is_closed_after_odometry_slip_in_corridor():
    walls = np.array(
        [wall for rectangle in (box_walls(0, 0, 18, 12), box_walls(0, 0, 13, 7)) for wall in rectangle], dtype=float
    )
    path = path_along([(-7, -4.8), (7.6, -4.8), (7.7, 4.8), (-7.7, 4.8), (-7.7, -4.8), (-4, -4.8)], step=0.2, turn=0.2)
    odometry = [path[0]]
    for old, new in pairwise(path):
        step = relative_pose(old, new)
        step[0] *= 1.1 if old[1] > 4.7 and abs(step[2]) < 0.01 else 1.0  # along the second long side
        odometry.append(compose(odometry[-1], step))
    odometry = np.array(odometry)
    _, without_closing, _ = map_path(walls, path, odometry, MapperSettings(do_loop_closing=False), farthest=4.0)
    mapper, outcomes, true_poses = map_path(
        walls, path, odometry, MapperSettings(loop_match_minimum_chain_size=5), farthest=4.0
    )
    assert sum(outcome.loop_count for outcome in outcomes) >= 1
    count = len(true_poses)
    first = int(np.argmin(np.hypot(*(true_poses[: count // 2] - true_poses[-1])[:, :2].T)))
    true = relative_pose(true_poses[first], true_poses[-1])
    result = relative_pose(mapper.graph.poses[first], mapper.graph.poses[-1])
    assert result == pytest.approx(true, abs=0.06)
    assert not any(outcome.loop_count for outcome in without_closing)
    assert max_error((without_closing[-1].pose - true_poses[-1])[None]) > 0.8


def test_scans_are_processed_after_travel_or_rotation():
    mapper = Mapper(MapperSettings(), OccupancyMap(0.05))
    pose = np.zeros(3)
    assert mapper.should_process(pose, 0)
    run_to_end(mapper.process(make_scan(flat_walls(), np.array([-4.0, -3.0, 0.0])), pose))
    second = 1_000_000_000
    assert not mapper.should_process(pose, 10 * second)
    assert not mapper.should_process(np.array([0.3, 0.0, 0.0]), second)
    assert mapper.should_process(np.array([0.5, 0.0, 0.0]), second)
    assert not mapper.should_process(np.array([0.5, 0.0, 0.0]), second // 10)
    assert mapper.should_process(np.array([0.0, 0.0, -0.6]), second)


def test_empty_world_follows_odometry_and_has_no_map():
    empty = PlanarScan(np.zeros((0, 2)), np.zeros((0, 2)), np.zeros(2), 0)
    mapper = Mapper(MapperSettings(), OccupancyMap(0.05))
    poses = np.array([[0.5 * step, 0.1 * step, 0.2 * step] for step in range(30)])
    for pose in poses:
        outcome = run_to_end(mapper.process(empty, pose))
        assert not outcome.is_matched
    assert relative_pose(poses, mapper.graph.poses) == pytest.approx(np.zeros((30, 3)), abs=1e-9)
    assert mapper.occupancy.grid() is None
    assert outcome.link_count == outcome.loop_count == 0


def test_poses_follow_odometry_without_scan_matching():
    path = path_along([(-4, -3), (4, -3), (4, 3)])
    odometry = add_drift(path, 1.05, 0.02)
    mapper, _, _ = map_path(flat_walls(), path, odometry, MapperSettings(use_scan_matching=False))
    assert mapper.graph.poses[-1] == pytest.approx(mapper.odometry[-1])


def test_robot_is_localized_in_fixed_map():
    mapper, _, _ = map_path(flat_walls(), CORRIDOR_PATH, CORRIDOR_PATH)
    count, walls = len(mapper.scans), flat_walls()
    mapper.begin_session(np.array([3.2, -2.2, 1.3]))
    path = path_along([(4, -3), (4, 3), (-4, 3)])
    odometry = add_drift(relative_pose(path[0], path), 1.05, 0.05)
    rng = np.random.default_rng(4)
    for number, (pose, text) in enumerate(zip(path, odometry, strict=True)):
        if mapper.should_process(text, number * HALF_SECOND_NS):
            outcome = run_to_end(mapper.localize(make_scan(walls, pose, number * HALF_SECOND_NS, rng, 180), text))
            assert outcome.is_matched
            assert relative_pose(pose, outcome.pose) == pytest.approx([0, 0, 0], abs=0.03)
    assert len(mapper.scans) == count


def test_second_session_continues_map():
    walls = flat_walls()
    mapper, _, _ = map_path(walls, path_along(CORRIDOR_CORNERS[:3]), path_along(CORRIDOR_CORNERS[:3]))
    count = len(mapper.scans)
    mapper.begin_session(np.array([3.8, 2.2, 1.8]))
    path = path_along([(4, 2.5), (4, 3), (-4, 3), (-4, -3)])
    odometry = add_drift(relative_pose(path[0], path), 1.02, 0.03)
    rng = np.random.default_rng(4)
    true_poses = []
    for number, (pose, text) in enumerate(zip(path, odometry, strict=True)):
        if mapper.should_process(text, number * HALF_SECOND_NS):
            run_to_end(mapper.process(make_scan(walls, pose, number * HALF_SECOND_NS, rng, 180), text))
            true_poses.append(pose)
    assert max_error(relative_pose(np.array(true_poses), mapper.graph.poses[count:])) < 0.03
