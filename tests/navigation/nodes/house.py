"""mbot with its laser in the house, and a path through all rooms.

Functions compute the distances between a map and the house.
"""

from __future__ import annotations

from itertools import pairwise
from math import atan2, cos, hypot, pi, sin
from typing import Any

import numpy as np

from linkwright.geometry.single import quaternion_from_rpy, rpy_from_quaternion
from linkwright.graph import TF_QOS
from linkwright.messages import TFMessage, TransformBatch
from linkwright.navigation.grids.grid import FREE, OCCUPIED, Grid
from linkwright.navigation.slam.poses import compose, relative_pose
from linkwright.testing import SteppedSimulation
from linkwright.testing.scenes import read_world
from tests.places import GAZEBO_PACKAGE, PACKAGE

HOUSE = GAZEBO_PACKAGE / "worlds" / "house.world"
MBOT = PACKAGE / "urdf" / "mbot_gazebo.xacro"
START_POSE = (0.0, 0.0, 0.0)
TOUR_POINTS = [
    (-2.0, 0.0), (-2.0, 1.9), (-2.8, 1.7), (-2.0, 1.7), (-2.0, -0.2), (-3.6, -0.1), (-2.2, -0.8), (-2.2, -2.9),
    (-0.2, -2.6), (0.6, -1.7), (2.3, -1.7), (3.4, -0.6), (3.6, -1.6), (2.2, -1.7), (0.6, -1.7), (0.0, 0.2), (0.0, 2.5),
    (2.4, 2.4), (1.8, 2.5), (0.0, 2.5), (0.0, -0.1), (-1.5, -0.2),
]  # fmt: skip
"""A path through living room, bedroom, living room, kitchen, hall and bath, and back, in the frame of the house."""


def make_house_simulation(**options: Any) -> SteppedSimulation:
    """Return a simulation of the house with mbot at `START_POSE`."""
    return SteppedSimulation(
        HOUSE,
        MBOT,
        arguments={"laser": "true"},
        pose=(*START_POSE[:2], 0, 0, 0, START_POSE[2]),
        robot_state_publisher=True,
        **options,
    )


def drive_through(test: SteppedSimulation, corners: list[tuple[float, float]], speed: float = 0.7) -> None:
    """Drive from corner to corner by the robot's true pose."""
    for x, y in corners:
        while True:
            pose = test.robot_pose()
            distance = hypot(x - pose[0], y - pose[1])
            if distance < 0.12:
                break
            bearing = (atan2(y - pose[1], x - pose[0]) - rpy_from_quaternion(pose[3:])[2] + pi) % (2 * pi) - pi
            forward_speed = min(speed, 1.5 * distance) * max(0.0, cos(bearing)) ** 3
            test.drive(forward_speed if abs(bearing) < 1.0 else 0.0, max(-1.5, min(1.5, 2.5 * bearing)))
            test.advance(0.1)
    test.drive(0.0)
    test.advance(0.5)


class Drift:
    """Republish the robot's pose in odom with the errors of bad odometry.

    The poses of ``/tf`` are published on ``/drifting_tf``.

    Args:
        test: the simulation.
        scale: the factor of distances.
        yaw_per_meter: the yaw error per meter, in radians.
        yaw_scale: the factor of rotations.
        noise: the standard deviation of random errors, relative to distance and rotation.
    """

    def __init__(
        self, test: SteppedSimulation, scale: float, yaw_per_meter: float, yaw_scale: float = 1.0, noise: float = 0.0
    ) -> None:
        self._scale, self._yaw_per_meter, self._yaw_scale, self._noise = scale, yaw_per_meter, yaw_scale, noise
        self._rng = np.random.default_rng(11)
        self._last_pose: np.ndarray | None = None
        self.pose = np.zeros(3)
        node = test.graph.create_node("drift")
        self._publisher = node.create_publisher(TFMessage, "/drifting_tf", TF_QOS)
        node.create_subscription(TFMessage, "/tf", self._on_transforms, TF_QOS)

    def _on_transforms(self, message: TFMessage) -> None:
        for transform in message.transforms:
            if transform.child_frame_id == "base_footprint":
                translation, rotation = transform.transform.translation, transform.transform.rotation
                yaw = rpy_from_quaternion((rotation.x, rotation.y, rotation.z, rotation.w))[2]
                self._move(np.array((translation.x, translation.y, yaw)))
                pose = (self.pose[0], self.pose[1], 0.0, *quaternion_from_rpy((0.0, 0.0, float(self.pose[2]))))
                stamp_ns = transform.header.stamp.nanoseconds
                batch = TransformBatch(("odom",), ("base_footprint",), stamp_ns, np.array([pose]))
                self._publisher.publish(TFMessage(batch=batch))

    def _move(self, pose: np.ndarray) -> None:
        if self._last_pose is not None:
            step = relative_pose(self._last_pose, pose)
            length = hypot(step[0], step[1])
            step *= (self._scale, self._scale, self._yaw_scale)
            step[2] += self._yaw_per_meter * length
            # A random walk: the error per second does not depend on the rate of the transforms.
            spread = self._noise * np.sqrt((length + abs(step[2])) * 0.1)
            step += self._rng.normal(0, 1, 3) * spread
            self.pose = compose(self.pose, step)
        self._last_pose = pose


def upright_faces(models: tuple[str, ...] = ("walls",), height: float = 0.2) -> np.ndarray:
    """Return the upright faces of some models' boxes at a height, shape (n, 2, 2).

    Each face goes from right to left, as seen from outside.
    """
    segments = []
    for model in read_world(str(HOUSE)).world.models:
        for link in model.links if model.name in models else ():
            for collision in link.collisions:
                size: tuple[float, ...] = getattr(collision.geometry, "size", ())
                (x, y, z), yaw = collision.pose.pose.xyz, collision.pose.pose.rpy[2]
                if len(size) != 3 or abs(z - height) > size[2] / 2:
                    continue
                half_size = np.array(size[:2]) / 2
                corners = [
                    (-half_size[0], -half_size[1]),
                    (half_size[0], -half_size[1]),
                    (half_size[0], half_size[1]),
                    (-half_size[0], half_size[1]),
                ]
                corners = [(x + a * cos(yaw) - b * sin(yaw), y + a * sin(yaw) + b * cos(yaw)) for a, b in corners]
                segments += list(pairwise([*corners, corners[0]]))
    return np.array(segments)


def distances_to_faces(faces: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return the distance of points (n, 2) from the nearest face in meters, shape (n,)."""
    start, directions = faces[:, 0], faces[:, 1] - faces[:, 0]
    offsets = points[:, None] - start
    share = np.clip((offsets * directions).sum(axis=2) / (directions**2).sum(axis=1), 0, 1)
    nearest: np.ndarray = np.linalg.norm(offsets - share[..., None] * directions, axis=2).min(axis=1)
    return nearest


def visible_points(faces: np.ndarray, grid: Grid) -> np.ndarray:
    """Return points on faces, every 5 cm; shape (n, 2).

    In front of each point, the map is free for 20 cm.
    """
    points = []
    for start, end in faces:
        length = float(np.hypot(*(end - start)))
        direction = (end - start) / length
        points_along_face = start + np.linspace(0.02, length - 0.02, max(2, round(length / 0.05)))[:, None] * direction
        is_free = np.ones(len(points_along_face), dtype=bool)
        for distance in (0.1, 0.2):
            cells = grid.cells_of(points_along_face + distance * np.array((direction[1], -direction[0])))
            is_free &= grid.contains(cells)
            is_free[is_free] = grid.cells[tuple(cells[is_free].T)] == FREE
        points.append(points_along_face[is_free])
    return np.concatenate(points)


def occupied_centers(grid: Grid) -> np.ndarray:
    """Return the centers of occupied cells, shape (n, 2)."""
    return grid.centers_of(np.argwhere(grid.cells == OCCUPIED))


def distances_to_occupied_cells(grid: Grid, points: np.ndarray) -> np.ndarray:
    """Return the distance of each point (n, 2) from the nearest occupied cell.

    The distances are in meters, shape (n,).
    """
    occupied = occupied_centers(grid)
    return np.array([np.hypot(*(occupied - point).T).min() for point in points])
