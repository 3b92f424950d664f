"""Poses of the parts of a model: ``gz-sim-pose-publisher-system``.

Source: gz-sim (parameters, topics, defaults, which parts are in the topic of static poses). Messages and frame names
are the ones that a bridge produces: ``tf2_msgs/msg/TFMessage`` for gz's Pose_V, ``geometry_msgs/msg/TransformStamped``
for its Pose, and ``robot/link`` for ``robot::link``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from linkwright.control.odometry import transform_stamped
from linkwright.graph.stepped.node import Output
from linkwright.messages import Header, get_message
from linkwright.sdf.models import Model
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.parts import Part, PartKind, find_parts
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_QUEUE_DEPTH = 100
"""The depth of the queue, for one message per part if the parts are published separately."""


@dataclass(frozen=True, kw_only=True)
class PoseParameters:
    """Parameters of ``gz-sim-pose-publisher-system``."""

    publish_link_pose: bool = True
    publish_visual_pose: bool = False
    publish_collision_pose: bool = False
    publish_sensor_pose: bool = False
    publish_nested_model_pose: bool = False
    publish_model_pose: bool | None = None
    use_pose_vector_msg: bool = False
    static_publisher: bool = False
    update_frequency: float = -1.0
    static_update_frequency: float = 0.0


class GzPoses(SimulatedPlugin[PoseParameters]):
    """The substitute for ``gz-sim-pose-publisher-system``."""

    PARAMETERS = PoseParameters

    def start(self) -> None:
        """Find the parts to publish, and create the topics of moving and static parts."""
        parameters, model, path = self.parameters, self.context.model, self.context.path
        if model is None:
            return
        selected_kinds = self._select_kinds()
        parts = [part for part in find_parts(self.simulation, model, path) if part.kind in selected_kinds]
        topic = f"/model/{path.replace(SEPARATOR, '/model/')}/pose"
        if parameters.static_publisher:
            moving_links = self._find_links_with_joints(model)
            static_parts = [part for part in parts if part.kind is not PartKind.LINK or part.name not in moving_links]
            parts = [part for part in parts if part not in static_parts]
            self._publish_at(
                parameters.static_update_frequency or parameters.update_frequency, f"{topic}_static", static_parts
            )
        self._publish_at(parameters.update_frequency, topic, parts)

    def _select_kinds(self) -> set[PartKind]:
        """Return the kinds of parts that the parameters select."""
        parameters = self.parameters
        publishes_nested = parameters.publish_nested_model_pose
        selection = {
            PartKind.MODEL: publishes_nested
            if parameters.publish_model_pose is None
            else parameters.publish_model_pose,
            PartKind.NESTED_MODEL: publishes_nested,
            PartKind.LINK: parameters.publish_link_pose,
            PartKind.VISUAL: parameters.publish_visual_pose,
            PartKind.COLLISION: parameters.publish_collision_pose,
            PartKind.SENSOR: parameters.publish_sensor_pose,
        }
        return {kind for kind, is_selected in selection.items() if is_selected}

    def _publish_at(self, rate: float, topic: str, parts: list[Part]) -> None:
        message_type = (
            "tf2_msgs/msg/TFMessage" if self.parameters.use_pose_vector_msg else "geometry_msgs/msg/TransformStamped"
        )
        output = self.node.publisher(message_type, topic, _QUEUE_DEPTH)
        self.every(max(rate, 0.0), lambda: self._publish(output, parts))

    def _publish(self, output: Output, parts: list[Part]) -> None:
        if not output.is_wanted:
            return
        stamp, messages = self.stamp(), list[Any]()
        for part in parts:
            parent, child = (name.replace(SEPARATOR, "/") for name in (part.parent, part.name))
            messages.append(transform_stamped(Header(stamp=stamp, frame_id=parent), child, part.pose()))
        if self.parameters.use_pose_vector_msg:
            output.publish(get_message("tf2_msgs/msg/TFMessage")(transforms=messages))
            return
        for message in messages:
            output.publish(message)

    def _find_links_with_joints(self, model: Model) -> set[str]:
        """Return the links of the model's movable joints, except the link with the model's frame."""
        prefix = f"{self.context.path}{SEPARATOR}"
        moving = {
            link
            for name, scene_joint in self.simulation.scene.joints.items()
            if name.startswith(prefix) and scene_joint.joint.type != "fixed"
            for link in (scene_joint.parent, scene_joint.child)
        }
        return moving - {f"{prefix}{model.canonical_link}" if model.canonical_link else self.first_link}
