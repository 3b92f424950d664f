"""The nodes of v4l2_camera and usb_cam: publish the images of a camera or of a video file.

Source: v4l2_camera and usb_cam for ROS 2 (parameters, defaults, topics, frames, texts). Deliberate differences:
``video_device`` can name a video file, which is repeated and paced by the node's clock; a pixel format that is not
supported is replaced by ``rgb8``; images are published as raw images only; the parameters for the device's controls in
v4l2_camera are missing, whose camera has the name of its device file.
"""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections import deque
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.diagnostics.translation import localized
from linkwright.graph import Graph, Node
from linkwright.messages import get_message, get_service
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import check_positive, invalid_value_error, log_unknown_parameters
from linkwright.vision.cameras.calibration import locate_calibration, read_calibration, write_calibration
from linkwright.vision.cameras.video import Frame, VideoSource
from linkwright.vision.detectors.library import load_opencv

_DEFAULT_RATE_HZ = 30.0
_DEFAULT_INTERVAL = [1, 30]
"""The time between frames as a fraction of a second."""
_CONVERSIONS = {
    "bgr8": None,
    "rgb8": "COLOR_BGR2RGB",
    "bgra8": "COLOR_BGR2BGRA",
    "rgba8": "COLOR_BGR2RGBA",
    "mono8": "COLOR_BGR2GRAY",
    "yuv422": "COLOR_BGR2YUV_UYVY",
    "yuv422_yuy2": "COLOR_BGR2YUV_YUY2",
}
"""The encodings that can be published, each with OpenCV's conversion from BGR."""
_ENCODINGS_BY_FORMAT = {
    "yuyv": "yuv422_yuy2",
    "uyvy": "yuv422",
    "rgb8": "rgb8",
    "mono8": "mono8",
    "yuyv2rgb": "rgb8",
    "uyvy2rgb": "rgb8",
    "mjpeg2rgb": "rgb8",
    "m4202rgb": "rgb8",
    "y102mono8": "mono8",
}
"""The pixel formats of usb_cam that are supported, each with the encoding of the images."""

_CONTROLS = {
    "brightness": ("BRIGHTNESS", -100),
    "contrast": ("CONTRAST", -1),
    "saturation": ("SATURATION", -1),
    "sharpness": ("SHARPNESS", -1),
    "gain": ("GAIN", -1),
    "auto_white_balance": ("AUTO_WB", True),
    "white_balance": ("WB_TEMPERATURE", 4000),
    "auto_exposure": ("AUTO_EXPOSURE", 1),
    "exposure_time_absolute": ("EXPOSURE", 100),
    "autofocus": ("AUTOFOCUS", False),
    "focus": ("FOCUS", -1),
}
"""The parameters of usb_cam for controls of the device, each with OpenCV's name and the default, which sets nothing."""


class _VideoCamera(SingleNode, ABC):
    """A node that publishes ``image_raw`` and ``camera_info``.

    Attributes:
        QUEUE_DEPTH: the depth of the publishers.
    """

    QUEUE_DEPTH: int

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._source: VideoSource | None = None
        self._is_capturing = True
        node = self._node
        with handle_start_errors(node):
            self._images = node.create_publisher(get_message("sensor_msgs/msg/Image"), "image_raw", self.QUEUE_DEPTH)
            info_type = get_message("sensor_msgs/msg/CameraInfo")
            self._infos = node.create_publisher(info_type, "camera_info", self.QUEUE_DEPTH)
            self._start()

    @abstractmethod
    def _start(self) -> None:
        """Declare the parameters and open the camera."""

    def close(self) -> None:
        """Close the camera and the node."""
        if self._source is not None:
            self._source.close()
            self._source = None
        super().close()

    def _publish_from(self, source: VideoSource, rate_hz: float, encoding: str, frame_id: str, info: Any) -> None:
        """Start publishing the images of an open camera or file.

        Args:
            source: the camera or file.
            rate_hz: the frame rate of a file; 0 for its own.
            encoding: the encoding of the images.
            frame_id: the frame of the images.
            info: the camera_info of images of its size; None if the camera has no calibration.
        """
        self._source, self._encoding, self._frame_id, self._info = source, encoding, frame_id, info
        if source.is_file:
            self._node.create_timer(1.0 / (rate_hz or source.rate_hz or _DEFAULT_RATE_HZ), self._publish_next)
            return
        newest: deque[Frame] = deque(maxlen=1)

        def publish() -> None:
            if newest:
                self._publish(newest.popleft())

        frame_arrived = self._node.create_guard_condition(publish)
        camera_lost = self._node.create_guard_condition(self._report_loss)

        def on_frame(frame: Frame) -> None:
            newest.append(frame)
            frame_arrived.trigger()

        source.start(on_frame, camera_lost.trigger)

    def _publish_next(self) -> None:
        frame = self._source.read() if self._source is not None and self._is_capturing else None
        if frame is not None:
            self._publish(frame)

    def _report_loss(self) -> None:
        self._node.get_logger().error(localized(phrase("the camera no longer sends images")))

    def _publish(self, frame: Frame) -> None:
        if not self._is_capturing:
            return
        image = create_image(frame, self._encoding)
        image.header.stamp = self._node.get_clock().now().to_msg()
        image.header.frame_id = self._frame_id
        info = self._info
        if info is None or (info.width, info.height) != (image.width, image.height):
            info = get_message("sensor_msgs/msg/CameraInfo")(width=image.width, height=image.height)
        info.header = image.header
        self._images.publish(image)
        self._infos.publish(info)

    def _serve_info(self, url: str, camera: str) -> Any:
        """Offer the service that stores a calibration, and return the camera_info of the calibration file or None.

        The messages are those of camera_info_manager.
        """

        def store(request: Any, response: Any) -> Any:
            self._info = request.camera_info
            try:
                path = locate_calibration(url, camera, os.environ)
                self._node.get_logger().info(f"writing calibration data to {path}")
                write_calibration(path, camera, self._info)
            except LinkwrightError as error:
                _log_error(self._node, error)
                response.status_message = f"Error storing camera calibration: {error.diagnostics[0].message}"
            else:
                response.success = True
            return response

        self._node.create_service(get_service("sensor_msgs/srv/SetCameraInfo"), "~/set_camera_info", store)
        return self._read_info(url, camera)

    def _read_info(self, url: str, camera: str) -> Any:
        logger = self._node.get_logger()
        if not url:
            logger.info("using default calibration URL")
        try:
            path = locate_calibration(url, camera, os.environ)
            logger.info(f"camera calibration URL: {url or path.as_uri()}")
            if not path.is_file():
                logger.info(f"Unable to open camera calibration file [{path}]")
                logger.warning(f"Camera calibration file {path} not found.")
                return None
            name, info = read_calibration(path)
        except LinkwrightError as error:
            _log_error(self._node, error)
            return None
        if name != camera:
            logger.warning(f"[{camera}] does not match name {name} in file {path}")
        return info


class V4L2Camera(_VideoCamera):
    """The node ``v4l2_camera_node``. Without the camera, it reports an error and stays.

    Raises:
        LinkwrightError: a parameter has an invalid value or type (NODE433, GRAPH201); OpenCV is missing (VISION101).
    """

    DEFAULT_NAME, QUEUE_DEPTH = "v4l2_camera", 10

    def _start(self) -> None:
        node = self._node
        load_opencv()
        device: str = node.declare_parameter("video_device", "/dev/video0").value
        encoding: str = node.declare_parameter("output_encoding", "rgb8").value
        url: str = node.declare_parameter("camera_info_url", "").value
        frame_id: str = node.declare_parameter("camera_frame_id", "camera").value
        pixel_format: str = node.declare_parameter("pixel_format", "YUYV").value
        size = list(node.declare_parameter("image_size", [640, 480]).value)
        interval = list(node.declare_parameter("time_per_frame", _DEFAULT_INTERVAL).value)
        node.declare_parameter("use_v4l2_buffer_timestamps", True)
        node.declare_parameter("timestamp_offset", 0)
        log_unknown_parameters(node)
        if encoding not in _CONVERSIONS:
            raise invalid_value_error("output_encoding", encoding, node.get_name(), sorted(_CONVERSIONS))
        for name, value in (("image_size", size), ("time_per_frame", interval)):
            if len(value) != 2 or min(value) < 1:
                raise invalid_value_error(name, value, node.get_name())
        if len(pixel_format) != 4:
            node.get_logger().error("Invalid pixel format size: must be a 4 character code (FOURCC).")
            pixel_format = ""
        try:
            source = VideoSource(device, (size[0], size[1]), pixel_format, interval[1] / interval[0])
        except LinkwrightError as error:
            _log_error(node, error)
            return
        rate_hz = 0.0 if interval == _DEFAULT_INTERVAL else interval[1] / interval[0]
        self._publish_from(source, rate_hz, encoding, frame_id, self._serve_info(url, Path(device).stem))


class UsbCam(_VideoCamera):
    """The node ``usb_cam_node_exe``. Without the camera, it ends.

    Raises:
        LinkwrightError: a parameter has an invalid value or type (NODE433, GRAPH201); OpenCV is missing (VISION101);
            the camera or file cannot be opened (VISION115).
    """

    DEFAULT_NAME, QUEUE_DEPTH = "usb_cam", 100

    def _start(self) -> None:
        node = self._node
        camera: str = node.declare_parameter("camera_name", "default_cam").value
        url: str = node.declare_parameter("camera_info_url", "").value
        rate_hz = check_positive(node, "framerate", node.declare_parameter("framerate", 30.0).value)
        frame_id: str = node.declare_parameter("frame_id", "default_cam").value
        height: int = node.declare_parameter("image_height", 480).value
        width: int = node.declare_parameter("image_width", 640).value
        io_method: str = node.declare_parameter("io_method", "mmap").value
        pixel_format: str = node.declare_parameter("pixel_format", "yuyv").value
        node.declare_parameter("av_device_format", "YUV422P")
        device: str = node.declare_parameter("video_device", "/dev/video0").value
        controls = {
            opencv_name: float(value)
            for name, (opencv_name, default) in _CONTROLS.items()
            if (value := node.declare_parameter(name, default).value) != default
        }
        log_unknown_parameters(node)
        for name, length in (("image_width", width), ("image_height", height)):
            check_positive(node, name, length)
        logger = node.get_logger()
        source = VideoSource(device, (width, height), "MJPG" if "mjpeg" in pixel_format else "", rate_hz)
        encoding = _ENCODINGS_BY_FORMAT.get(pixel_format)
        if encoding is None:
            warning = phrase(
                "parameter '{name}' cannot be '{value}': images are published with '{supported}'",
                name="pixel_format",
                value=pixel_format,
                supported="rgb8",
            )
            logger.warning(localized(warning))
            encoding = "rgb8"
        logger.info(
            f"Starting '{camera}' ({device}) at {width}x{height} via {io_method} ({pixel_format}) at {rate_hz:.0f} FPS"
        )
        if not source.is_file:
            for name in source.set_controls(controls):
                logger.warning(localized(phrase("the camera does not accept a value for {name}", name=name)))
        node.create_service(get_service("std_srvs/srv/SetBool"), "set_capture", self._set_capture)
        self._publish_from(source, rate_hz, encoding, frame_id, self._serve_info(url, camera))

    def _set_capture(self, request: Any, response: Any) -> Any:
        self._is_capturing = request.data
        response.message = "Start Capturing" if request.data else "Stop Capturing"
        return response


def create_image(frame: Frame, encoding: str) -> Any:
    """Return an image message with the pixels of an image in BGR and the encoding, without header.

    The width of an image in ``yuv422`` is even: an odd last column is left out.
    """
    cv2 = load_opencv()
    conversion = _CONVERSIONS[encoding]
    if "yuv422" in encoding:
        frame = frame[:, : frame.shape[1] // 2 * 2]
    pixels: NDArray[np.uint8] = np.ascontiguousarray(
        frame if conversion is None else cv2.cvtColor(frame, getattr(cv2, conversion))
    )
    image = get_message("sensor_msgs/msg/Image")(encoding=encoding)
    image.height, image.width = pixels.shape[:2]
    image.step = pixels.nbytes // image.height
    image.data = pixels.reshape(-1)
    return image


def _log_error(node: Node, error: LinkwrightError) -> None:
    diagnostic = error.diagnostics[0]
    node.get_logger().error(localized(diagnostic.message))
    if diagnostic.hint is not None:
        node.get_logger().info(localized(diagnostic.hint))
