"""mbot with its laser in our house, a path through all rooms, and how far a map is from the house."""

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
START = (0.0, 0.0, 0.0)
TOUR = [
    (-2.0, 0.0), (-2.0, 1.9), (-2.8, 1.7), (-2.0, 1.7), (-2.0, -0.2), (-3.6, -0.1), (-2.2, -0.8), (-2.2, -2.9),
    (-0.2, -2.6), (0.6, -1.7), (2.3, -1.7), (3.4, -0.6), (3.6, -1.6), (2.2, -1.7), (0.6, -1.7), (0.0, 0.2), (0.0, 2.5),
    (2.4, 2.4), (1.8, 2.5), (0.0, 2.5), (0.0, -0.1), (-1.5, -0.2),
]  # fmt: skip
"""Through living room, bedroom, living room, kitchen, hall, bath, and back, in the frame of the house."""


def simulation(**options: Any) -> SteppedSimulation:
    """The house with mbot at `START`."""
    return SteppedSimulation(
        HOUSE,
        MBOT,
        arguments={"laser": "true"},
        pose=(*START[:2], 0, 0, 0, START[2]),
        robot_state_publisher=True,
        **options,
    )


def drive(test: SteppedSimulation, corners: list[tuple[float, float]], speed: float = 0.7) -> None:
    """Drive from corner to corner, by where the robot really is."""
    for x, y in corners:
        while True:
            here = test.robot_pose()
            away = hypot(x - here[0], y - here[1])
            if away < 0.12:
                break
            turn = (atan2(y - here[1], x - here[0]) - rpy_from_quaternion(here[3:])[2] + pi) % (2 * pi) - pi
            ahead = min(speed, 1.5 * away) * max(0.0, cos(turn)) ** 3
            test.drive(ahead if abs(turn) < 1.0 else 0.0, max(-1.5, min(1.5, 2.5 * turn)))
            test.advance(0.1)
    test.drive(0.0)
    test.advance(0.5)


class Drift:
    """Sends what ``/tf`` says of the robot in odom on to ``/drifting_tf`` as bad odometry says it.

    Args:
        test: the world.
        scale: of the way.
        yaw_per_meter: by which it turns besides, radians.
        yaw_scale: of turns.
        noise: standard deviations of random errors, a part of way and turn.
    """

    def __init__(
        self, test: SteppedSimulation, scale: float, yaw_per_meter: float, yaw_scale: float = 1.0, noise: float = 0.0
    ) -> None:
        self._scale, self._yaw_per_meter, self._yaw_scale, self._noise = scale, yaw_per_meter, yaw_scale, noise
        self._rng = np.random.default_rng(11)
        self._before: np.ndarray | None = None
        self.pose = np.zeros(3)
        node = test.graph.create_node("drift")
        self._publisher = node.create_publisher(TFMessage, "/drifting_tf", TF_QOS)
        node.create_subscription(TFMessage, "/tf", self._hear, TF_QOS)

    def _hear(self, message: TFMessage) -> None:
        for transform in message.transforms:
            if transform.child_frame_id == "base_footprint":
                at, turned = transform.transform.translation, transform.transform.rotation
                yaw = rpy_from_quaternion((turned.x, turned.y, turned.z, turned.w))[2]
                self._move(np.array((at.x, at.y, yaw)))
                pose = (self.pose[0], self.pose[1], 0.0, *quaternion_from_rpy((0.0, 0.0, float(self.pose[2]))))
                stamp_ns = transform.header.stamp.nanoseconds
                batch = TransformBatch(("odom",), ("base_footprint",), stamp_ns, np.array([pose]))
                self._publisher.publish(TFMessage(batch=batch))

    def _move(self, pose: np.ndarray) -> None:
        if self._before is not None:
            step = relative_pose(self._before, pose)
            length = hypot(step[0], step[1])
            step *= (self._scale, self._scale, self._yaw_scale)
            step[2] += self._yaw_per_meter * length
            # A random walk: what a second of driving adds does not depend on how often it is told.
            spread = self._noise * np.sqrt((length + abs(step[2])) * 0.1)
            step += self._rng.normal(0, 1, 3) * spread
            self.pose = compose(self.pose, step)
        self._before = pose


def faces(models: tuple[str, ...] = ("walls",), height: float = 0.2) -> np.ndarray:
    """The upright faces of boxes of models of the house at a height, of shape (n, 2, 2): from right to left, seen."""
    segments = []
    for model in read_world(str(HOUSE)).world.models:
        for link in model.links if model.name in models else ():
            for collision in link.collisions:
                size: tuple[float, ...] = getattr(collision.geometry, "size", ())
                (x, y, z), yaw = collision.pose.pose.xyz, collision.pose.pose.rpy[2]
                if len(size) != 3 or abs(z - height) > size[2] / 2:
                    continue
                half = np.array(size[:2]) / 2
                corners = [(-half[0], -half[1]), (half[0], -half[1]), (half[0], half[1]), (-half[0], half[1])]
                corners = [(x + a * cos(yaw) - b * sin(yaw), y + a * sin(yaw) + b * cos(yaw)) for a, b in corners]
                segments += list(pairwise([*corners, corners[0]]))
    return np.array(segments)


def distances(faces: np.ndarray, points: np.ndarray) -> np.ndarray:
    """How far points (n, 2) are from the nearest face, of shape (n,), meters."""
    start, along = faces[:, 0], faces[:, 1] - faces[:, 0]
    away = points[:, None] - start
    part = np.clip((away * along).sum(axis=2) / (along**2).sum(axis=1), 0, 1)
    nearest: np.ndarray = np.linalg.norm(away - part[..., None] * along, axis=2).min(axis=1)
    return nearest


def seen_points(faces: np.ndarray, grid: Grid) -> np.ndarray:
    """Points of faces, every 5 cm, in front of which the map is free for 20 cm, of shape (n, 2)."""
    points = []
    for start, end in faces:
        length = float(np.hypot(*(end - start)))
        along = (end - start) / length
        row = start + np.linspace(0.02, length - 0.02, max(2, round(length / 0.05)))[:, None] * along
        free = np.ones(len(row), dtype=bool)
        for distance in (0.1, 0.2):
            cells = grid.cells_of(row + distance * np.array((along[1], -along[0])))
            free &= grid.contains(cells)
            free[free] = grid.cells[tuple(cells[free].T)] == FREE
        points.append(row[free])
    return np.concatenate(points)


def occupied_of(grid: Grid) -> np.ndarray:
    """The middles of occupied cells, of shape (n, 2)."""
    return grid.centers_of(np.argwhere(grid.cells == OCCUPIED))


def gaps(grid: Grid, points: np.ndarray) -> np.ndarray:
    """How far each point (n, 2) is from the nearest occupied cell, of shape (n,), meters."""
    occupied = occupied_of(grid)
    return np.array([np.hypot(*(occupied - point).T).min() for point in points])
