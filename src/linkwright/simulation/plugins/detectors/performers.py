"""Performers that enter or leave a region: ``gz-sim-performer-detector-system``.

The region is a box around the model of the plugin. Performers are models, named with a box by the ``<performer>``
elements in the plugin ``gz::sim`` of the world. Neither box turns with its model.

Source: gz-sim (parameters, topic, the boxes). As a bridge does, the message leaves out whether the performer enters or
leaves, how many performers are in the region, and the ``<header_data>``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from linkwright.control.odometry import transform_stamped
from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Transform, compose, invert, rotate
from linkwright.messages import Header
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.xmltree import Element


@dataclass(frozen=True, kw_only=True)
class PerformerDetectorParameters:
    """Parameters of ``gz-sim-performer-detector-system``."""

    topic: str = ""


@dataclass(frozen=True, slots=True)
class _Performer:
    """A model that is detected, with the size of its box in m."""

    model: str
    size: Array


class GzPerformerDetector(SimulatedPlugin[PerformerDetectorParameters]):
    """The substitute for ``gz-sim-performer-detector-system``."""

    PARAMETERS = PerformerDetectorParameters
    IGNORED = ("geometry", "pose", "header_data")  # the first two are read by start
    CARRIED = ("_detected",)

    def start(self) -> None:
        """Read the region and the performers, and create the topic.

        Raises:
            LinkwrightError: SIM160, the region or the box of a performer is missing or not valid.
        """
        element = self.context.element
        self._size = self._read_box(element)
        offset = [float(word) for word in self.text_in(element, "pose").split()[:3]] or [0.0, 0.0, 0.0]
        self._offset = (offset[0], offset[1], offset[2])
        self._performers = list(self._read_performers())
        self.reset()
        topic = self.parameters.topic or f"/model/{self.context.path}/performer_detector/status"
        self._output = self.node.publisher("geometry_msgs/msg/TransformStamped", topic)
        self.every(0.0, self._detect)

    def reset(self) -> None:
        """Clear the set of performers in the region."""
        self._detected: set[str] = set()

    def _read_box(self, parent: Element | None) -> Array:
        geometry = None if parent is None else parent.first("geometry")
        box = None if geometry is None else geometry.first("box")
        try:
            x, y, z = (float(word) for word in self.text_in(box, "size").split())
        except ValueError as error:
            raise self.parameter_error(
                phrase("plugin '{plugin}': <geometry> needs a <box> with a <size>", plugin=self.context.name)
            ) from error
        return np.array((x, y, z))

    def _read_performers(self) -> Iterator[_Performer]:
        world = self.context.world.element
        for plugin in () if world is None else world.elements("plugin"):
            for performer in plugin.elements("performer"):
                yield _Performer(self.text_in(performer, "ref"), self._read_box(performer))

    def _detect(self) -> None:
        simulation = self.simulation
        pose = simulation.model_pose(self.context.path)
        center = np.array(pose[:3]) + rotate(pose[3:], self._offset)
        for performer in self._performers:
            if performer.model not in simulation.scene.models:
                continue
            performer_pose = simulation.model_pose(performer.model)
            distance = np.abs(np.array(performer_pose[:3]) - center)
            is_inside = bool((distance <= 0.5 * (self._size + performer.size)).all())
            if is_inside != (performer.model in self._detected):
                self._detected ^= {performer.model}
                self._publish(performer.model, compose(invert(pose), performer_pose))

    def _publish(self, performer: str, pose: Transform) -> None:
        header = Header(stamp=self.stamp(), frame_id=self.context.path)
        self._output.publish(transform_stamped(header, performer, pose))
