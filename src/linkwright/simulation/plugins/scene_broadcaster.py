"""Poses of all entities in a world: ``gz-sim-scene-broadcaster-system``.

Source: gz-sim (topics, the order of entities, rates, parameters). Entities have their local names, without the names of
the models that contain them, and poses relative to their parents. As with a bridge, ``frame_id`` stays empty. A tf
listener that receives these topics ignores such transforms, because otherwise the frames of links would have two
parents (decision 0096).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from linkwright.geometry.single import Transform
from linkwright.graph.stepped.node import Output
from linkwright.messages.tf_message import TFMessage, TransformBatch
from linkwright.sdf.frames import Frames
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.parts import PartKind, PoseFunction, find_parts
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_ALL_POSES_RATE_HZ = 60.0
"""The rate in Hz at which the poses of all entities are published."""
_KIND_ORDER = (
    {PartKind.MODEL, PartKind.NESTED_MODEL},
    {PartKind.LINK},
    {PartKind.VISUAL},
)


@dataclass(frozen=True, kw_only=True)
class SceneParameters:
    """Parameters of ``gz-sim-scene-broadcaster-system``."""

    dynamic_pose_hertz: float = 60.0


@dataclass(frozen=True, slots=True)
class _Entities:
    """Entities whose poses are published in one message.

    Attributes:
        names: the names of the entities.
        poses: the pose of each static entity, and a function that returns the current pose of each other entity.
    """

    names: tuple[str, ...]
    poses: Sequence[Transform | PoseFunction]


class GzSceneBroadcaster(SimulatedPlugin[SceneParameters]):
    """The substitute for ``gz-sim-scene-broadcaster-system``."""

    PARAMETERS = SceneParameters
    IGNORED = ("state_hertz",)

    def start(self) -> None:
        """Create the publishers of the poses of all entities and of moving entities."""
        world_topic = f"/world/{self.context.world.name}"
        self._revision = -1
        self._all_entities = self._moving_entities = _Entities((), ())
        all_output = self.node.publisher("tf2_msgs/msg/TFMessage", f"{world_topic}/pose/info")
        dynamic_output = self.node.publisher("tf2_msgs/msg/TFMessage", f"{world_topic}/dynamic_pose/info")
        self.every(_ALL_POSES_RATE_HZ, lambda: self._publish(all_output, moving_only=False))
        self.every(
            max(self.parameters.dynamic_pose_hertz, 0.0), lambda: self._publish(dynamic_output, moving_only=True)
        )

    def _publish(self, output: Output, *, moving_only: bool) -> None:
        if not output.is_wanted:
            return
        if self._revision != self.simulation.revision:
            self._collect_entities()
        entities = self._moving_entities if moving_only else self._all_entities
        poses = np.array([pose() if callable(pose) else pose for pose in entities.poses], dtype=float).reshape(-1, 7)
        count = len(entities.names)
        output.publish(TFMessage(batch=TransformBatch(("",) * count, entities.names, self.simulation.time, poses)))

    def _collect_entities(self) -> None:
        """Update the list of all entities and the list of moving entities.

        Static entities get constant poses.
        """
        self.simulation.refresh()
        self._revision = self.simulation.revision
        models = self.simulation.scene.models.values()
        parts = [
            (part, model.model.static)
            for model in models
            for part in find_parts(self.simulation, model.model, model.name)
        ]
        ordered_parts = [(part, is_static) for kinds in _KIND_ORDER for part, is_static in parts if part.kind in kinds]
        world = self.simulation.world
        lights = [(light.name, Frames(world).placed(light.pose)) for light in world.lights]
        self._all_entities = _Entities(
            (*(_to_local_name(part.name) for part, _ in ordered_parts), *(name for name, _ in lights)),
            (
                *(
                    part.pose() if is_static or part.kind is PartKind.VISUAL else part.pose
                    for part, is_static in ordered_parts
                ),
                *(pose for _, pose in lights),
            ),
        )
        moving_parts = [part for part, is_static in ordered_parts if not is_static and part.kind is not PartKind.VISUAL]
        self._moving_entities = _Entities(
            tuple(_to_local_name(part.name) for part in moving_parts), [part.pose for part in moving_parts]
        )


def _to_local_name(name: str) -> str:
    return name.rpartition(SEPARATOR)[2]
