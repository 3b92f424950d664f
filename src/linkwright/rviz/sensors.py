"""Conversion of the lidars and cameras of a world to the page's form."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

from linkwright.geometry.single import Transform, compose
from linkwright.page.protocol.worlds import CameraScene, LidarScene, RayAngles
from linkwright.sdf.cameras import Camera
from linkwright.sdf.frames import FrameError, PlacedLink, placed_links, transform_of
from linkwright.sdf.optics import optics_of
from linkwright.sdf.poses import SEPARATOR
from linkwright.sdf.sensors import Lidar, Sensor
from linkwright.sdf.worlds import World

_MOST_ROWS = 16
_MOST_RAYS = 720
"""The largest number of rays of a lidar that pages draw."""
_FARTHEST = 10_000.0
"""The largest far distance of a camera that is drawn, in m."""
_ENDLESS = 30.0
"""The length of a lidar's rays that are drawn if it has no range, in m."""


@dataclass(frozen=True, slots=True)
class ShownLidar:
    """A lidar in the page's form, and how its measurements are reduced for drawing.

    Attributes:
        scene: the description of the lidar for pages.
        measured: the number of rows and of columns that the lidar measures.
        every: the step between drawn rows, and between drawn columns.
    """

    scene: LidarScene
    measured: tuple[int, int]
    every: tuple[int, int]


def sensors_of(world: World) -> tuple[list[ShownLidar], list[CameraScene]]:
    """Return the lidars and the cameras of a world, in file order.

    Both lists are empty if the pose of any link or sensor is unknown.

    Args:
        world: the world, with its includes resolved.
    """
    lidars: list[ShownLidar] = []
    cameras: list[CameraScene] = []
    try:
        links = list(placed_links(world))
        for placed in links:
            for sensor in placed.link.sensors:
                pose = placed.frames.in_link(sensor.pose, placed.link.name)
                if sensor.lidar is not None:
                    lidars.append(_lidar(placed, sensor, sensor.lidar, pose))
                cameras.extend(_camera(placed, sensor, camera, pose) for camera in sensor.cameras)
    except FrameError:
        return [], []
    return lidars, cameras


def _lidar(placed: PlacedLink, sensor: Sensor, lidar: Lidar, pose: Transform) -> ShownLidar:
    across, up = lidar.horizontal, lidar.vertical
    row_step = ceil(up.count / _MOST_ROWS)
    rows = ceil(up.count / row_step)
    column_step = ceil(rows * across.count / _MOST_RAYS)
    columns = ceil(across.count / column_step)
    nearest = max(lidar.range.min, 0.0)
    scene = LidarScene(
        name=f"{placed.name}{SEPARATOR}{sensor.name}",
        link=placed.name,
        position=list(pose[:3]),
        quaternion=list(pose[3:]),
        visualized=sensor.visualize,
        horizontal=RayAngles(across.min_angle, across.step * column_step, columns),
        vertical=RayAngles(up.min_angle, up.step * row_step, rows),
        nearest=nearest,
        farthest=lidar.range.max if nearest < lidar.range.max < float("inf") else nearest + _ENDLESS,
    )
    return ShownLidar(scene, (up.count, across.count), (row_step, column_step))


def _camera(placed: PlacedLink, sensor: Sensor, camera: Camera, pose: Transform) -> CameraScene:
    optics = optics_of(camera)
    place = compose(pose, transform_of(camera.pose.pose))
    return CameraScene(
        name=SEPARATOR.join(filter(None, (placed.name, sensor.name, camera.name))),
        link=placed.name,
        position=list(place[:3]),
        quaternion=list(place[3:]),
        visualized=sensor.visualize,
        left=optics.cx / optics.fx,
        right=(optics.width - optics.cx) / optics.fx,
        up=optics.cy / optics.fy,
        down=(optics.height - optics.cy) / optics.fy,
        near=optics.near,
        far=min(optics.far, _FARTHEST),
    )
