"""RealSense cameras: ``librealsense_gazebo_plugin.so``.

The plugin of a model publishes the images of its sensors PREFIXcolor, PREFIXired1, PREFIXired2 and PREFIXdepth. Depths
are whole millimeters, 0 outside of the range.

Source: realsense_gazebo_plugin for ROS 1 and ROS 2 (parameters, encodings, topics, point cloud). In ROS 1 the topics
are below the name of the plugin; in ROS 2 they are absolute, and descriptions write that name in front. Points have the
colors that the depth camera sees.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from linkwright.diagnostics import Phrase, phrase
from linkwright.geometry.single import Transform, compose
from linkwright.graph.stepped.node import Output
from linkwright.messages import Header, get_message
from linkwright.sdf.cameras import Camera
from linkwright.sdf.frames import transform_of
from linkwright.sdf.optics import Optics, make_optics
from linkwright.simulation.plugins.contexts import model_plugins
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import PlacedSensor, SimulatedPlugin
from linkwright.simulation.plugins.sensors.base import SENSOR_QOS
from linkwright.simulation.plugins.sensors.camera import CAMERA_INFO_TYPE, CLOUD_TYPE, IMAGE_TYPE, compute_points
from linkwright.simulation.plugins.sensors.clouds import fill_camera_cloud
from linkwright.simulation.plugins.sensors.images import (
    ENCODINGS,
    PixelNoise,
    Pixels,
    fill_camera_info,
    fill_image,
    fill_raw_depth,
)
from linkwright.simulation.rendering.renderer import Channels
from linkwright.simulation.rendering.shared_renderer import share_renderer

_DEPTH = "depth"
_MAX_DEPTH_M = 65.535
"""The greatest depth in millimeters of 16 bits."""


@dataclass(frozen=True, kw_only=True)
class RealSenseParameters:
    """Parameters of ``librealsense_gazebo_plugin.so``: distances in m."""

    prefix: str = ""
    color_topic: str = parameter("", aliases=("colorTopicName",))
    ired1_topic: str = parameter("", aliases=("infrared1TopicName",))
    ired2_topic: str = parameter("", aliases=("infrared2TopicName",))
    depth_topic: str = parameter("", aliases=("depthTopicName",))
    color_frame: str = parameter("", aliases=("colorOpticalframeName",))
    ired1_frame: str = parameter("", aliases=("infrared1OpticalframeName",))
    ired2_frame: str = parameter("", aliases=("infrared2OpticalframeName",))
    depth_frame: str = parameter("", aliases=("depthOpticalframeName",))
    range_min_depth: float = parameter(0.0, aliases=("rangeMinDepth",))
    range_max_depth: float = parameter(_MAX_DEPTH_M, aliases=("rangeMaxDepth",))
    point_cloud: bool = parameter(default=False, aliases=("pointCloud",))
    point_cloud_topic: str = parameter("", aliases=("pointCloudTopicName",))
    min_depth: float = parameter(0.0, aliases=("pointCloudCutoff",))
    max_depth: float = parameter(5.0, aliases=("pointCloudCutoffMax",))


@dataclass(frozen=True, slots=True)
class _Stream:
    """The images of one sensor.

    Attributes:
        link: the full name of the link with the sensor.
        pose: the pose of the camera in the frame of the link.
        camera: the camera.
        optics: its projection.
        noise: the noise on its colors.
        frame: the frame of the messages.
        image, info: the publishers of the images and of their calibration.
        cloud: the publisher of the point cloud; None for none.
        is_depth: whether the images are depths.
    """

    link: str
    pose: Transform
    camera: Camera
    optics: Optics
    noise: PixelNoise
    frame: str
    image: Output
    info: Output
    cloud: Output | None
    is_depth: bool


class RealSense(SimulatedPlugin[RealSenseParameters]):
    """The substitute for ``librealsense_gazebo_plugin.so``."""

    PARAMETERS = RealSenseParameters
    IGNORED = (
        *("depthUpdateRate", "colorUpdateRate", "infraredUpdateRate", "depthCameraInfoTopicName"),
        *("colorCameraInfoTopicName", "infrared1CameraInfoTopicName", "infrared2CameraInfoTopicName"),
    )

    def start(self) -> None:
        """Find the sensors, and create the topics.

        Raises:
            LinkwrightError: SIM160, the model has no such sensor.
        """
        assert self.context.model is not None
        contexts = model_plugins(self.context.world, self.context.model, self.context.path)
        sensors = {context.sensor.sensor.name: context.sensor for context in contexts if context.sensor is not None}
        self._shared_renderer = share_renderer(self.simulation)
        for role in ("color", "ired1", "ired2", _DEPTH):
            name = f"{self.parameters.prefix}{role}"
            if name not in sensors:
                raise self.parameter_error(
                    phrase("plugin '{plugin}': there is no sensor '{name}'", plugin=self.context.name, name=name)
                )
            stream = self._create_stream(role, sensors[name])
            self.every(sensors[name].sensor.update_rate, partial(self._publish, stream))

    def stop(self) -> None:
        """Release the shared renderer."""
        self._shared_renderer.release()

    def _create_stream(self, role: str, placed: PlacedSensor) -> _Stream:
        parameters = self.parameters
        (camera, *_) = placed.sensor.cameras or (Camera(),)
        topic = self._complete_topic(getattr(parameters, f"{role}_topic") or f"{role}/image_raw")
        cloud_topic = self._complete_topic(parameters.point_cloud_topic or f"{_DEPTH}/color/points")
        has_cloud = role == _DEPTH and parameters.point_cloud
        return _Stream(
            placed.link,
            compose(placed.pose, transform_of(camera.pose.pose)),
            camera,
            make_optics(camera),
            PixelNoise(camera.noise, self.random),
            getattr(parameters, f"{role}_frame"),
            self.node.publisher(IMAGE_TYPE, topic, SENSOR_QOS),
            self.node.publisher(CAMERA_INFO_TYPE, f"{topic.rpartition('/')[0]}/camera_info", SENSOR_QOS),
            self.node.publisher(CLOUD_TYPE, cloud_topic, SENSOR_QOS) if has_cloud else None,
            role == _DEPTH,
        )

    def _complete_topic(self, topic: str) -> str:
        """Return a topic that is absolute, or below the name of the plugin."""
        name = self.context.name.strip("/")
        return f"/{topic.lstrip('/')}" if topic.lstrip("/").startswith(f"{name}/") else f"/{name}/{topic.lstrip('/')}"

    def _publish(self, stream: _Stream) -> None:
        has_cloud = stream.cloud is not None and stream.cloud.is_wanted
        header = Header(stamp=self.stamp(), frame_id=stream.frame)
        if stream.info.is_wanted:
            info = get_message(CAMERA_INFO_TYPE)(header=header)
            fill_camera_info(info, stream.optics, stream.camera.distortion)
            stream.info.publish(info)
        if not stream.image.is_wanted and not has_cloud:
            return
        channels = Channels.DEPTH if stream.is_depth else Channels.COLOR
        pose = compose(self.simulation.link_pose(stream.link), stream.pose)
        rendered = self._shared_renderer.render(
            stream.optics, pose, channels | Channels.COLOR if has_cloud else channels, self._log_renderer
        )
        if stream.image.is_wanted:
            message = get_message(IMAGE_TYPE)(header=header)
            if stream.is_depth:
                assert rendered.depth is not None
                fill_raw_depth(message, self._to_millimeters(rendered.depth))
            else:
                assert rendered.color is not None
                encoding = ENCODINGS.get(stream.camera.image.format.upper(), "rgb8")
                fill_image(message, stream.noise.apply(rendered.color), encoding)
                message.encoding = "8UC1" if encoding == "mono8" else encoding
            stream.image.publish(message)
        if stream.cloud is not None and has_cloud:
            assert rendered.depth is not None
            assert rendered.color is not None
            is_seen = (rendered.depth > self.parameters.min_depth) & (rendered.depth < self.parameters.max_depth)
            cloud = get_message(CLOUD_TYPE)(header=header)
            points = compute_points(stream.optics, np.where(is_seen, rendered.depth, np.nan))
            fill_camera_cloud(cloud, points, rendered.color)
            stream.cloud.publish(cloud)

    def _to_millimeters(self, depth: Pixels) -> Pixels:
        """Return depths in m as whole millimeters, and 0 outside of the range."""
        parameters = self.parameters
        farthest = min(parameters.range_max_depth, _MAX_DEPTH_M)
        is_in_range = (depth >= max(parameters.range_min_depth, 0.0)) & (depth <= farthest)
        return np.floor(np.where(is_in_range, depth, 0.0) * 1000.0 + 1e-3).astype("<u2")

    def _log_renderer(self, renderer_description: Phrase) -> None:
        self.node.logger.info(phrase("camera images are rendered by {renderer}", renderer=renderer_description))
