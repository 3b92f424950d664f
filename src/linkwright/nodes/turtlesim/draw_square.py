"""draw_square: a turtle draws a square again and again."""

from __future__ import annotations

from enum import Enum, auto
from math import cos, pi, sin
from typing import Any

from linkwright.graph import Clock, ClockType, Graph
from linkwright.messages import get_message, get_service
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.turtlesim.interfaces import TOPIC_QOS, find_interface_package
from linkwright.nodes.turtlesim.turtle import normalize_angle

_PERIOD_S = 0.016
_SIDE = 2.0
_SPEED = 1.0
_TURN_SPEED = 0.4
_POSITION_TOLERANCE = 0.1
_ANGLE_TOLERANCE = 0.01
_MAX_SPEED_AT_REST = 0.0001


class _Phase(Enum):
    FORWARD = auto()
    STOP_FORWARD = auto()
    TURN = auto()
    STOP_TURN = auto()


class DrawSquare(SingleNode):
    """The running draw_square, which resets turtlesim and then drives turtle1."""

    DEFAULT_NAME = "draw_square"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._pose: Any = None
        self._goal: tuple[float, float, float] | None = None
        self._phase = _Phase.FORWARD
        self._is_reset = self._has_asked = False
        with handle_start_errors(self._node):
            pose_type = f"{find_interface_package(options.environment)}/msg/Pose"
            self._twist = get_message("geometry_msgs/msg/Twist")
            self._publisher = self._node.create_publisher(self._twist, "turtle1/cmd_vel", TOPIC_QOS)
            self._node.create_subscription(pose_type, "turtle1/pose", self._on_pose, TOPIC_QOS)
            self._reset = self._node.create_client(get_service("std_srvs/srv/Empty"), "reset")
            clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=self._node.get_clock().timebase)
            self._node.create_timer(_PERIOD_S, self._update, clock=clock)

    def _on_pose(self, pose: Any) -> None:
        self._pose = pose

    def _on_reset(self, _response: Any) -> None:
        self._is_reset, self._pose = True, None

    def _update(self) -> None:
        if not self._has_asked and self._reset.service_is_ready():
            self._has_asked = True
            self._reset.call_async(self._reset.srv_type.Request()).add_done_callback(self._on_reset)
        if not self._is_reset or self._pose is None:
            return
        if self._goal is None:
            self._set_goal(_Phase.FORWARD)
        if self._phase in (_Phase.FORWARD, _Phase.TURN):
            is_turning = self._phase is _Phase.TURN
            if self._has_reached_goal():
                self._phase = _Phase.STOP_TURN if is_turning else _Phase.STOP_FORWARD
                self._command(0.0, 0.0)
            else:
                self._command(0.0 if is_turning else _SPEED, _TURN_SPEED if is_turning else 0.0)
        elif max(self._pose.linear_velocity, self._pose.angular_velocity) < _MAX_SPEED_AT_REST:
            self._node.get_logger().info("Reached goal")
            self._set_goal(_Phase.TURN if self._phase is _Phase.STOP_FORWARD else _Phase.FORWARD)
        else:
            self._command(0.0, 0.0)

    def _set_goal(self, phase: _Phase) -> None:
        """Begin to turn by a quarter, or to move by the length of a side."""
        x, y, theta = self._pose.x, self._pose.y, self._pose.theta
        if phase is _Phase.TURN:
            theta = normalize_angle(theta + pi / 2.0)
        else:
            x, y = x + cos(theta) * _SIDE, y + sin(theta) * _SIDE
        self._phase, self._goal = phase, (x, y, theta)
        self._node.get_logger().info(f"New goal [{x:f} {y:f}, {theta:f}]")

    def _has_reached_goal(self) -> bool:
        assert self._goal is not None
        x, y, theta = self._goal
        return (
            abs(self._pose.x - x) < _POSITION_TOLERANCE
            and abs(self._pose.y - y) < _POSITION_TOLERANCE
            and abs(normalize_angle(self._pose.theta - theta)) < _ANGLE_TOLERANCE
        )

    def _command(self, forward: float, turn: float) -> None:
        twist = self._twist()
        twist.linear.x, twist.angular.z = forward, turn
        self._publisher.publish(twist)
