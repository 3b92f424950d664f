"""Poses of the parts of a model: ``gz-sim-pose-publisher-system``.

Source: gz-sim (parameters, topics, defaults, which parts the topic of static poses contains). Messages and frame names
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
from linkwright.simulation.plugins.parts import Part, PartKind, parts_of
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_QUEUE = 100
"""The depth of the queue: one message for each part, where they are not published together."""


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
        parameters, model, path = self.parameters, self.place.model, self.place.path
        if model is None:
            return
        kinds = self._kinds()
        parts = [part for part in parts_of(self.simulation, model, path) if part.kind in kinds]
        topic = f"/model/{path.replace(SEPARATOR, '/model/')}/pose"
        if parameters.static_publisher:
            moving = self._links_with_joints(model)
            resting = [part for part in parts if part.kind is not PartKind.LINK or part.name not in moving]
            parts = [part for part in parts if part not in resting]
            self._publish_at(
                parameters.static_update_frequency or parameters.update_frequency, f"{topic}_static", resting
            )
        self._publish_at(parameters.update_frequency, topic, parts)

    def _kinds(self) -> set[PartKind]:
        """Return the kinds of parts that the parameters select."""
        parameters = self.parameters
        nested = parameters.publish_nested_model_pose
        wanted = {
            PartKind.MODEL: nested if parameters.publish_model_pose is None else parameters.publish_model_pose,
            PartKind.NESTED_MODEL: nested,
            PartKind.LINK: parameters.publish_link_pose,
            PartKind.VISUAL: parameters.publish_visual_pose,
            PartKind.COLLISION: parameters.publish_collision_pose,
            PartKind.SENSOR: parameters.publish_sensor_pose,
        }
        return {kind for kind, is_wanted in wanted.items() if is_wanted}

    def _publish_at(self, rate: float, topic: str, parts: list[Part]) -> None:
        kind = "tf2_msgs/msg/TFMessage" if self.parameters.use_pose_vector_msg else "geometry_msgs/msg/TransformStamped"
        output = self.node.publisher(kind, topic, _QUEUE)
        self.every(max(rate, 0.0), lambda: self._publish(output, parts))

    def _publish(self, output: Output, parts: list[Part]) -> None:
        if not output.is_wanted:
            return
        stamp, sent = self.stamp(), list[Any]()
        for part in parts:
            parent, child = (name.replace(SEPARATOR, "/") for name in (part.parent, part.name))
            sent.append(transform_stamped(Header(stamp, parent), child, part.pose()))
        if self.parameters.use_pose_vector_msg:
            output.publish(get_message("tf2_msgs/msg/TFMessage")(transforms=sent))
            return
        for message in sent:
            output.publish(message)

    def _links_with_joints(self, model: Model) -> set[str]:
        """Return the links of the model's movable joints, except the link with which its frame moves."""
        begin = f"{self.place.path}{SEPARATOR}"
        moving = {
            link
            for name, placed in self.simulation.scene.joints.items()
            if name.startswith(begin) and placed.joint.type != "fixed"
            for link in (placed.parent, placed.child)
        }
        return moving - {f"{begin}{model.canonical_link}" if model.canonical_link else self.first_link}
