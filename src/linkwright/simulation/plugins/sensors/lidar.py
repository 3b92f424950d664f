"""Lidars and sonars: ``gazebo_ros_ray_sensor``, ROS 1's lasers, and gz's ``gpu_lidar``.

Source: gazebo_ros_pkgs for ROS 2 (output types, the row in a LaserScan, the value of a Range) and for ROS 1 (names),
velodyne_simulator (points), gz-sensors and gz-msgs (topics, points).
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Collection
from dataclasses import dataclass
from math import inf
from typing import Any, ClassVar, Generic, TypeVar

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.geometry.arrays import Array
from linkwright.graph.qos.profile import SENSOR_DATA_QOS
from linkwright.graph.stepped.node import Output
from linkwright.messages import get_message
from linkwright.sdf.sensors import Lidar
from linkwright.simulation.plugins.parameters import NoParameters, parameter
from linkwright.simulation.plugins.sensors.base import SENSOR_QOS, FrameNameParameter, SensorPlugin, SingleTopicSensor
from linkwright.simulation.plugins.sensors.clouds import GZ_LAYOUT, VELODYNE_LAYOUT, fill_lidar_cloud
from linkwright.simulation.sensors.lidar import LidarSensor, Scan

P = TypeVar("P")
_SCAN_TYPE, _CLOUD_TYPE = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2"
RAYS_TOPIC, OTHER_RAYS_TOPIC = "/world_rays", "/world_rays/others"
"""The topics for the rays of lidars with ``<visualize>true</visualize>``, and of other lidars."""
_RADIATION_TYPES = {"ultrasound": 0, "infrared": 1}


class _LidarPlugin(SensorPlugin[P], Generic[P]):
    """The base class of lidars that also publish their rays for display in pages."""

    def start(self) -> None:
        """Create the lidar and the publishers of measurements and rays."""
        visualize = self.sensor.sensor.visualize
        self._rays_output = self.node.publisher(
            _SCAN_TYPE, RAYS_TOPIC if visualize else OTHER_RAYS_TOPIC, SENSOR_DATA_QOS
        )
        super().start()

    def should_measure(self) -> bool:
        """Return whether the topics for measurements or rays have a subscription."""
        return self.is_wanted() or self._rays_output.is_wanted

    def measure(self) -> None:
        """Measure, and publish to the topics that have subscriptions."""
        scan = self.lidar.measure()
        if self._rays_output.is_wanted:
            self._rays_output.publish(self._create_rays_message(scan))
        if self.is_wanted():
            self.publish(scan)

    @abstractmethod
    def publish(self, scan: Scan) -> None:
        """Publish the measurements of a scan."""

    def _create_rays_message(self, scan: Scan) -> Any:
        """Return a LaserScan with all rows of a scan, lowest row first.

        The frame of the message is the sensor's name.
        """
        message = self._create_empty_scan(self.sensor.name)
        message.ranges = scan.ranges.ravel().astype(np.float32)
        return message

    def create_sensor(self) -> None:
        """Create the lidar that the sensor's element describes."""
        sensor = self.sensor.sensor
        lidar = sensor.lidar or Lidar()
        self.lidar = LidarSensor(
            self.mount, lidar, sees_visuals=sensor.type not in ("ray", "sonar"), generator=self.random
        )

    def create_scan_message(self, frame: str, scan: Scan, min_intensity: float = 0.0) -> Any:
        """Return a LaserScan of the middle row of a scan.

        Intensities are at least `min_intensity`.
        """
        message, row = self._create_empty_scan(frame), self.lidar.vertical.count // 2
        message.ranges = scan.ranges[row].astype(np.float32)
        message.intensities = np.maximum(scan.intensities[row], min_intensity).astype(np.float32)
        return message

    def _create_empty_scan(self, frame: str) -> Any:
        """Return a LaserScan with the angles and range limits of the lidar, but without ranges."""
        lidar, message = self.lidar, self.message(_SCAN_TYPE, frame)
        message.angle_min, message.angle_max = float(lidar.horizontal.min_angle), float(lidar.horizontal.max_angle)
        message.angle_increment = float(lidar.horizontal.step)
        message.range_min, message.range_max = float(lidar.range_min), float(lidar.range_max)
        return message

    def points(self, scan: Scan) -> Any:
        """Return the points of a scan in m in the sensor's frame, shape (n, 3).

        The coordinates of a point are not finite if its ray had no hit.
        """
        with np.errstate(invalid="ignore"):  # A ray without a hit has an infinite range, and 0 times infinity is NaN.
            return self.lidar.directions * scan.ranges.reshape(-1, 1)

    def compute_hit_points(self, scan: Scan, min_intensity: float = 0.0) -> tuple[Any, Any]:
        """Return the points and the intensities of the rays of a scan with a hit.

        The points are in m, and have shape (n, 3).
        """
        points, intensities = self.points(scan), scan.intensities.ravel()
        hit_mask = np.isfinite(scan.ranges.ravel())
        return points[hit_mask], np.maximum(intensities[hit_mask], min_intensity)

    def create_point_cloud_message(self, frame: str, scan: Scan, min_intensity: float = 0.0) -> Any:
        """Return the hits of a scan as ``sensor_msgs/msg/PointCloud``."""
        message = self.message("sensor_msgs/msg/PointCloud", frame)
        points, intensities = self.compute_hit_points(scan, min_intensity)
        point, channel = get_message("geometry_msgs/msg/Point32"), get_message("sensor_msgs/msg/ChannelFloat32")
        message.points = [point(x=float(x), y=float(y), z=float(z)) for x, y, z in points]
        message.channels = [channel(name="intensity", values=intensities.astype(np.float32))]
        return message

    def create_range_message(self, frame: str, scan: Scan, radiation: str) -> Any:
        """Return a ``sensor_msgs/msg/Range`` with the minimum distance of a scan."""
        message = self.message("sensor_msgs/msg/Range", frame)
        lidar = self.lidar
        spans = [axis_sweep.max_angle - axis_sweep.min_angle for axis_sweep in (lidar.horizontal, lidar.vertical)]
        message.radiation_type = _RADIATION_TYPES.get(radiation.lower(), 1)
        message.field_of_view = float(max(spans))
        message.min_range, message.max_range = float(lidar.range_min), float(lidar.range_max)
        message.range = float(scan.ranges.min())
        return message


class SingleTopicLidar(_LidarPlugin[P], SingleTopicSensor[P], Generic[P]):
    """A lidar with one topic."""


@dataclass(frozen=True, kw_only=True)
class RayParameters(FrameNameParameter):
    """Parameters of ``gazebo_ros_ray_sensor``."""

    output_type: str = "sensor_msgs/PointCloud2"
    min_intensity: float = 0.0
    radiation_type: str = "infrared"


class ClassicRaySensor(SingleTopicLidar[RayParameters]):
    """The substitute for ``libgazebo_ros_ray_sensor.so``."""

    PARAMETERS = RayParameters

    def create_publishers(self) -> None:
        """Create the publisher of messages of the type that the parameters request.

        Raises:
            LinkwrightError: SIM137, the message type is not an output type of a lidar.
        """
        converters = {
            "LaserScan": self._to_scan,
            "PointCloud2": self._to_cloud,
            "PointCloud": self._to_old_cloud,
            "Range": self._to_range,
        }
        kind = self.parameters.output_type.rpartition("/")[2]
        if kind not in converters:
            element = self.context.element
            message = phrase("'{type}' is not an output type of a lidar", type=self.parameters.output_type)
            hint = phrase("use sensor_msgs/LaserScan, PointCloud2, PointCloud or Range")
            span, source = (element.span(), element.source) if element is not None else (None, None)
            raise LinkwrightError(Diagnostic("SIM137", message, span, hint=hint, source=source))
        self._frame = self.classic_frame()
        self._publish = converters[kind]
        self.output = self.node.publisher(f"sensor_msgs/msg/{kind}", "~/out", SENSOR_QOS)

    def publish(self, scan: Scan) -> None:
        """Publish a scan in the message type that the parameters request."""
        self.output.publish(self._publish(scan))

    def _to_scan(self, scan: Scan) -> Any:
        return self.create_scan_message(self._frame, scan, self.parameters.min_intensity)

    def _to_cloud(self, scan: Scan) -> Any:
        message = self.message(_CLOUD_TYPE, self._frame)
        fill_lidar_cloud(message, *self.compute_hit_points(scan, self.parameters.min_intensity))
        return message

    def _to_old_cloud(self, scan: Scan) -> Any:
        return self.create_point_cloud_message(self._frame, scan, self.parameters.min_intensity)

    def _to_range(self, scan: Scan) -> Any:
        return self.create_range_message(self._frame, scan, self.parameters.radiation_type)


@dataclass(frozen=True, kw_only=True)
class LaserParameters(FrameNameParameter):
    """Parameters of the lasers of ROS 1."""

    topic_name: str = parameter("scan", aliases=("topicName",))
    update_rate: float = parameter(0.0, aliases=("updateRate", "updateRateHZ"))


class OldLaser(SingleTopicLidar[LaserParameters]):
    """The substitute for ROS 1's ``libgazebo_ros_laser.so`` and ``libgazebo_ros_gpu_laser.so``."""

    PARAMETERS = LaserParameters
    IGNORED: ClassVar[Collection[str]] = ("gaussianNoise", "hokuyoMinIntensity")
    MESSAGE_TYPE: ClassVar[str] = _SCAN_TYPE

    def create_publishers(self) -> None:
        """Create the publisher of the type `MESSAGE_TYPE` on the topic in the parameters."""
        self.output = self.node.publisher(self.MESSAGE_TYPE, self.parameters.topic_name, SENSOR_DATA_QOS.depth)

    @property
    def rate(self) -> float:
        """The number of scans per simulated second.

        The rate of the sensor takes precedence over the rate of the plugin.
        """
        return self.sensor.sensor.update_rate or self.parameters.update_rate

    def publish(self, scan: Scan) -> None:
        """Publish a scan as a message of type `MESSAGE_TYPE`."""
        self.output.publish(self.create_output_message(self.classic_frame(), scan))

    def create_output_message(self, frame: str, scan: Scan) -> Any:
        """Return a scan as a message of type `MESSAGE_TYPE`, by default a LaserScan."""
        return self.create_scan_message(frame, scan)


class OldBlockLaser(OldLaser):
    """The substitute for ``libgazebo_ros_block_laser.so`` of ROS 1: it publishes a PointCloud."""

    MESSAGE_TYPE = "sensor_msgs/msg/PointCloud"

    def create_output_message(self, frame: str, scan: Scan) -> Any:
        """Return a scan as a PointCloud."""
        return self.create_point_cloud_message(frame, scan)


@dataclass(frozen=True, kw_only=True)
class RangeParameters(LaserParameters):
    """Parameters of ``gazebo_ros_range``."""

    topic_name: str = parameter("range", aliases=("topicName",))
    radiation: str = "ultrasound"


class OldRange(OldLaser):
    """The substitute for ``libgazebo_ros_range.so`` of ROS 1: it publishes minimum distances."""

    PARAMETERS = RangeParameters
    IGNORED = ("gaussianNoise", "fov")
    MESSAGE_TYPE = "sensor_msgs/msg/Range"

    def create_output_message(self, frame: str, scan: Scan) -> Any:
        """Return the minimum distance of a scan as a Range."""
        return self.create_range_message(frame, scan, getattr(self.parameters, "radiation", ""))


@dataclass(frozen=True, kw_only=True)
class VelodyneParameters(LaserParameters):
    """Parameters of ``gazebo_ros_velodyne_laser``."""

    topic_name: str = parameter("~/out", aliases=("topicName",))
    min_range: float = 0.0
    max_range: float = inf
    min_intensity: float = -inf
    organize_cloud: bool = False


class Velodyne(SingleTopicLidar[VelodyneParameters]):
    """The substitute for ``libgazebo_ros_velodyne_laser.so`` of velodyne_simulator.

    Points have an intensity, a ring and a time. They are ordered by firing; all lasers measure in each firing. In an
    organized cloud, each firing is a row.
    """

    PARAMETERS = VelodyneParameters
    IGNORED = ("gaussianNoise",)

    def create_publishers(self) -> None:
        """Create the publisher of the point cloud."""
        self.output = self.node.publisher(_CLOUD_TYPE, self.parameters.topic_name, SENSOR_QOS)

    def publish(self, scan: Scan) -> None:
        """Publish the points whose ranges and intensities are within the limits of the parameters."""
        parameters = self.parameters
        message = self.message(_CLOUD_TYPE, self.classic_frame())
        shape = scan.ranges.shape
        points: Array = self.points(scan).reshape(*shape, 3).swapaxes(0, 1).reshape(-1, 3)
        ranges: Array = scan.ranges.T.ravel()
        intensities: Array = scan.intensities.T.ravel()
        rings = np.tile(np.arange(shape[0], dtype=np.uint16), shape[1])
        limit_mask = (
            (ranges > parameters.min_range)
            & (ranges < parameters.max_range)
            & (intensities >= parameters.min_intensity)
        )
        if parameters.organize_cloud:
            points[~limit_mask], intensities[~limit_mask] = np.nan, np.nan
        else:
            points, intensities, rings = (
                points[limit_mask],
                intensities[limit_mask],
                rings[limit_mask],
            )
        height = shape[1] if parameters.organize_cloud else 1
        fill_lidar_cloud(message, points, intensities, rings, layout=VELODYNE_LAYOUT, height=height)
        self.output.publish(message)


class GzLidar(_LidarPlugin[NoParameters]):
    """The sensors ``gpu_lidar`` and ``lidar`` of gz, which publish a scan and a point cloud."""

    _scans: Output
    _clouds: Output

    def create_publishers(self) -> None:
        """Create the publishers of scans and points."""
        self._frame = self.gz_frame()
        self._scans = self.create_gz_output(_SCAN_TYPE, "scan")
        topic = self.sensor.sensor.topic or self.gz_topic("scan")
        self._clouds = self.node.publisher(
            _CLOUD_TYPE, f"{topic}/points", conventional_topic="" if self.sensor.sensor.topic else "/scan/points"
        )

    def is_wanted(self) -> bool:
        """Return whether a topic has a subscription."""
        return self._scans.is_wanted or self._clouds.is_wanted

    def publish(self, scan: Scan) -> None:
        """Publish the scan and the points."""
        self._scans.publish(self.create_scan_message(self._frame, scan))
        if self._clouds.is_wanted:
            message = self.message(_CLOUD_TYPE, self._frame)
            height, width = scan.ranges.shape
            rings = np.repeat(np.arange(height, dtype=np.uint16), width)
            points, intensities = self.points(scan), scan.intensities.ravel()
            fill_lidar_cloud(message, points, intensities, rings, layout=GZ_LAYOUT, height=height)
            self._clouds.publish(message)
