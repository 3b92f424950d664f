"""Convert the lidars and cameras of a world to the page's form."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

from linkwright.geometry.single import Transform, compose
from linkwright.page.protocol.worlds import CameraScene, LidarScene, RayAngles
from linkwright.sdf.cameras import Camera
from linkwright.sdf.frames import FrameError, PlacedLink, placed_links, transform_of
from linkwright.sdf.optics import make_optics
from linkwright.sdf.poses import SEPARATOR
from linkwright.sdf.sensors import Lidar, Sensor
from linkwright.sdf.worlds import World

_MAX_ROWS = 16
_MAX_RAYS = 720
"""The largest number of rays that a page draws for one lidar."""
_MAX_FAR = 10_000.0
"""The largest distance of the far plane that a page draws for a camera, in m."""
_DEFAULT_RAY_LENGTH = 30.0
"""The length of the drawn rays of a lidar that has no finite maximum range, in m."""


@dataclass(frozen=True, slots=True)
class DisplayedLidar:
    """A lidar in the page's form, and the reduction of its measurements for drawing.

    Attributes:
        scene: the description of the lidar for pages.
        measured_shape: the number of rows and of columns that the lidar measures.
        strides: the step between drawn rows, and the step between drawn columns.
    """

    scene: LidarScene
    measured_shape: tuple[int, int]
    strides: tuple[int, int]


def convert_sensors(world: World) -> tuple[list[DisplayedLidar], list[CameraScene]]:
    """Return the lidars and the cameras of a world, in file order.

    Both lists are empty if the pose of any link or sensor is unknown.

    Args:
        world: the world, with its includes resolved.
    """
    lidars: list[DisplayedLidar] = []
    cameras: list[CameraScene] = []
    try:
        links = list(placed_links(world))
        for placed_link in links:
            for sensor in placed_link.link.sensors:
                pose = placed_link.frames.in_link(sensor.pose, placed_link.link.name)
                if sensor.lidar is not None:
                    lidars.append(_convert_lidar(placed_link, sensor, sensor.lidar, pose))
                cameras.extend(_convert_camera(placed_link, sensor, camera, pose) for camera in sensor.cameras)
    except FrameError:
        return [], []
    return lidars, cameras


def _convert_lidar(placed_link: PlacedLink, sensor: Sensor, lidar: Lidar, pose: Transform) -> DisplayedLidar:
    horizontal, vertical = lidar.horizontal, lidar.vertical
    row_step = ceil(vertical.count / _MAX_ROWS)
    rows = ceil(vertical.count / row_step)
    column_step = ceil(rows * horizontal.count / _MAX_RAYS)
    columns = ceil(horizontal.count / column_step)
    nearest = max(lidar.range.min, 0.0)
    scene = LidarScene(
        name=f"{placed_link.name}{SEPARATOR}{sensor.name}",
        link=placed_link.name,
        position=list(pose[:3]),
        quaternion=list(pose[3:]),
        visualized=sensor.visualize,
        horizontal=RayAngles(horizontal.min_angle, horizontal.step * column_step, columns),
        vertical=RayAngles(vertical.min_angle, vertical.step * row_step, rows),
        nearest=nearest,
        farthest=lidar.range.max if nearest < lidar.range.max < float("inf") else nearest + _DEFAULT_RAY_LENGTH,
    )
    return DisplayedLidar(scene, (vertical.count, horizontal.count), (row_step, column_step))


def _convert_camera(placed_link: PlacedLink, sensor: Sensor, camera: Camera, pose: Transform) -> CameraScene:
    optics = make_optics(camera)
    camera_pose = compose(pose, transform_of(camera.pose.pose))
    return CameraScene(
        name=SEPARATOR.join(filter(None, (placed_link.name, sensor.name, camera.name))),
        link=placed_link.name,
        position=list(camera_pose[:3]),
        quaternion=list(camera_pose[3:]),
        visualized=sensor.visualize,
        left=optics.cx / optics.fx,
        right=(optics.width - optics.cx) / optics.fx,
        up=optics.cy / optics.fy,
        down=(optics.height - optics.cy) / optics.fy,
        near=optics.near,
        far=min(optics.far, _MAX_FAR),
    )
