"""Poses of the parts of a model: ``gz-sim-pose-publisher-system``.

Source: gz-sim (parameters, topics, defaults, which parts are on the topic of those that stay). Messages and the names
of frames are those that a bridge makes: ``tf2_msgs/msg/TFMessage`` of gz's Pose_V,
``geometry_msgs/msg/TransformStamped`` of its Pose, and ``robot/link`` of ``robot::link``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

from linkwright.geometry.single import Transform, compose, invert
from linkwright.messages import Header, get_message
from linkwright.sdf.frames import Frames
from linkwright.sdf.models import Model
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.node import Output
from linkwright.simulation.plugins.odometry import transform_stamped
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


@dataclass(frozen=True, slots=True)
class _Part:
    """Something with a pose.

    Attributes:
        name: with the models and the link that it is in, ``robot::arm::link``.
        parent: that of the model, link or world which its pose is told in.
        pose: gives that pose now.
        moves: whether a joint moves it in its model.
    """

    name: str
    parent: str
    pose: Callable[[], Transform]
    moves: bool = False


class GzPoses(SimulatedPlugin[PoseParameters]):
    """``gz-sim-pose-publisher-system``."""

    PARAMETERS = PoseParameters

    def start(self) -> None:
        """Find the parts, and make the topics."""
        said, model, path = self.parameters, self.place.model, self.place.path
        if model is None:
            return
        self._moving = self._moved_by_joints(model)
        parts = list(self._parts(model, path, Frames(model), self._frame_of(model, path)))
        topic = f"/model/{path.replace(SEPARATOR, '/model/')}/pose"
        if said.static_publisher:
            resting = [part for part in parts if not part.moves]
            parts = [part for part in parts if part.moves]
            self._publish_at(said.static_update_frequency or said.update_frequency, f"{topic}_static", resting)
        self._publish_at(said.update_frequency, topic, parts)

    def _publish_at(self, rate: float, topic: str, parts: list[_Part]) -> None:
        kind = "tf2_msgs/msg/TFMessage" if self.parameters.use_pose_vector_msg else "geometry_msgs/msg/TransformStamped"
        output = self.node.publisher(kind, topic, _QUEUE)
        self.every(max(rate, 0.0), lambda: self._publish(output, parts))

    def _publish(self, output: Output, parts: list[_Part]) -> None:
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

    def _moved_by_joints(self, model: Model) -> set[str]:
        """The links with joints, without the one that the model's frame moves with."""
        begin = f"{self.place.path}{SEPARATOR}"
        moving = {
            link
            for name, placed in self.simulation.scene.joints.items()
            if name.startswith(begin) and placed.joint.type != "fixed"
            for link in (placed.parent, placed.child)
        }
        return moving - {f"{begin}{model.canonical_link}" if model.canonical_link else self.first_link}

    def _frame_of(self, model: Model, path: str) -> Callable[[], Transform]:
        """The pose in the world of the model's frame in which the plugin stands."""
        top, _, inside = path.partition(SEPARATOR)
        if not inside or not model.links:
            return lambda: self.simulation.model_pose(top)
        frames = Frames(model)
        return self._moving_with(f"{path}{SEPARATOR}{model.links[0].name}", frames.pose(model.links[0].name))

    def _moving_with(self, link: str, place: Transform) -> Callable[[], Transform]:
        """The pose in the world of a frame that is fixed to a link."""
        back = invert(place)
        return lambda: compose(self.simulation.link_pose(link), back)

    def _parts(self, model: Model, path: str, frames: Frames, place: Callable[[], Transform]) -> Iterator[_Part]:
        """The parts of a model whose frame is at a place in the world."""
        said = self.parameters
        whole = said.publish_nested_model_pose if said.publish_model_pose is None else said.publish_model_pose
        if whole and SEPARATOR not in path:
            yield _Part(path, self.place.world.name, place)
        for link in model.links:
            name = f"{path}{SEPARATOR}{link.name}"
            if said.publish_link_pose:
                link_pose = partial(self.simulation.link_pose, name)
                yield _Part(name, path, partial(_between, place, link_pose), name in self._moving)
            for wanted, parts in (
                (said.publish_visual_pose, link.visuals),
                (said.publish_collision_pose, link.collisions),
                (said.publish_sensor_pose, link.sensors),
            ):
                for part in parts if wanted else ():
                    pose = frames.in_link(part.pose, link.name)
                    yield _Part(f"{name}{SEPARATOR}{part.name}", name, partial(_same, pose))
        for inner in model.models:
            name, inside = f"{path}{SEPARATOR}{inner.name}", frames.inside(inner.name)
            first = next((each.name for each in inner.links), "")
            if not first:
                continue
            deeper = self._moving_with(f"{name}{SEPARATOR}{first}", inside.pose(first))
            if said.publish_nested_model_pose:
                yield _Part(name, path, partial(_between, place, deeper))
            yield from self._parts(inner, name, inside, deeper)


def _same(pose: Transform) -> Transform:
    return pose


def _between(outer: Callable[[], Transform], inner: Callable[[], Transform]) -> Transform:
    """The pose of one part in the frame of another."""
    return compose(invert(outer()), inner())
