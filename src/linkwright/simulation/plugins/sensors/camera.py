"""Cameras and depth cameras: ``gazebo_ros_camera``, the cameras of ROS 1, and gz's cameras.

Source: gazebo_ros_pkgs for ROS 2 (topics, parameters, encodings, point clouds), for ROS 1 (names), gz-sensors (topics).
The colors of point clouds have the byte order that PCL and RViz expect; ``gazebo_ros_camera`` swaps red and blue.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf
from typing import Any, Generic, TypeVar

import numpy as np

from linkwright.diagnostics import Phrase, phrase
from linkwright.geometry.single import Transform, compose
from linkwright.graph.stepped.node import Output
from linkwright.messages import get_message
from linkwright.sdf.cameras import Camera
from linkwright.sdf.frames import transform_of
from linkwright.sdf.optics import Optics, make_optics
from linkwright.simulation.plugins.parameters import NoParameters, parameter
from linkwright.simulation.plugins.sensors.base import SENSOR_QOS, FrameNameParameter, SensorPlugin
from linkwright.simulation.plugins.sensors.clouds import fill_camera_cloud
from linkwright.simulation.plugins.sensors.images import (
    DEFAULT_ENCODING,
    DEPTH_FORMATS,
    ENCODINGS,
    PixelNoise,
    clip_depth,
    fill_camera_info,
    fill_depth,
    fill_image,
)
from linkwright.simulation.rendering.renderer import Channels, RenderedImage
from linkwright.simulation.rendering.shared_renderer import share_renderer

P = TypeVar("P")
IMAGE_TYPE, CAMERA_INFO_TYPE, CLOUD_TYPE = (
    "sensor_msgs/msg/Image",
    "sensor_msgs/msg/CameraInfo",
    "sensor_msgs/msg/PointCloud2",
)
_DEPTH_TYPES = ("depth", "depth_camera", "rgbd_camera", "rgbd")


@dataclass(frozen=True, slots=True)
class MountedCamera:
    """One camera of a sensor.

    Attributes:
        description: the parsed ``<camera>``.
        optics: the projection of the camera.
        pose: the pose of the camera in the frame of the link.
        noise: the noise on the colors of the images.
        encoding: the ROS encoding of the images, such as ``rgb8``.
    """

    description: Camera
    optics: Optics
    pose: Transform
    noise: PixelNoise
    encoding: str


class CameraPlugin(SensorPlugin[P], Generic[P]):
    """A sensor that renders images."""

    def create_sensor(self) -> None:
        """Create the cameras of the sensor, with a new random number generator for their noise."""
        generator = self.random
        self.cameras = [self._mount_camera(camera, generator) for camera in self.sensor.sensor.cameras or (Camera(),)]

    def start(self) -> None:
        """Acquire the shared renderer, and create the cameras and the topics."""
        self._shared_renderer = share_renderer(self.simulation)
        super().start()

    def stop(self) -> None:
        """Release the shared renderer."""
        self._shared_renderer.release()

    def render(self, camera: MountedCamera, channels: Channels) -> RenderedImage:
        """Render the requested channels of one of the sensor's cameras, with noise on the colors."""
        pose = compose(self.simulation.link_pose(self.sensor.link), camera.pose)
        rendered = self._shared_renderer.render(camera.optics, pose, channels, self._log_renderer)
        if rendered.color is None:
            return rendered
        return RenderedImage(camera.noise.apply(rendered.color), rendered.depth, rendered.geoms)

    def publish_image(self, output: Output, camera: MountedCamera, rendered: RenderedImage, frame: str) -> None:
        """Publish the colors of a rendered image in the camera's encoding."""
        message = self.message(IMAGE_TYPE, frame)
        fill_image(message, rendered.color, camera.encoding)  # type: ignore[arg-type]  # requested
        output.publish(message)

    def _mount_camera(self, camera: Camera, generator: np.random.Generator) -> MountedCamera:
        encoding = ENCODINGS.get(camera.image.format.upper())
        if encoding is None:
            encoding = DEFAULT_ENCODING
            if camera.image.format.upper() not in DEPTH_FORMATS:
                warning = phrase(
                    "'{format}' is not a supported image format; bgr8 is used instead", format=camera.image.format
                )
                self.node.logger.warning(warning)
        pose = compose(self.sensor.pose, transform_of(camera.pose.pose))
        return MountedCamera(camera, make_optics(camera), pose, PixelNoise(camera.noise, generator), encoding)

    def _log_renderer(self, renderer_description: Phrase) -> None:
        self.node.logger.info(phrase("camera images are rendered by {renderer}", renderer=renderer_description))


@dataclass(frozen=True, kw_only=True)
class CameraParameters(FrameNameParameter):
    """Parameters of ``gazebo_ros_camera``, and of ``gazebo_ros_openni_kinect`` of ROS 1."""

    camera_name: str = parameter("", aliases=("cameraName",))
    hack_baseline: float = parameter(0.0, aliases=("hackBaseline",))
    triggered: bool = False
    cx: float = parameter(0.0, aliases=("Cx",))
    cy: float = parameter(0.0, aliases=("Cy",))
    focal_length: float = parameter(0.0, aliases=("focalLength",))
    min_depth: float = parameter(0.4, aliases=("pointCloudCutoff",))
    max_depth: float = parameter(inf, aliases=("pointCloudCutoffMax",))
    update_rate: float = parameter(0.0, aliases=("updateRate",))
    image_topic_name: str = parameter("image_raw", aliases=("imageTopicName",))
    camera_info_topic_name: str = parameter("camera_info", aliases=("cameraInfoTopicName",))
    depth_image_topic_name: str = parameter("depth/image_raw", aliases=("depthImageTopicName",))
    depth_info_topic_name: str = parameter("depth/camera_info", aliases=("depthImageCameraInfoTopicName",))
    point_cloud_topic_name: str = parameter("points", aliases=("pointCloudTopicName",))


class ClassicCamera(CameraPlugin[CameraParameters]):
    """The substitute for ``libgazebo_ros_camera.so`` and the cameras of ROS 1.

    The plugin serves sensors of the types camera, depth and multicamera.
    """

    PARAMETERS = CameraParameters
    IGNORED = (
        "border_crop",
        "P_cx",
        "P_cy",
        "P_fx",
        "P_fy",
        "Tx",
        "Ty",
        "rectification_matrix",
        "autoDistortion",
        "CxPrime",
        "imageTopicNames",
        "baseline",
        "distortionK1",
        "distortionK2",
        "distortionK3",
        "distortionT1",
        "distortionT2",
        "distortion_k1",
        "distortion_k2",
        "distortion_k3",
        "distortion_t1",
        "distortion_t2",
    )

    def create_publishers(self) -> None:
        """Create the publishers of each camera, and subscribe to the trigger if it is enabled."""
        parameters, sensor = self.parameters, self.sensor.sensor
        name = parameters.camera_name or sensor.name
        self._frame = self.classic_frame()
        is_multicamera = sensor.type == "multicamera"
        bases = [f"{name}/{camera.description.name}" if is_multicamera else name for camera in self.cameras]
        self._images = [self._create_output(IMAGE_TYPE, base, parameters.image_topic_name) for base in bases]
        self._infos = [self._create_output(CAMERA_INFO_TYPE, base, parameters.camera_info_topic_name) for base in bases]
        self._depths: list[Output] = []
        if sensor.type in _DEPTH_TYPES:
            self._depths = [
                self._create_output(IMAGE_TYPE, name, parameters.depth_image_topic_name),
                self._create_output(CAMERA_INFO_TYPE, name, parameters.depth_info_topic_name),
                self._create_output(CLOUD_TYPE, name, parameters.point_cloud_topic_name),
            ]
        self._is_image_requested = not parameters.triggered
        if parameters.triggered:
            trigger_class = get_message("std_msgs/msg/Empty")
            self.node.subscribe(trigger_class, f"{name}/image_trigger", self._on_trigger)

    def _create_output(self, message_type: str, base: str, topic: str) -> Output:
        return self.node.publisher(message_type, topic if topic.startswith("/") else f"{base}/{topic}", SENSOR_QOS)

    def _on_trigger(self, _message: Any) -> None:
        self._is_image_requested = True

    @property
    def rate(self) -> float:
        """The number of images per simulated second.

        The rate of the sensor takes precedence over the rate of the plugin.
        """
        return self.sensor.sensor.update_rate or self.parameters.update_rate

    def is_wanted(self) -> bool:
        """Return whether a topic has a subscription.

        A triggered camera also requires that an image was requested.
        """
        return self._is_image_requested and any(
            image.is_wanted for image in (*self._images, *self._infos, *self._depths)
        )

    def measure(self) -> None:
        """Render and publish the images and camera info whose topics have subscriptions."""
        self._is_image_requested = not self.parameters.triggered
        for camera, image, info in zip(self.cameras, self._images, self._infos, strict=True):
            depth, depth_info, cloud = self._depths or (None, None, None)
            has_cloud = cloud is not None and cloud.is_wanted
            channels = Channels(0)
            if image.is_wanted or has_cloud:
                channels |= Channels.COLOR
            if has_cloud or (depth is not None and depth.is_wanted):
                channels |= Channels.DEPTH
            rendered = self.render(camera, channels) if channels else RenderedImage(None, None, None)
            if image.is_wanted:
                self.publish_image(image, camera, rendered, self._frame)
            self._publish_info(info, camera)
            if depth is not None and depth_info is not None and cloud is not None:
                self._publish_depth(depth, cloud, camera, rendered)
                self._publish_info(depth_info, camera)

    def _publish_depth(self, depth: Output, cloud: Output, camera: MountedCamera, rendered: RenderedImage) -> None:
        nearest, farthest = self.parameters.min_depth, self.parameters.max_depth
        if depth.is_wanted and rendered.depth is not None:
            message = self.message(IMAGE_TYPE, self._frame)
            fill_depth(message, rendered.depth, nearest, farthest)
            depth.publish(message)
        if cloud.is_wanted and rendered.depth is not None and rendered.color is not None:
            message = self.message(CLOUD_TYPE, self._frame)
            points = compute_points(camera.optics, clip_depth(rendered.depth, nearest, farthest))
            fill_camera_cloud(message, points, rendered.color, swap_red_blue=self.gazebo_mistakes)
            cloud.publish(message)

    def _publish_info(self, output: Output, camera: MountedCamera) -> None:
        if not output.is_wanted:
            return
        parameters, optics = self.parameters, camera.optics
        center = parameters.cx or (optics.width + 1) / 2, parameters.cy or (optics.height + 1) / 2
        message = self.message(CAMERA_INFO_TYPE, self._frame)
        fill_camera_info(
            message, optics, camera.description.distortion, center=center, focal_length=parameters.focal_length,
            baseline=parameters.hack_baseline,
        )  # fmt: skip
        output.publish(message)


def compute_points(optics: Optics, depth: Any) -> Any:
    """Return the points of a depth image in m, shape (height, width, 3).

    The axes are x to the right, y down and z forwards.
    """
    rays = optics.rays.astype(np.float32).reshape(optics.height, optics.width, 3)
    with np.errstate(invalid="ignore"):  # A ray without a hit has an infinite depth, and 0 times infinity is NaN.
        return rays * depth[:, :, None]


class GzCamera(CameraPlugin[NoParameters]):
    """The sensors ``camera``, ``depth_camera`` and ``rgbd_camera`` of gz.

    In the point clouds of depth and RGB-D cameras, the x axis points forwards.
    """

    def create_publishers(self) -> None:
        """Create the publishers of the sensor type: images, depth images, points, camera info."""
        kind = self.sensor.sensor.type
        self._frame = self.gz_frame()
        camera = self.cameras[0].description
        self._optical = camera.optical_frame_id or self._frame
        self._image = self._depth = self._cloud = None
        if kind in ("rgbd_camera", "rgbd"):
            self._image = self._create_leaf_output(IMAGE_TYPE, "image")
            self._depth = self._create_leaf_output(IMAGE_TYPE, "depth_image")
            self._cloud = self._create_leaf_output(CLOUD_TYPE, "points")
        elif kind in _DEPTH_TYPES:
            self._depth = self.create_gz_output(IMAGE_TYPE, "depth_image")
            topic = self.sensor.sensor.topic or self.gz_topic("depth_image")
            self._cloud = self.node.publisher(CLOUD_TYPE, f"{topic}/points")
        else:
            self._image = self.create_gz_output(IMAGE_TYPE, "image")
        topic = camera.camera_info_topic or self._choose_info_topic()
        self._info = self.node.publisher(
            CAMERA_INFO_TYPE, topic, conventional_topic="" if self.sensor.sensor.topic else "/camera_info"
        )

    def _create_leaf_output(self, message_type: str, leaf: str) -> Output:
        topic = self.sensor.sensor.topic
        return self.node.publisher(
            message_type,
            f"{topic}/{leaf}" if topic else self.gz_topic(leaf),
            conventional_topic="" if topic else f"/{leaf}",
        )

    def _choose_info_topic(self) -> str:
        topic = self.sensor.sensor.topic
        if not topic:
            return self.gz_topic("camera_info")
        if self._image is not None and self._depth is not None:
            return f"{topic}/camera_info"
        parent_topic, slash, _ = topic.rpartition("/")
        return f"{parent_topic}{slash}camera_info"

    def _list_outputs(self) -> Iterator[Output]:
        yield from (output for output in (self._image, self._depth, self._cloud, self._info) if output is not None)

    def is_wanted(self) -> bool:
        """Return whether a topic has a subscription."""
        return any(output.is_wanted for output in self._list_outputs())

    def measure(self) -> None:
        """Render and publish the images, points and camera info whose topics have subscriptions."""
        (camera, *_) = self.cameras
        channels = Channels(0)
        if any(output is not None and output.is_wanted for output in (self._image, self._cloud)):
            channels |= Channels.COLOR
        if any(output is not None and output.is_wanted for output in (self._depth, self._cloud)):
            channels |= Channels.DEPTH
        rendered = self.render(camera, channels) if channels else RenderedImage(None, None, None)
        if self._image is not None and self._image.is_wanted:
            self.publish_image(self._image, camera, rendered, self._optical)
        clip = camera.description.depth_clip or camera.description.clip
        if self._depth is not None and self._depth.is_wanted:
            message = self.message(IMAGE_TYPE, self._optical)
            fill_depth(message, rendered.depth, clip.near, clip.far)  # type: ignore[arg-type]  # requested
            self._depth.publish(message)
        if self._cloud is not None and self._cloud.is_wanted:
            message = self.message(CLOUD_TYPE, self._frame)
            points = compute_points(camera.optics, clip_depth(rendered.depth, clip.near, clip.far))  # type: ignore[arg-type]  # see above
            forward_points = np.stack([points[:, :, 2], -points[:, :, 0], -points[:, :, 1]], axis=-1)
            fill_camera_cloud(message, forward_points, rendered.color)  # type: ignore[arg-type]  # requested
            self._cloud.publish(message)
        if self._info.is_wanted:
            message = self.message(CAMERA_INFO_TYPE, self._optical)
            fill_camera_info(message, camera.optics, camera.description.distortion)
            self._info.publish(message)
