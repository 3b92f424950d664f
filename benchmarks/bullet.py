"""The same robots and boxes in Bullet through pybullet, with physics only."""

from __future__ import annotations

import ctypes
import os
import sys
import tempfile
import types
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from benchmarks import peers

_STEP_S = 0.001
_ROBOT_SPACING_M = 1.5
"""The distance between adjacent robots in meters."""
_WHEEL_JOINTS = ("left_wheel_joint", "right_wheel_joint")
_TORQUE_NM = 5.0


class BulletWorld:
    """A plane with robots at rest, and boxes of 0.25 m and 1 kg.

    By Bullet's default, bodies never sleep.

    Args:
        urdf: the robot's description, with shapes only.
        robots: the number of robots.
        boxes: the number of boxes.
    """

    def __init__(self, bullet: types.ModuleType, urdf: str, robots: int, boxes: int) -> None:
        self._bullet = bullet
        self._client = bullet.connect(bullet.DIRECT)
        bullet.setTimeStep(_STEP_S, self._client)
        bullet.setGravity(0, 0, -9.81, self._client)
        plane = bullet.createCollisionShape(bullet.GEOM_PLANE, physicsClientId=self._client)
        bullet.createMultiBody(0, plane, physicsClientId=self._client)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "robot.urdf"
            path.write_text(urdf, encoding="utf-8")
            for number in range(robots):
                self._add_robot(path, number)
        shape = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=[0.125] * 3, physicsClientId=self._client)
        for number in range(boxes):
            row, column = divmod(number, 40)
            bullet.createMultiBody(1, shape, -1, [row * 0.5, column * 0.5, 0.125], physicsClientId=self._client)

    def _add_robot(self, path: Path, number: int) -> None:
        bullet, client = self._bullet, self._client
        row, column = divmod(number, 10)
        robot = bullet.loadURDF(
            str(path), [row * _ROBOT_SPACING_M, column * _ROBOT_SPACING_M, 0.12], physicsClientId=client
        )
        for joint in range(bullet.getNumJoints(robot, client)):
            name = bullet.getJointInfo(robot, joint, client)[1].decode()
            force = _TORQUE_NM if name in _WHEEL_JOINTS else 0.0
            bullet.setJointMotorControl2(
                robot, joint, bullet.VELOCITY_CONTROL, targetVelocity=0, force=force, physicsClientId=client
            )

    def advance(self, steps: int) -> None:
        """Simulate a number of steps of 1 ms."""
        for _ in range(steps):
            self._bullet.stepSimulation(self._client)

    def close(self) -> None:
        """Release the world."""
        self._bullet.disconnect(self._client)


def make_bullet_world(urdf: str, robots: int, boxes: int) -> BulletWorld | None:
    """Return a world in Bullet, or None if pybullet is not installed."""
    with _suppress_output():
        bullet = peers.load_module("pybullet")
        return None if bullet is None else BulletWorld(bullet, urdf, robots, boxes)


@contextmanager
def _suppress_output() -> Iterator[None]:
    """Suppress Bullet's messages about links without mass, which bypass Python's streams."""
    sys.stdout.flush()
    saved_descriptors = [os.dup(number) for number in (1, 2)]
    with Path(os.devnull).open("w") as nothing:
        for number in (1, 2):
            os.dup2(nothing.fileno(), number)
    try:
        yield
    finally:
        ctypes.CDLL(None).fflush(None)
        for number, saved_descriptor in zip((1, 2), saved_descriptors, strict=True):
            os.dup2(saved_descriptor, number)
            os.close(saved_descriptor)
