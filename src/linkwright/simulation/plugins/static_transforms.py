"""Static transforms of a simulator's sensors on ``/tf_static``: ``libMRSGazeboStaticTransformRepublisher.so``.

Source: mrs_gazebo_common_resources (topics; the first transform of a message decides whether its frames are new).
"""

from __future__ import annotations

from typing import Any

from linkwright.graph.qos.profile import DurabilityPolicy, QoSProfile
from linkwright.messages import get_message
from linkwright.simulation.plugins.parameters import NoParameters
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_TYPE = "tf2_msgs/msg/TFMessage"


class StaticTransforms(SimulatedPlugin[NoParameters]):
    """The substitute for ``libMRSGazeboStaticTransformRepublisher.so``.

    The transforms of ``/tf_gazebo_static`` are collected and published on ``/tf_static``, whose latest message is kept
    for nodes that start later.
    """

    CARRIED = ("_transforms",)

    def start(self) -> None:
        """Create the publisher, and subscribe to the transforms of sensors."""
        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._transforms: list[Any] = []
        self._output = self.node.publisher(_TYPE, "/tf_static", qos)
        self.node.subscribe(_TYPE, "/tf_gazebo_static", self._on_transforms)

    def _on_transforms(self, message: Any) -> None:
        """Add the transforms of a message, unless the frame of the first one is known."""
        known_frames = {transform.child_frame_id for transform in self._transforms}
        if message.transforms and message.transforms[0].child_frame_id not in known_frames:
            self._transforms += message.transforms
            self._output.publish(get_message(_TYPE)(transforms=list(self._transforms)))
