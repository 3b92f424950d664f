"""twist_stamper and twist_unstamper, which convert velocities between Twist and TwistStamped.

Topics and parameters are those of the package twist_stamper: ``cmd_vel_in``, ``cmd_vel_out`` and ``frame_id``. Unlike
its nodes, these publish a stop when the publisher of the last velocity disappears.
"""

from __future__ import annotations

from functools import partial
from typing import Any, ClassVar

from linkwright.graph import Graph, Subscription
from linkwright.graph.endpoints.command_disputes import DisputeMonitor
from linkwright.graph.endpoints.command_guard import CommandGuard
from linkwright.messages import Header, get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.standstill import send_stop
from linkwright.nodes.velocity_topic import TWIST, TWIST_STAMPED

_QUEUE_DEPTH = 10


class TwistUnstamper(SingleNode):
    """The running twist_unstamper, which publishes the velocities of TwistStamped as Twist."""

    DEFAULT_NAME: ClassVar[str] = "twist_unstamper"
    INPUT_TYPE: ClassVar[str] = TWIST_STAMPED
    OUTPUT_TYPE: ClassVar[str] = TWIST

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            self.declare_parameters()
            self._publisher: Any = self._node.create_publisher(self.OUTPUT_TYPE, "cmd_vel_out", _QUEUE_DEPTH)
            guard = CommandGuard(partial(send_stop, self._node, self._publisher), DisputeMonitor.of(self._node))
            on_velocity = guard.tracking_callback(lambda message: self._publisher.publish(self.convert(message)))
            velocities: Subscription[Any] = self._node.create_subscription(
                self.INPUT_TYPE, "cmd_vel_in", on_velocity, _QUEUE_DEPTH
            )
            guard.watch(velocities)

    def declare_parameters(self) -> None:
        """Declare the parameters of the node."""

    def convert(self, message: Any) -> Any:
        """Return the message to publish for a received message."""
        return message.twist


class TwistStamper(TwistUnstamper):
    """The running twist_stamper, which publishes Twist as TwistStamped with the time of receipt."""

    DEFAULT_NAME = "twist_stamper"
    INPUT_TYPE = TWIST
    OUTPUT_TYPE = TWIST_STAMPED

    def declare_parameters(self) -> None:
        """Declare ``frame_id``, the frame of the published velocities."""
        self._frame_id = str(self._node.declare_parameter("frame_id", "").value)

    def convert(self, message: Any) -> Any:
        """Return a velocity with a stamp and a frame."""
        header = Header(stamp=self._node.get_clock().now().to_msg(), frame_id=self._frame_id)
        return get_message(TWIST_STAMPED)(header=header, twist=message)
