"""rviz_default_plugins/Camera."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from linkwright.viewer.config.property_store import qos_of
from linkwright.viewer.config.rviz_config import DisplayConfig
from linkwright.viewer.config.schema import PropertySpec, Schema, topic_spec
from linkwright.viewer.displays.base.data_display import Pose
from linkwright.viewer.displays.base.display import ViewerDisplay
from linkwright.viewer.displays.base.host import DisplayHost
from linkwright.viewer.displays.base.image_topic import ImageTopicDisplay
from linkwright.viewer.displays.base.side_topic import SideTopic, camera_info_topic
from linkwright.viewer.displays.base.topic_display import TOPIC
from linkwright.viewer.protocol.images import CameraModel

_INFO = "Camera Info"
_MOST_WAITING = 10

_SPECS: Schema = (
    topic_spec(description="sensor_msgs/msg/Image; its camera_info is looked for beside it."),
    PropertySpec(
        "Image Rendering",
        "enum",
        "background and overlay",
        "Draw the image behind everything else, over it, or both.",
        options=("background", "overlay", "background and overlay"),
    ),
    PropertySpec("Overlay Alpha", "float", 0.5, "Opacity of the image over the scene.", minimum=0.0, maximum=1.0),
    PropertySpec(
        "Zoom Factor",
        "float",
        1.0,
        "Less than 1 shows more of the world than the image does, more than 1 less.",
        minimum=0.00001,
        maximum=100000.0,
    ),
    PropertySpec(
        "Far Plane Distance",
        "float",
        100.0,
        "What is farther away is not drawn, in metres.",
        minimum=0.00001,
        maximum=100000.0,
    ),
)


class CameraDisplay(ImageTopicDisplay):
    """The scene as a camera sees it, with the camera's image behind or over it, in a panel of its own."""

    CLASS = "rviz_default_plugins/Camera"
    SCHEMA = _SPECS

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        self._boxes: Schema = ()
        super().__init__(host, identity, config)
        self._infos = SideTopic(host, "sensor_msgs/msg/CameraInfo", self._info_received)
        self._info: Any = None

    def schema(self) -> Schema:
        """The properties, with a box for each other display."""
        whole = PropertySpec(
            "Visibility",
            "bool",
            True,
            "Which displays are seen through the camera.",
            children=self._boxes,
            nested=True,
        )
        return (*_SPECS, whole)

    def arranged(self, displays: Sequence[ViewerDisplay]) -> None:
        """Offer a box for each of the other displays."""
        boxes = self._boxes_of(displays, None)
        if boxes != self._boxes:
            self._boxes = boxes
            self.publish_properties()

    def _boxes_of(self, displays: Sequence[ViewerDisplay], group: DisplayConfig | None) -> Schema:
        """A box for each display of a group, by its name; those in groups below the group's box."""
        found: dict[str, PropertySpec] = {}
        for display in displays:
            config = display.config
            if config.group is not group or display is self or config.name in found:
                continue
            inside = self._boxes_of(displays, config) if config.is_group else ()
            text = "Show this display through the camera."
            found[config.name] = PropertySpec(config.name, "bool", True, text, children=inside, nested=config.is_group)
        return tuple(found.values())

    def most_waiting(self) -> int:
        """RViz's number; the display has no property for it."""
        return _MOST_WAITING

    def take_image(self, message: Any, pose: Pose | None) -> None:
        """Show an image, once it is known how the camera looks."""
        camera = self._model(message)
        self.show_image(message, camera, pose)

    def time_changed(self) -> None:
        """Show what came while time stood still."""
        self._infos.go_on()
        super().time_changed()

    def reset(self) -> None:
        """Forget image and camera."""
        if self.last is None:
            self._info = None
        super().reset()

    def _subscribe(self) -> None:
        super()._subscribe()
        topic = self.properties.text(TOPIC).strip()
        if not topic:
            return
        info = camera_info_topic(topic)
        problem = self._infos.listen(info, qos_of(self.properties))
        text = problem or f"No CameraInfo received on [{info}]. Topic may not exist."
        self.say(_INFO, "error" if problem else "warn", text)

    def _unsubscribe(self) -> None:
        super()._unsubscribe()
        self._infos.close()

    def _info_received(self, info: Any) -> None:
        first = self._info is None
        self._info = info
        if first:
            self.show_again()

    def _model(self, image: Any) -> CameraModel | None:
        """The camera of an image; None, and the status says why, without one."""
        info = self._info
        if info is None:
            return None
        numbers = [np.asarray(part, np.float64) for part in (info.d, info.k, info.r, info.p)]
        if not all(np.isfinite(part).all() for part in numbers):
            self.say(_INFO, "error", "Contains invalid floating point values (nans or infs)")
            return None
        width = info.width or getattr(image, "width", 0)
        height = info.height or getattr(image, "height", 0)
        if width == 0 or height == 0:
            text = "Could not determine width/height of image due to malformed CameraInfo (either width or height is 0)"
            self.say(_INFO, "error", text)
            return None
        p = numbers[3]
        if p[0] == 0.0 or p[5] == 0.0:
            text = "CameraInfo/P resulted in an invalid position calculation (nans or infs)"
            self.say(_INFO, "error", text)
            return None
        self.say(_INFO, "ok", "OK")
        return CameraModel(
            width=float(width),
            height=float(height),
            focal_x=float(p[0]),
            focal_y=float(p[5]),
            centre_x=float(p[2]),
            centre_y=float(p[6]),
            offset_x=float(-p[3] / p[0]),
            offset_y=float(-p[7] / p[5]),
        )
