"""Entities in a box: ``libContainPlugin.so``.

Source: Gazebo Classic (parameters, defaults, formulas). The topic and the service of Gazebo's transport are
``std_msgs/msg/Bool`` and ``std_srvs/srv/SetBool``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.geometry.single import Transform, Vector3, compose, invert, rotate
from linkwright.messages import get_message
from linkwright.sdf.frames import transform_of
from linkwright.sdf.poses import POSE
from linkwright.sdf.reader import read_element
from linkwright.sdf.report import SdfReport
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin


@dataclass(frozen=True, kw_only=True)
class ContainParameters:
    """Parameters of ``libContainPlugin.so``."""

    entity: str = parameter()
    namespace: str = parameter()
    enabled: bool = True


class Container(SimulatedPlugin[ContainParameters]):
    """The substitute for ``libContainPlugin.so``: publishes when the origin of an entity enters or leaves a box."""

    PARAMETERS = ContainParameters
    IGNORED = ("pose", "geometry")
    CARRIED = ("_is_enabled", "_contains")

    def start(self) -> None:
        """Read the box, and create the topic and the service.

        Raises:
            LinkwrightError: SIM160, the box is missing or not valid.
        """
        element, node, prefix = self.context.element, self.node, f"/{self.parameters.namespace.strip('/')}"
        pose_element = None if element is None else element.first("pose")
        geometry = None if element is None else element.first("geometry")
        size = self.text_in(None if geometry is None else geometry.first("box"), "size").split()
        try:
            x, y, z = (float(word) for word in size)
        except ValueError as error:
            raise self.parameter_error(
                phrase("plugin '{plugin}': <geometry> needs a <box> with a <size>", plugin=self.context.name)
            ) from error
        if pose_element is None:
            raise self.parameter_error(phrase("plugin '{plugin}' needs a <pose> for its box", plugin=self.context.name))
        raw_pose = read_element(pose_element, POSE, SdfReport())
        self._size: Vector3 = x, y, z
        self._box = transform_of(raw_pose.pose)
        self._frame = raw_pose.relative_to or pose_element.attributes.get("frame", "")
        self._output = node.publisher("std_msgs/msg/Bool", f"{prefix}/contain")
        node.service("std_srvs/srv/SetBool", f"{prefix}/enable", self._on_enable)
        self.reset()
        self.every(0.0, self._update)

    def reset(self) -> None:
        """Restore whether the plugin is enabled, and forget whether the box contains the entity."""
        self._is_enabled = self.parameters.enabled
        self._contains: bool | None = None

    def _on_enable(self, request: Any, response: Any) -> Any:
        """Enable or disable the plugin; it fails if nothing changes."""
        response.success = self._is_enabled != request.data
        if response.success:
            self._is_enabled, self._contains = request.data, None
        return response

    def _update(self) -> None:
        if not self._is_enabled:
            return
        contains = self._find_contains()
        if contains != self._contains:
            self._contains = contains
            self._output.publish(get_message("std_msgs/msg/Bool")(data=contains))

    def _find_contains(self) -> bool:
        """Return whether the box contains the origin of the entity; False if the entity or the frame is missing."""
        entity = self._find_pose(self.parameters.entity)
        frame = self._find_pose(self._frame) if self._frame else (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
        if entity is None or frame is None:
            return False
        box = invert(compose(frame, self._box))
        offset = rotate(box[3:], (entity[0], entity[1], entity[2]))
        return all(
            abs(origin + component) <= 0.5 * size
            for origin, component, size in zip(box[:3], offset, self._size, strict=True)
        )

    def _find_pose(self, name: str) -> Transform | None:
        """Return the pose of a model or a link in the world, or None if there is none."""
        scene = self.simulation.scene
        if name in scene.models:
            return self.simulation.model_pose(name)
        return self.simulation.link_pose(name) if name in scene.bodies else None
