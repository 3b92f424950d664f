"""Lidars of Livox: ``liblivox_laser_simulation.so`` and ``libros2_livox.so``.

The rays follow the pattern in a CSV file of the package. A ray without a hit is a point at the origin of the sensor.

Source: livox_laser_simulation for ROS 1 and its versions for ROS 2 (parameters, topics, frames, layouts).
``publish_pointcloud_type`` 3, and ``libros2_livox.so`` of some packages, publish ``livox_ros_driver2/msg/CustomMsg``;
here the same points are a PointCloud2.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.control.odometry import create_transform_output, transform_message
from linkwright.diagnostics import Phrase, foreign, phrase
from linkwright.geometry.arrays import Array
from linkwright.graph.stepped.node import Output
from linkwright.messages import Header, get_message
from linkwright.sdf.poses import SEPARATOR
from linkwright.sdf.sensors import Lidar, Reach
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.sensors.base import SENSOR_QOS, SensorPlugin
from linkwright.simulation.plugins.sensors.clouds import LIVOX_LAYOUT, fill_lidar_cloud
from linkwright.simulation.sensors.pattern_lidar import PatternLidarSensor, read_pattern

_OLD_CLOUD_TYPE, _CLOUD_TYPE = "sensor_msgs/msg/PointCloud", "sensor_msgs/msg/PointCloud2"
_SECOND_TOPIC_SUFFIX = "_PointCloud2"


@dataclass(frozen=True, kw_only=True)
class LivoxParameters:
    """Parameters of ``liblivox_laser_simulation.so``."""

    csv_file_name: str = parameter()
    topic: str = parameter("scan", aliases=("ros_topic",))
    samples: int = 24000
    downsample: int = 1
    publish_pointcloud_type: int = 0


class Livox(SensorPlugin[LivoxParameters]):
    """The substitute for ``liblivox_laser_simulation.so``."""

    PARAMETERS = LivoxParameters
    IGNORED = ("ray", "visualize")

    def create_sensor(self) -> None:
        """Read the pattern, and create the lidar.

        Raises:
            LinkwrightError: SIM160, the file of the pattern is missing or wrong, or a number is.
        """
        parameters, element = self.parameters, self.context.element
        ray = None if element is None else element.first("ray")
        limits = None if ray is None else ray.first("range")
        own_range = (self.sensor.sensor.lidar or Lidar()).range
        reach = Reach(self.number_in(limits, "min", own_range.min), self.number_in(limits, "max", own_range.max))
        if parameters.samples < 1 or parameters.downsample < 1:
            message = phrase("plugin '{plugin}': <samples> and <downsample> must be positive", plugin=self.context.name)
            raise self.parameter_error(message)
        self._lidar = PatternLidarSensor(
            self.mount,
            Lidar(range=reach),
            self._read_pattern(),
            samples=parameters.samples,
            downsample=parameters.downsample,
            generator=self.random,
        )

    def _read_pattern(self) -> Array:
        name, element = self.parameters.csv_file_name, self.context.element
        nearby = Path() if element is None or element.source is None else Path(element.source.name).parent
        path = self.simulation.finder.file(name, nearby)
        reason: Phrase
        if isinstance(path, Path):
            try:
                return read_pattern(path)
            except OSError as error:
                reason = foreign(error.strerror or str(error))
            except ValueError:
                reason = phrase("no line has a time, an azimuth and a zenith angle")
        else:
            reason = path.reason
        raise self.parameter_error(
            phrase(
                "plugin '{plugin}': the pattern of the rays in '{file}' cannot be read: {reason}",
                plugin=self.context.name,
                file=name,
                reason=reason,
            ),
            None if element is None else element.first("csv_file_name"),
        )

    def create_publishers(self) -> None:
        """Create the publishers of the points, and of the transform from the link to the sensor."""
        name, link = self.sensor.name.rpartition(SEPARATOR)[2], self.sensor.link.rpartition(SEPARATOR)[2]
        self.frame, self._parent = name, link
        self._transforms = None if name == link else create_transform_output(self.node)
        self.outputs = self.create_outputs()

    def create_outputs(self) -> dict[str, list[Output]]:
        """Return the publishers of the points, by message type."""
        kind = _CLOUD_TYPE if self.parameters.publish_pointcloud_type else _OLD_CLOUD_TYPE
        return {kind: [self.node.publisher(kind, self.parameters.topic, SENSOR_QOS)]}

    def is_wanted(self) -> bool:
        """Return whether a topic of points has a subscription."""
        return any(output.is_wanted for outputs in self.outputs.values() for output in outputs)

    def measure(self) -> None:
        """Measure, and publish the points and the transform."""
        scan = self._lidar.measure()
        hit_mask = np.isfinite(scan.ranges.ravel())
        points = self._lidar.directions * np.where(hit_mask, scan.ranges.ravel(), 0.0)[:, None]
        self._lidar.advance()
        for kind, outputs in self.outputs.items():
            create = self._create_cloud if kind == _CLOUD_TYPE else self._create_old_cloud
            message = create(points, scan.intensities.ravel())
            for output in outputs:
                output.publish(message)
        if self._transforms is not None:
            header = Header(stamp=self.stamp(), frame_id=self._parent)
            self._transforms.publish(transform_message(header, self.frame, self.sensor.pose))

    def _create_cloud(self, points: Array, intensities: Array) -> Any:
        message = self.message(_CLOUD_TYPE, self.frame)
        fill_lidar_cloud(message, points, intensities, layout=LIVOX_LAYOUT)
        return message

    def _create_old_cloud(self, points: Array, _: Array) -> Any:
        message, point = self.message(_OLD_CLOUD_TYPE, self.frame), get_message("geometry_msgs/msg/Point32")
        message.points = [point(x=x, y=y, z=z) for x, y, z in points.tolist()]
        return message


class Ros2Livox(Livox):
    """The substitute for ``libros2_livox.so``: a PointCloud2 on ``TOPIC`` and on ``TOPIC_PointCloud2``."""

    def create_outputs(self) -> dict[str, list[Output]]:
        """Return the publishers of the points, by message type."""
        topics = self.parameters.topic, f"{self.parameters.topic}{_SECOND_TOPIC_SUFFIX}"
        return {_CLOUD_TYPE: [self.node.publisher(_CLOUD_TYPE, topic, SENSOR_QOS) for topic in topics]}
