"""Cameras with ground truth: ``segmentation_camera`` and ``boundingbox_camera``.

The plugin ``gz-sim-label-system`` of a model or visual contains its ``<label>``; anything else has the label 0.

Source: gz-sensors (topics, the channels of a label map).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from linkwright.graph.stepped.node import Output
from linkwright.messages import get_message
from linkwright.sdf.plugins import Plugin, library_name
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.parameters import NoParameters
from linkwright.simulation.plugins.sensors.camera import CAMERA_INFO_TYPE, IMAGE_TYPE, CameraPlugin, MountedCamera
from linkwright.simulation.plugins.sensors.images import Pixels, fill_camera_info, fill_image
from linkwright.simulation.plugins.sensors.part_values import find_part_values, get_closest_value
from linkwright.simulation.rendering.renderer import Channels
from linkwright.simulation.sensors.mount import GeomTable, get_part_name
from linkwright.simulation.simulation import Simulation

_LABEL_SYSTEM = "gz-sim-label-system"
_DETECTIONS_TYPE = "vision_msgs/msg/Detection2DArray"
_BOX_COLOR = (0, 255, 0)
_LABEL_COUNT = 256


class LabelTable:
    """The labels of all geoms in a simulation.

    Args:
        simulation: the simulation of the world.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._labels = GeomTable(simulation, self._compute_geom_labels)
        self._instances = GeomTable(simulation, self._compute_geom_instances)

    def labels(self, geoms: Pixels) -> Pixels:
        """Return the labels of geoms, in an array of the shape of `geoms`."""
        labels: Pixels = self._labels.array()[geoms].astype(np.uint8)
        return labels

    def get_instances(self, geoms: Pixels) -> Pixels:
        """Return the instance number of each geom's model, in an array of the shape of `geoms`.

        Numbers start at 1; geoms without a label have the number 0.
        """
        instances: Pixels = self._instances.array()[geoms].astype(np.uint16)
        return instances

    def _compute_geom_labels(self, names: list[str]) -> list[float]:
        labels = find_part_values(self._simulation, _read_label)
        return [float(get_closest_value(labels, get_part_name(name), 0)) for name in names]

    def _compute_geom_instances(self, names: list[str]) -> list[float]:
        labels = self._compute_geom_labels(names)
        models = [name.partition(SEPARATOR)[0] for name in names]
        instance_numbers: dict[str, int] = {}
        for model, label in zip(models, labels, strict=True):
            if label:
                instance_numbers.setdefault(model, len(instance_numbers) + 1)
        return [float(instance_numbers[model]) if label else 0.0 for model, label in zip(models, labels, strict=True)]


def _read_label(plugin: Plugin) -> int | None:
    element = plugin.element.first("label") if plugin.element is not None else None
    if element is not None and library_name(plugin.filename) == _LABEL_SYSTEM and element.text().strip().isdigit():
        return int(element.text()) % _LABEL_COUNT
    return None


class _LabelingCamera(CameraPlugin[NoParameters]):
    """The base class of cameras that need the labels of the visible geoms."""

    def create_sensor(self) -> None:
        """Create the camera and the table of labels."""
        super().create_sensor()
        self.labels = LabelTable(self.simulation)
        self.frame = self.cameras[0].description.optical_frame_id or self.gz_frame()

    def publish_colors(self, output: Output, color: Pixels) -> None:
        """Publish an RGB image."""
        message = self.message(IMAGE_TYPE, self.frame)
        fill_image(message, color, "rgb8")
        output.publish(message)

    def publish_info(self, output: Output, camera: MountedCamera) -> None:
        """Publish the ``CameraInfo`` if its topic has a subscription."""
        if output.is_wanted:
            message = self.message(CAMERA_INFO_TYPE, self.frame)
            fill_camera_info(message, camera.optics, camera.description.distortion)
            output.publish(message)


class GzSegmentation(_LabelingCamera):
    """The sensor ``segmentation_camera`` of gz, which publishes a label map and a colored map."""

    def create_publishers(self) -> None:
        """Create the publishers of the label map, the colored map and the camera info."""
        base = self.sensor.sensor.topic or self.gz_topic("segmentation")
        conventional_topic = "" if self.sensor.sensor.topic else "/segmentation"
        names = {
            leaf: f"{conventional_topic}/{leaf}" if conventional_topic else ""
            for leaf in ("labels_map", "colored_map", "camera_info")
        }
        self._maps = self.node.publisher(IMAGE_TYPE, f"{base}/labels_map", conventional_topic=names["labels_map"])
        self._colored = self.node.publisher(IMAGE_TYPE, f"{base}/colored_map", conventional_topic=names["colored_map"])
        self._info = self.node.publisher(
            CAMERA_INFO_TYPE, f"{base}/camera_info", conventional_topic=names["camera_info"]
        )
        self._colors = np.random.default_rng(0).integers(40, 256, (_LABEL_COUNT, 3), dtype=np.uint8)
        self._colors[0] = 0

    def is_wanted(self) -> bool:
        """Return whether a topic has a subscription."""
        return any(output.is_wanted for output in (self._maps, self._colored, self._info))

    def measure(self) -> None:
        """Render, and publish the maps and the camera info."""
        (camera, *_) = self.cameras
        self.publish_info(self._info, camera)
        if not (self._maps.is_wanted or self._colored.is_wanted):
            return
        geoms = self.render(camera, Channels.GEOMS).geoms
        labels, instances = self.labels.labels(geoms), self.labels.get_instances(geoms)  # type: ignore[arg-type]  # asked for
        if camera.description.segmentation_type in ("instance", "panoptic"):
            high, low = (instances >> 8).astype(np.uint8), (instances & 0xFF).astype(np.uint8)
            label_map, colored = (
                np.stack([low, high, labels], axis=-1),
                self._colors[(labels + 31 * low) % _LABEL_COUNT],
            )
            colored[labels == 0] = 0
        else:
            label_map, colored = np.stack([labels] * 3, axis=-1), self._colors[labels]
        if self._maps.is_wanted:
            self.publish_colors(self._maps, label_map)
        if self._colored.is_wanted:
            self.publish_colors(self._colored, colored)


class GzBoxes(_LabelingCamera):
    """The sensor ``boundingbox_camera`` of gz.

    The sensor publishes bounding boxes of the visible parts of labeled models, and an image with these boxes. Unlike
    in gz, boxes of the types ``full_2d`` and ``3d`` also cover only the visible parts.
    """

    def create_publishers(self) -> None:
        """Create the publishers of the boxes, the image with boxes and the camera info."""
        topic = self.sensor.sensor.topic or self.gz_topic("boundingbox")
        conventional_topic = "" if self.sensor.sensor.topic else "/boundingbox"
        self._boxes = self.node.publisher(_DETECTIONS_TYPE, topic, conventional_topic=conventional_topic)
        self._images = self.node.publisher(
            IMAGE_TYPE, f"{topic}_image", conventional_topic=f"{conventional_topic}_image" if conventional_topic else ""
        )
        parent_topic, slash, _ = topic.rpartition("/")
        self._info = self.node.publisher(CAMERA_INFO_TYPE, f"{parent_topic}{slash}camera_info")

    def is_wanted(self) -> bool:
        """Return whether a topic has a subscription."""
        return any(output.is_wanted for output in (self._boxes, self._images, self._info))

    def measure(self) -> None:
        """Render, and publish the boxes, the image with boxes and the camera info."""
        (camera, *_) = self.cameras
        self.publish_info(self._info, camera)
        if not (self._boxes.is_wanted or self._images.is_wanted):
            return
        channels = Channels.GEOMS | (Channels.COLOR if self._images.is_wanted else Channels(0))
        rendered = self.render(camera, channels)
        boxes = list(self._find_boxes(rendered.geoms))
        if self._boxes.is_wanted:
            message = self.message(_DETECTIONS_TYPE, self.frame)
            message.detections = [self._create_detection(message.header, *box) for box in boxes]
            self._boxes.publish(message)
        if rendered.color is not None:
            color = rendered.color.copy()
            for _, left, top, right, bottom in boxes:
                color[[top, bottom], left : right + 1] = _BOX_COLOR
                color[top : bottom + 1, [left, right]] = _BOX_COLOR
            self.publish_colors(self._images, color)

    def _find_boxes(self, geoms: Any) -> Iterator[tuple[int, int, int, int, int]]:
        """Yield the label, left, top, right and bottom of each box, in pixels.

        The box includes all four edges.
        """
        labels, instances = self.labels.labels(geoms), self.labels.get_instances(geoms)
        for instance in np.unique(instances[instances > 0]):
            for label in np.unique(labels[(instances == instance) & (labels > 0)]):
                rows, columns = np.nonzero((instances == instance) & (labels == label))
                yield int(label), int(columns.min()), int(rows.min()), int(columns.max()), int(rows.max())

    def _create_detection(self, header: Any, label: int, left: int, top: int, right: int, bottom: int) -> Any:
        detection = get_message("vision_msgs/msg/Detection2D")(header=header)
        result = get_message("vision_msgs/msg/ObjectHypothesisWithPose")()
        result.hypothesis.class_id, result.hypothesis.score = str(label), 1.0
        detection.results = [result]
        box = detection.bbox
        box.center.position.x, box.center.position.y = (left + right + 1) / 2, (top + bottom + 1) / 2
        box.size_x, box.size_y = float(right + 1 - left), float(bottom + 1 - top)
        return detection
