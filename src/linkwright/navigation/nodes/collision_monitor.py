"""nav2's collision_monitor, which slows down or stops the robot near obstacles.

The node has nav2's parameters, topics and rules, for Humble and Jazzy. Deliberate differences: unless
``enable_stamped_cmd_vel`` is set, the node accepts Twist and TwistStamped, and publishes the type that subscribers
expect. Unlike in Humble, the robot stops if a sensor stops publishing or the publisher of commands disappears. Sensors
of the types ``polygon`` and ``costmap`` are not supported. ``transform_tolerance`` has no effect: data are queued until
their transform is available.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.graph import EndpointInfo, Subscription
from linkwright.graph.endpoints.command_disputes import DisputeMonitor
from linkwright.graph.endpoints.command_guard import CommandGuard, describe_lost_publisher
from linkwright.graph.transforms.core import BufferCore
from linkwright.graph.transforms.listener import TransformListener
from linkwright.messages import get_message
from linkwright.navigation.behaviors.zones import Verdict, ZoneAction, limit_by_zones
from linkwright.navigation.following.follower import ZERO_VELOCITY, Velocity
from linkwright.navigation.nodes.collision_sources import Source
from linkwright.navigation.nodes.collision_zones import Zone
from linkwright.navigation.nodes.managed import ManagedNode, ManagedServer
from linkwright.navigation.nodes.plugins import get_string_list
from linkwright.nodes.parameter_tables import ParameterTable
from linkwright.nodes.velocity_topic import VelocityTopic, choose_velocity_types

_QUEUE_DEPTH = 10
_SILENT_SENSOR_ZONE = "invalid source"
"""The name that nav2 reports as the zone when a sensor publishes nothing."""
_ACTION_MESSAGES = {
    ZoneAction.STOP: "Robot to stop due to {}",
    ZoneAction.SLOWDOWN: "Robot to slow down due to {}",
    ZoneAction.APPROACH: "Robot to slow down while it approaches an obstacle near {}",
    ZoneAction.LIMIT: "Robot to limit its speed due to {}",
    ZoneAction.NOTHING: "Robot to continue normal operation",
}


@dataclass(frozen=True, kw_only=True)
class MonitorParameters:
    """The parameters that do not belong to a zone or a sensor, with nav2's names.

    Times are in seconds.
    """

    cmd_vel_in_topic: str = "cmd_vel_smoothed"
    cmd_vel_out_topic: str = "cmd_vel"
    state_topic: str = ""
    base_frame_id: str = "base_footprint"
    odom_frame_id: str = "odom"
    transform_tolerance: float = 0.1
    source_timeout: float = 2.0
    base_shift_correction: bool = True
    stop_pub_timeout: float = 1.0
    enable_stamped_cmd_vel: bool | None = None


class MonitorNode(ManagedNode):
    """The managed node of collision_monitor."""

    def declare(self) -> None:
        """Declare the parameters that do not belong to a zone or a sensor."""
        self._transforms = BufferCore(logger=self.get_logger().get_child("tf2"))
        TransformListener(self._transforms, self)
        self._zones: list[Zone] = []
        self._sources: list[Source] = []
        self._output: VelocityTopic | None = None
        self._state: Any = None
        self._last_verdict = Verdict(ZERO_VELOCITY)
        self._stopped_ns: int | None = None
        self._table = ParameterTable(self, MonitorParameters)
        self._is_stamped = self._table.values.enable_stamped_cmd_vel

    def configure(self) -> None:
        """Read the zones and sensors, and create the topics.

        Raises:
            LinkwrightError: NODE431, a parameter is missing; NODE433, a parameter has an invalid value.
        """
        parameters = self._table.values
        base_frame, fixed_frame = (
            parameters.base_frame_id,
            parameters.odom_frame_id if parameters.base_shift_correction else None,
        )
        for name in get_string_list(self, "observation_sources", []):
            self._sources.append(self.register(Source(self, name, self._transforms, base_frame, fixed_frame)))
        for name in get_string_list(self, "polygons", []):
            self._zones.append(self.register(Zone(self, name, self._transforms, base_frame)))
        topic = parameters.state_topic
        if topic:
            self._state = self.register(
                self.create_publisher("nav2_msgs/msg/CollisionMonitorState", topic, _QUEUE_DEPTH)
            )
        self._output = VelocityTopic(self, parameters.cmd_vel_out_topic, self._is_stamped)
        topic = parameters.cmd_vel_in_topic
        for message_type in choose_velocity_types(self, topic, self._is_stamped):
            command_guard = CommandGuard(self._on_publisher_lost, DisputeMonitor.of(self))
            callback = command_guard.tracking_callback(self._on_velocity)
            subscription: Subscription[Any] = self.create_subscription(message_type, topic, callback, _QUEUE_DEPTH)
            command_guard.watch(self.register(subscription))

    def activate(self) -> None:
        """Start forwarding velocities, and publish the polygons of the zones."""
        for zone in self._zones:
            zone.publish()

    def deactivate(self) -> None:
        """Stop the robot, and stop forwarding velocities."""
        if self._output is not None and self._last_verdict.velocity != ZERO_VELOCITY:
            self._output.stop()
        self._last_verdict = Verdict(ZERO_VELOCITY)

    def cleanup(self) -> None:
        """Drop the zones and sensors, and close the output topic."""
        self._zones, self._sources, self._state = [], [], None
        if self._output is not None:
            self._output.close()
            self._output = None

    def _on_velocity(self, message: Any) -> None:
        if not self.is_active or self._output is None:
            return
        twist, stamped = (message.twist, True) if hasattr(message, "twist") else (message, False)
        velocity = Velocity(twist.linear.x, twist.linear.y, twist.angular.z)
        if not all(map(isfinite, velocity)):
            self.get_logger().error("Velocity message contains NaNs or Infs! Ignoring as invalid!")
            return
        if self._last_verdict.velocity == ZERO_VELOCITY:
            self._output.update_type()
        self._output.frame_id = message.header.frame_id if stamped else ""
        verdict = self._limit(velocity)
        if verdict.zone != self._last_verdict.zone:
            self._publish_state(verdict)
        self._publish(verdict.velocity)
        self._last_verdict = verdict
        for zone in self._zones:
            zone.publish()

    def _limit(self, velocity: Velocity) -> Verdict:
        now_ns = self.get_clock().now().nanoseconds
        points_by_sensor = {}
        for source in self._sources:
            points = source.points(now_ns, self._table.values.source_timeout)
            if points is None:
                return Verdict(ZERO_VELOCITY, ZoneAction.STOP, _SILENT_SENSOR_ZONE)
            points_by_sensor[source.name] = points
        zones = [zone.input_at_velocity(velocity, points_by_sensor) for zone in self._zones]
        return limit_by_zones(velocity, [zone for zone in zones if zone is not None])

    def _publish(self, velocity: Velocity) -> None:
        """Publish a velocity.

        Zero velocities are no longer published after ``stop_pub_timeout``, so that other nodes can drive the robot.
        """
        assert self._output is not None, "it is configured"
        now_ns = self.get_clock().now().nanoseconds
        if velocity != ZERO_VELOCITY:
            self._stopped_ns = None
        elif self._stopped_ns is None:
            self._stopped_ns = now_ns
        elif now_ns - self._stopped_ns > self._table.values.stop_pub_timeout * 1e9:
            return
        self._output.publish((velocity.x, velocity.y, 0.0), (0.0, 0.0, velocity.yaw))

    def _on_publisher_lost(self, publisher: EndpointInfo) -> None:
        if self._output is not None and self._last_verdict.velocity != ZERO_VELOCITY:
            self.get_logger().warning(
                str(phrase("{problem}; the robot is stopped", problem=describe_lost_publisher(publisher)))
            )
            self._output.stop()
            self._last_verdict = Verdict(ZERO_VELOCITY)

    def _publish_state(self, verdict: Verdict) -> None:
        self.get_logger().info(_ACTION_MESSAGES[verdict.action].format(verdict.zone))
        if self._state is not None:
            state = get_message("nav2_msgs/msg/CollisionMonitorState")
            self._state.publish(state(action_type=int(verdict.action), polygon_name=verdict.zone))


class CollisionMonitor(ManagedServer):
    """The running collision_monitor node."""

    DEFAULT_NAME = "collision_monitor"
    NODE = MonitorNode
