"""marker_server of interactive_marker_twist_server: a marker on the robot that drives it when it is dragged.

The display InteractiveMarkers of the page and of RViz shows it, with the topic namespace ``twist_server``. After each
motion of the mouse, the marker returns to the robot.

Source: interactive_marker_twist_server (parameters, names of the marker and its controls, scales).
"""

from __future__ import annotations

from typing import Any

from linkwright.geometry.single import normalized, rpy_from_quaternion
from linkwright.graph import Graph
from linkwright.messages import get_message, get_service
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.velocity_topic import VelocityTopic

_SERVER = "twist_server"
_ANGULAR_SCALE = _MAX_ANGULAR_VELOCITY = 2.2
_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 0.0, 1.0), "z": (0.0, 1.0, 0.0)}
"""The vector part of the orientation of the control of each axis; the scalar part is 1."""
_UPDATE_DEPTH, _FEEDBACK_DEPTH = 100, 1


class MarkerServer(SingleNode):
    """The running node.

    Raises:
        LinkwrightError: a parameter has an invalid type (GRAPH201).
    """

    DEFAULT_NAME = "twist_server_node"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME, any_parameters=True)
        node = self._node
        with handle_start_errors(node):
            link: str = self._read("link_name", "base_link")
            robot: str = self._read("robot_name", "robot")
            self._scales = self._read_axes("linear_scale", 1.0)
            self._highest = self._read_axes("max_positive_linear_velocity", 1.0)
            self._lowest = self._read_axes("max_negative_linear_velocity", -1.0)
        self._sequence_number = 0
        self._marker = self._make_marker(link, robot)
        self._velocity = VelocityTopic(node, "cmd_vel")
        self._updates = node.create_publisher(
            get_message("visualization_msgs/msg/InteractiveMarkerUpdate"), f"{_SERVER}/update", _UPDATE_DEPTH
        )
        feedback = get_message("visualization_msgs/msg/InteractiveMarkerFeedback")
        node.create_subscription(feedback, f"{_SERVER}/feedback", self._on_feedback, _FEEDBACK_DEPTH)
        get_markers = get_service("visualization_msgs/srv/GetInteractiveMarkers")
        node.create_service(get_markers, f"{_SERVER}/get_interactive_markers", self._on_get)
        self._publish_update(markers=[self._marker])
        node.get_logger().info("[interactive_marker_twist_server] Initialized.")

    def close(self) -> None:
        """Close the node."""
        self._velocity.close()
        super().close()

    def _read(self, name: str, default: Any) -> Any:
        return self._node.get_parameter(name).value if self._node.has_parameter(name) else default

    def _read_axes(self, name: str, default: float) -> dict[str, float]:
        """Return the parameters ``NAME.x`` to ``NAME.z`` that are set, or the default for x if none is."""
        values = {axis: self._read(f"{name}.{axis}", None) for axis in _AXES}
        given = {axis: float(value) for axis, value in values.items() if value is not None}
        return given or {"x": default}

    def _make_marker(self, link: str, robot: str) -> Any:
        marker = get_message("visualization_msgs/msg/InteractiveMarker")()
        marker.header.frame_id = link
        marker.name, marker.description = f"{robot}_twist_marker", f"twist controller for {robot}"
        marker.scale = 1.0
        marker.pose.orientation.w = 1.0
        control_class = get_message("visualization_msgs/msg/InteractiveMarkerControl")
        names = [(f"move_{axis}", axis, control_class.MOVE_AXIS) for axis in _AXES if axis in self._scales]
        for name, axis, mode in (*names, ("rotate_z", "z", control_class.ROTATE_AXIS)):
            control = control_class(name=name, interaction_mode=mode, orientation_mode=control_class.FIXED)
            orientation = control.orientation
            orientation.x, orientation.y, orientation.z, orientation.w = normalized(*_AXES[axis], 1.0)
            marker.controls.append(control)
        return marker

    def _on_get(self, _request: Any, response: Any) -> Any:
        response.sequence_number, response.markers = self._sequence_number, [self._marker]
        return response

    def _on_feedback(self, message: Any) -> None:
        if message.marker_name != self._marker.name:
            return
        position, orientation = message.pose.position, message.pose.orientation
        quaternion = normalized(orientation.x, orientation.y, orientation.z, orientation.w)
        rotation = _ANGULAR_SCALE * rpy_from_quaternion(quaternion)[2]
        rotation = min(max(rotation, -_MAX_ANGULAR_VELOCITY), _MAX_ANGULAR_VELOCITY)
        linear = [self._find_speed(axis, getattr(position, axis)) for axis in _AXES]
        self._velocity.publish(linear, (0.0, 0.0, rotation))
        pose = get_message("visualization_msgs/msg/InteractiveMarkerPose")(name=self._marker.name)
        pose.header.frame_id = self._marker.header.frame_id
        pose.pose.orientation.w = 1.0
        self._publish_update(poses=[pose])

    def _find_speed(self, axis: str, offset: float) -> float:
        """Return the speed along an axis for the distance in meters by which the marker was dragged."""
        if axis not in self._scales:
            return 0.0
        speed = self._scales[axis] * offset
        return max(min(speed, self._highest.get(axis, 0.0)), self._lowest.get(axis, 0.0))

    def _publish_update(self, **fields: Any) -> None:
        self._sequence_number += 1
        update = get_message("visualization_msgs/msg/InteractiveMarkerUpdate")
        self._updates.publish(update(server_id=_SERVER, seq_num=self._sequence_number, type=update.UPDATE, **fields))
