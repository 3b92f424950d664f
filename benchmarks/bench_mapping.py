"""Measure mapping of a house: the errors of poses and walls, and the cost of a scan.

Run it with ``python -m benchmarks mapping``. mbot drives through all rooms in lockstep with the mapper, along the tour
of ``tests/navigation/nodes/house.py``. Odometry has a scale error, a rotation in proportion to the distance, and noise.
The peer "odometry" is the final pose by odometry alone. Costs are processor times of this thread.
"""

from __future__ import annotations

import os
import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from tests.navigation.nodes import house

from benchmarks.measure import Row
from linkwright.geometry.single import rpy_from_quaternion
from linkwright.navigation.nodes.slam_toolbox.nodes import AsyncSlamToolbox
from linkwright.navigation.slam.poses import compose, relative_pose
from linkwright.nodes import NodeOptions

ODOMETRY_QUALITIES = {
    "exact": (1.0, 0.0, 0.0),
    "2 %, 0.01 rad/m": (1.02, 0.01, 0.02),
    "5 %, 0.05 rad/m": (1.05, 0.05, 0.1),
    "10 %, 0.1 rad/m": (1.1, 0.1, 0.2),
    "-10 %, -0.15 rad/m": (0.9, -0.15, 0.3),
}
"""Maps a name to the scale, the radians per meter and the noise of `house.Drift`."""


@dataclass
class _Tour:
    """The result of a tour.

    Errors are in m and rad, times in s for each step of the mapper and each scan.
    """

    odometry_error: float
    pose_error: float
    yaw_error: float
    wall_errors: np.ndarray
    step_s: list[float]
    scans: int


def map_house(scale: float, yaw_per_meter: float, noise: float) -> _Tour:
    """Drive through the house and map it, and return the result."""
    walls, solid = house.upright_faces(), house.upright_faces(("walls", "furniture"))
    steps: list[float] = []
    os.environ.pop("ROS_DISTRO", None)
    with house.make_house_simulation() as test:
        drift = house.Drift(test, scale, yaw_per_meter, noise=noise)
        options = NodeOptions(parameters={"use_sim_time": True}, remappings=[("/tf", "/drifting_tf")])
        node: Any = AsyncSlamToolbox(test.graph, options)
        toolbox = node._work[0]
        step = toolbox._step

        def timed() -> None:
            begun = time.thread_time()
            step()
            steps.append(time.thread_time() - begun)

        toolbox._step_guard.callback = timed
        house.drive_through(test, house.TOUR_POINTS)
        true_transform = test.robot_pose()
        true_pose = np.array((true_transform[0], true_transform[1], rpy_from_quaternion(true_transform[3:])[2]))
        pose_error = relative_pose(true_pose, compose(toolbox._map_to_odom, drift.pose))
        odometry = relative_pose(true_pose, drift.pose)
        occupied = house.occupied_centers(toolbox.grid())
        near = occupied[house.distances_to_faces(walls, occupied) < 0.2]
        return _Tour(
            float(np.hypot(odometry[0], odometry[1])),
            float(np.hypot(pose_error[0], pose_error[1])),
            abs(float(pose_error[2])),
            house.distances_to_faces(solid, near),
            steps,
            len(toolbox.mapper.scans),
        )


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    table = []
    for name, quality in ODOMETRY_QUALITIES.items():
        tour = map_house(*quality)
        about = f"odometry {name}"
        table += [
            Row(
                f"{about}: pose off at the end",
                100 * tour.pose_error,
                "cm",
                "",
                {"odometry": 100 * tour.odometry_error},
            ),
            Row(f"{about}: turned off at the end", float(np.degrees(tour.yaw_error)), "deg"),
            Row(f"{about}: walls off, mean", 100 * float(tour.wall_errors.mean()), "cm"),
            Row(f"{about}: walls off, most", 100 * float(tour.wall_errors.max()), "cm", "5"),
            Row(f"{about}: a scan", 1e3 * sum(tour.step_s) / tour.scans, "ms"),
            Row(f"{about}: longest step", 1e3 * max(tour.step_s), "ms", "20"),
        ]
    return table
