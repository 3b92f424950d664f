"""Mapping of the house during a drive with bad odometry."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.geometry.single import rpy_from_quaternion
from linkwright.messages import get_service
from linkwright.navigation.grids.occupancy import grid_from_message
from linkwright.navigation.nodes.cartographer.nodes import CartographerNode
from linkwright.navigation.nodes.cartographer.occupancy_grid import OccupancyGridNode
from linkwright.navigation.nodes.slam_toolbox.nodes import AsyncSlamToolbox
from linkwright.navigation.slam.poses import compose, relative_pose
from linkwright.nodes import NodeOptions
from tests.navigation.nodes.house import (
    TOUR_POINTS,
    Drift,
    distances_to_faces,
    distances_to_occupied_cells,
    drive_through,
    make_house_simulation,
    occupied_centers,
    upright_faces,
    visible_points,
)
from tests.navigation.nodes.test_cartographer import CONFIGURATION

CELL_SIZE_M = 0.05


@pytest.mark.slow
def test_house_walls_are_mapped_within_5_cm_and_loop_is_closed(monkeypatch):
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    walls, solid = upright_faces(), upright_faces(("walls", "furniture"))
    with make_house_simulation() as test:
        drift = Drift(test, scale=1.03, yaw_per_meter=0.03, noise=0.05)
        options = NodeOptions(parameters={"use_sim_time": True}, remappings=[("/tf", "/drifting_tf")])
        mapper = AsyncSlamToolbox(test.graph, options)
        transforms = test.record("/drifting_tf")
        drive_through(test, TOUR_POINTS)
        grid = grid_from_message(
            test.call("/slam_toolbox/dynamic_map", get_service("nav_msgs/srv/GetMap").Request()).map
        )
        pose = test.robot_pose()
        true_pose = np.array((pose[0], pose[1], rpy_from_quaternion(pose[3:])[2]))
        correction = [
            transform
            for message in transforms
            for transform in message.transforms
            if transform.header.frame_id == "map"
        ][-1]
        mapper.close()
    # The loop is closed: odometry ends a meter from the robot's true position, and the corrected pose does not.
    translation, rotation = correction.transform.translation, correction.transform.rotation
    yaw = rpy_from_quaternion((rotation.x, rotation.y, rotation.z, rotation.w))[2]
    assert np.hypot(*relative_pose(true_pose, drift.pose)[:2]) > 0.8
    error = relative_pose(true_pose, compose(np.array((translation.x, translation.y, yaw)), drift.pose))
    assert np.hypot(error[0], error[1]) < 0.05
    assert abs(error[2]) < 0.02
    # Occupied cells near walls are on the walls, and the visible parts of walls are occupied.
    occupied = occupied_centers(grid)
    near_walls = occupied[distances_to_faces(walls, occupied) < 0.2]
    assert len(near_walls) > 900
    assert distances_to_faces(solid, near_walls).max() < CELL_SIZE_M + 1e-4
    visible = visible_points(walls, grid)
    assert len(visible) > 800
    gap_sizes = distances_to_occupied_cells(grid, visible)
    assert np.quantile(gap_sizes, 0.99) < CELL_SIZE_M
    assert gap_sizes.max() < 3 * CELL_SIZE_M  # gaps are only at the edges of visible parts


@pytest.mark.slow
def test_house_is_mapped_by_cartographer_without_odometry(tmp_path):
    walls, solid = upright_faces(), upright_faces(("walls", "furniture"))
    (tmp_path / "robot.lua").write_text(f"{CONFIGURATION}\nreturn options\n")
    arguments = ["-configuration_directory", str(tmp_path), "-configuration_basename", "robot.lua"]
    with make_house_simulation() as test:
        test.advance(0.5)  # the robot stands while the first scans are measured
        options = NodeOptions(parameters={"use_sim_time": True}, remappings=[("/tf", "/carto_tf")], arguments=arguments)
        mapper = CartographerNode(test.graph, options)
        painter = OccupancyGridNode(test.graph, NodeOptions(parameters={"use_sim_time": True}))
        maps = test.record("/map")
        test.advance(0.5)
        drive_through(test, TOUR_POINTS[:12])
        test.advance(2.0)
        pose = test.robot_pose()
        true_pose = np.array((pose[0], pose[1], rpy_from_quaternion(pose[3:])[2]))
        estimate = mapper.mapping.find_pose(mapper.mapping.latest_scan.stamp_ns)
        mapper.close()
        painter.close()
    error = relative_pose(true_pose, estimate)
    assert np.hypot(error[0], error[1]) < 0.05
    assert abs(error[2]) < 0.02
    grid = grid_from_message(maps.last)
    occupied = occupied_centers(grid)
    near_walls = occupied[distances_to_faces(walls, occupied) < 0.2]
    assert len(near_walls) > 500
    assert np.quantile(distances_to_faces(solid, near_walls), 0.99) < CELL_SIZE_M + 1e-4
    gap_sizes = distances_to_occupied_cells(grid, visible_points(walls, grid))
    assert np.quantile(gap_sizes, 0.99) < 2 * CELL_SIZE_M
