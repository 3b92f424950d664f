"""A turtle of turtlesim: its pose, its pen, and its topics, services and action."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, floor, hypot, pi, sin
from typing import Any

from linkwright.graph import ActionServer, CancelResponse, Node, ServerGoalHandle, Subscription
from linkwright.graph.actions.goal import GoalEvent
from linkwright.messages import get_action, get_message, get_service
from linkwright.nodes.turtlesim.canvas import EXTENT, Canvas, Color
from linkwright.nodes.turtlesim.interfaces import TOPIC_QOS
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_COMMAND_TIMEOUT_S = 1.0
"""A turtle stops this long after its last velocity."""

_ROTATION_SPEED = 1.0
_ROTATION_TOLERANCE = 0.02

_DEFAULT_PEN: Color = (179, 184, 255)
_DEFAULT_PEN_WIDTH_PX = 3
_MIN_PEN_WIDTH_PX = 1


def normalize_angle(angle: float) -> float:
    """Return an angle in the range from -pi (inclusive) to pi, in rad."""
    return angle - 2.0 * pi * floor((angle + pi) / (2.0 * pi))


class Turtle:
    """A turtle with its topics, services and action, whose names begin with its own.

    Args:
        node: the node that owns the topics, services and the action.
        interfaces: the package of the interfaces.
        name: the name of the turtle.
        pose: x and y in units, and the heading in rad.
        shape: the number of its drawing.
        canvas: the canvas of its pen.
        is_holonomic: returns whether turtles can move sideways.

    Attributes:
        name: the name.
        x: the position in units, from the left edge.
        y: the position in units, from the lower edge.
        theta: the heading in rad.
        shape: the number of its drawing.
    """

    def __init__(
        self,
        node: Node,
        interfaces: str,
        name: str,
        pose: tuple[float, float, float],
        shape: int,
        canvas: Canvas,
        is_holonomic: Callable[[], bool],
    ) -> None:
        self.name, self.shape = name, shape
        self.x, self.y, self.theta = pose
        self._node, self._canvas, self._is_holonomic = node, canvas, is_holonomic
        self._forward = self._sideways = self._turn = 0.0
        self._last_command_ns = node.get_clock().now_ns()
        self._pen_color, self._pen_width_px, self._is_pen_on = _DEFAULT_PEN, _DEFAULT_PEN_WIDTH_PX, True
        self._teleports: list[Callable[[], None]] = []
        self._pose_class = get_message(f"{interfaces}/msg/Pose")
        self._color_class = get_message(f"{interfaces}/msg/Color")
        self._rotate_type = get_action(f"{interfaces}/action/RotateAbsolute")
        self._goal: ServerGoalHandle | None = None
        self._start_theta = self.theta
        self._commands: Subscription[Any] = node.create_subscription(
            "geometry_msgs/msg/Twist", f"{name}/cmd_vel", self._on_velocity, TOPIC_QOS
        )
        self._poses = node.create_publisher(self._pose_class, f"{name}/pose", TOPIC_QOS)
        self._colors = node.create_publisher(self._color_class, f"{name}/color_sensor", TOPIC_QOS)
        self._services = [
            node.create_service(get_service(f"{interfaces}/srv/{kind}"), f"{name}/{service}", callback)
            for kind, service, callback in (
                ("SetPen", "set_pen", self._set_pen),
                ("TeleportRelative", "teleport_relative", self._teleport_relative),
                ("TeleportAbsolute", "teleport_absolute", self._teleport_absolute),
            )
        ]
        self._rotations = ActionServer(
            node,
            self._rotate_type,
            f"{name}/rotate_absolute",
            _do_not_execute,
            handle_accepted_callback=self._on_goal,
            cancel_callback=lambda _goal: CancelResponse.ACCEPT,
        )

    @property
    def velocity_topic(self) -> str:
        """The full name of the topic of the turtle's velocities."""
        return self._commands.topic_name

    def destroy(self) -> None:
        """Remove the topics, services and the action of the turtle."""
        self._end_goal(ServerGoalHandle.abort)
        self._rotations.destroy()
        for service in self._services:
            self._node.destroy_service(service)
        self._node.destroy_subscription(self._commands)
        self._node.destroy_publisher(self._poses)
        self._node.destroy_publisher(self._colors)

    def update(self, seconds: float) -> None:
        """Move the turtle for some seconds, and publish its pose and the color below it."""
        for teleport in self._teleports:
            start = self.x, self.y
            teleport()
            self._draw_from(start)
        self._teleports.clear()
        self._rotate_to_goal()
        if self._node.get_clock().now_ns() - self._last_command_ns > _COMMAND_TIMEOUT_S * NANOSECONDS_PER_SECOND:
            self._stop()
        start = self.x, self.y
        self._move(seconds)
        self._poses.publish(
            self._pose_class(
                x=self.x,
                y=self.y,
                theta=self.theta,
                linear_velocity=hypot(self._forward, self._sideways),
                angular_velocity=self._turn,
            )
        )
        red, green, blue = self._canvas.color_at(self.x, self.y)
        self._colors.publish(self._color_class(r=red, g=green, b=blue))
        self._draw_from(start)

    # --- motion ------------------------------------------------------------------------------------------------------

    def _move(self, seconds: float) -> None:
        """Turn, move in the new direction, and stop at the walls."""
        self.theta = normalize_angle(self.theta + self._turn * seconds)
        cosine, sine = cos(self.theta), sin(self.theta)
        self.x += (cosine * self._forward - sine * self._sideways) * seconds
        self.y += (sine * self._forward + cosine * self._sideways) * seconds
        if not (0.0 <= self.x <= EXTENT and 0.0 <= self.y <= EXTENT):
            self._node.get_logger().warning(f"Oh no! I hit the wall! (Clamping from [x={self.x:f}, y={self.y:f}])")
        self.x, self.y = (min(max(value, 0.0), EXTENT) for value in (self.x, self.y))

    def _stop(self) -> None:
        self._forward = self._sideways = self._turn = 0.0

    def _draw_from(self, start: tuple[float, float]) -> None:
        end = self.x, self.y
        if self._is_pen_on and end != start:
            self._canvas.draw_line(start, end, self._pen_color, self._pen_width_px)

    def _on_velocity(self, message: Any) -> None:
        self._last_command_ns = self._node.get_clock().now_ns()
        self._forward, self._turn = message.linear.x, message.angular.z
        self._sideways = message.linear.y if self._is_holonomic() else 0.0
        if self._goal is not None:
            self._node.get_logger().warning("Velocity command received during rotation goal. Aborting goal")
            self._end_goal(ServerGoalHandle.abort)

    # --- services ----------------------------------------------------------------------------------------------------

    def _set_pen(self, request: Any, response: Any) -> Any:
        self._is_pen_on = not request.off
        if self._is_pen_on:
            self._pen_color = request.r, request.g, request.b
            self._pen_width_px = request.width or _MIN_PEN_WIDTH_PX
        return response

    def _teleport_relative(self, request: Any, response: Any) -> Any:
        def teleport() -> None:
            self.theta += request.angular
            self.x += cos(self.theta) * request.linear
            self.y += sin(self.theta) * request.linear

        self._teleports.append(teleport)
        return response

    def _teleport_absolute(self, request: Any, response: Any) -> Any:
        def teleport() -> None:
            self.x, self.y, self.theta = request.x, min(request.y, EXTENT), request.theta

        self._teleports.append(teleport)
        return response

    # --- the action --------------------------------------------------------------------------------------------------

    def _on_goal(self, goal: ServerGoalHandle) -> None:
        if self._goal is not None:
            self._node.get_logger().warning(
                "Rotation goal received before a previous goal finished. Aborting previous goal"
            )
            self._end_goal(ServerGoalHandle.abort)
        goal.update(GoalEvent.EXECUTE)
        self._goal, self._start_theta = goal, self.theta

    def _rotate_to_goal(self) -> None:
        """Turn to the heading of the goal, or end the goal."""
        goal = self._goal
        if goal is None:
            return
        if goal.is_cancel_requested:
            self._node.get_logger().info("Rotation goal canceled")
            self._end_goal(ServerGoalHandle.canceled)
            self._stop()
            return
        remaining = normalize_angle(goal.request.theta - self.theta)
        goal.publish_feedback(self._rotate_type.Feedback(remaining=remaining))
        self._stop()
        if abs(remaining) < _ROTATION_TOLERANCE:
            self._node.get_logger().info("Rotation goal completed successfully")
            self._end_goal(ServerGoalHandle.succeed)
        else:
            self._turn = _ROTATION_SPEED if remaining > 0.0 else -_ROTATION_SPEED
            self._last_command_ns = self._node.get_clock().now_ns()

    def _end_goal(self, end: Callable[[ServerGoalHandle, Any], None]) -> None:
        """End the active goal, if there is one.

        The result is the rotation from its end to its start, as in turtlesim.
        """
        goal, self._goal = self._goal, None
        if goal is not None and goal.is_active:
            end(goal, self._rotate_type.Result(delta=normalize_angle(self._start_theta - self.theta)))


def _do_not_execute(_goal: ServerGoalHandle) -> None:
    """Do nothing, because `Turtle.update` executes goals."""
