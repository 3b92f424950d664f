"""MoveIt Servo's node, which moves an arm by commanded velocities.

The node has the topics, services and parameters of MoveIt 2: those of Humble (``start_servo``, an Int8 as status), and
those of later distributions (``switch_command_type``, ServoStatus). Differences: each message has one point that is to
be reached after the publish period, as in Humble, and the smoothing is always a low-pass filter.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, phrase
from linkwright.geometry.arrays import Array, compose, quaternion_inverse, quaternion_multiply, rotate
from linkwright.graph import Graph, Publisher
from linkwright.graph.time.values import Duration, Time
from linkwright.messages import get_message, get_service
from linkwright.messages.distribution import is_before_iron
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.planning.collision_scene import CollisionScene
from linkwright.planning.nodes.conversions import UnknownFrameError, pose_row
from linkwright.planning.nodes.robot_context import RobotContext, read_description
from linkwright.planning.nodes.scene_state import SceneState
from linkwright.planning.nodes.servo_parameters import read_parameters, read_settings
from linkwright.planning.servo import Condition, Servo
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_JOINT_JOG, _TWIST, _POSE = 0, 1, 2
_MODE_NAMES = ("JOINT_JOG", "TWIST", "POSE")
_HUMBLE_CODES = {Condition.DECELERATE_FOR_COLLISION: 3, Condition.HALT_FOR_COLLISION: 4, Condition.JOINT_BOUND: 5,
                 Condition.DECELERATE_FOR_LEAVING_SINGULARITY: 6}  # fmt: skip
"""The codes of Humble that differ from those of ServoStatus."""


class ServoNode(SingleNode):
    """The node servo_node.

    Raises:
        LinkwrightError: ARM104, a parameter with a description is missing; ARM107, a parameter has an invalid value;
            or the description has errors.
    """

    DEFAULT_NAME = "servo_node"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME, any_parameters=True)
        with handle_start_errors(self._node):
            self._start({name: item.value for name, item in self._node.get_parameters_by_prefix("").items()})

    def _start(self, parameters: dict[str, Any]) -> None:
        node = self._node
        self._parameters = read_parameters(parameters)
        urdf, srdf = (
            read_description(parameters, name, self.DEFAULT_NAME)
            for name in ("robot_description", "robot_description_semantic")
        )
        self._robot = RobotContext(node, urdf, srdf, parameters, joint_topic=self._parameters.joint_topic)
        self._group = self._find_group()
        self._settings = read_settings(parameters, self._group)
        self._servo = Servo(self._robot.model, self._group, self._settings)
        self._is_humble = is_before_iron()
        self._mode: int | None = None if self._is_humble else _JOINT_JOG
        self._is_paused = self._is_humble
        self._commands: dict[int, Any] = {}
        self._remaining_halts = 0
        self._controlled_dimensions: NDArray[np.bool_] = np.ones(6, dtype=bool)
        self._set_up_scene()
        self._set_up_interfaces()

    def _find_group(self) -> Any:
        groups = self._robot.groups
        name = self._parameters.active_subgroup or self._parameters.move_group_name
        if name not in groups or groups[name].tip is None:
            message = phrase("servo_node: the SRDF has no group '{name}' that is a chain", name=name)
            raise LinkwrightError(Diagnostic("ARM107", message, hint=did_you_mean(name, list(groups))))
        return groups[name]

    def _set_up_scene(self) -> None:
        robot, parameters = self._robot, self._parameters
        warn = self._node.get_logger().warning
        self._scene = SceneState(robot.frame, robot.allowed_collisions(), robot.robot.links, warn, robot.margins)
        self._collision_scene: CollisionScene | None = None
        self._last_scene: Any = None
        self._node.create_subscription(
            "moveit_msgs/msg/PlanningScene", parameters.monitored_planning_scene_topic, self._on_scene, 10
        )
        if parameters.check_collisions:
            self._node.create_timer(1.0 / parameters.collision_check_rate, self._check_collisions)

    def _set_up_interfaces(self) -> None:
        node, parameters = self._node, self._parameters
        for mode, kind, topic in (
            (_TWIST, "geometry_msgs/msg/TwistStamped", parameters.cartesian_command_in_topic),
            (_JOINT_JOG, "control_msgs/msg/JointJog", parameters.joint_command_in_topic),
            (_POSE, "geometry_msgs/msg/PoseStamped", parameters.pose_command_in_topic),
        ):
            node.create_subscription(kind, topic, lambda message, mode=mode: self._on_command(mode, message), 10)
        kind = parameters.command_out_type.replace("/", "/msg/")
        self._publisher: Publisher[Any] = node.create_publisher(kind, parameters.command_out_topic, 10)
        status = "std_msgs/msg/Int8" if self._is_humble else "moveit_msgs/msg/ServoStatus"
        self._status_publisher: Publisher[Any] = node.create_publisher(status, parameters.status_topic, 10)
        trigger = get_service("std_srvs/srv/Trigger")
        node.create_service(trigger, "~/start_servo", self._start_servo)
        node.create_service(trigger, "~/stop_servo", self._pause)
        if self._is_humble:
            node.create_service(trigger, "~/pause_servo", self._pause)
            node.create_service(trigger, "~/unpause_servo", self._unpause)
            for what, change in (("Drift", self._change_drift), ("Control", self._change_control)):
                kind = f"moveit_msgs/srv/Change{what}Dimensions"
                node.create_service(get_service(kind), f"~/change_{what.lower()}_dimensions", change)
        else:
            node.create_service(get_service("std_srvs/srv/SetBool"), "~/pause_servo", self._set_pause)
        node.create_service(
            get_service("moveit_msgs/srv/ServoCommandType"), "~/switch_command_type", self._switch_command_type
        )
        node.create_timer(self._settings.publish_period, self._step)

    # --- requests -------------------------------------------------------------------------------------------

    def _start_servo(self, request: Any, response: Any) -> Any:
        """Start as in Humble, where all commands are accepted."""
        self._mode = None
        return self._unpause(request, response)

    def _pause(self, _request: Any, response: Any) -> Any:
        self._is_paused = True
        return self._restart(response, "Servoing disabled")

    def _unpause(self, _request: Any, response: Any) -> Any:
        self._is_paused = False
        return self._restart(response, "Servoing enabled")

    def _set_pause(self, request: Any, response: Any) -> Any:
        return (self._pause if request.data else self._unpause)(request, response)

    def _restart(self, response: Any, text: str) -> Any:
        self._commands.clear()
        self._remaining_halts = 0
        self._servo.reset(self._robot.positions)
        response.success, response.message = True, text
        return response

    def _switch_command_type(self, request: Any, response: Any) -> Any:
        response.success = _JOINT_JOG <= request.command_type <= _POSE
        if response.success:
            self._mode = request.command_type
        else:
            self._node.get_logger().warning(f"Unknown command type {request.command_type} requested")
        return response

    def _change_drift(self, request: Any, response: Any) -> Any:
        self._servo.drifts = _read_dimensions(request, "drift")
        response.success = True
        return response

    def _change_control(self, request: Any, response: Any) -> Any:
        self._controlled_dimensions = _read_dimensions(request, "control")
        response.success = True
        return response

    def _on_command(self, mode: int, message: Any) -> None:
        if self._is_paused:
            return
        if self._mode not in (None, mode):
            self._node.get_logger().warning(
                f"Command type is {_MODE_NAMES[self._mode or 0]}, cannot accept input of type {_MODE_NAMES[mode]}",
                once=True,
            )
            return
        self._commands = {mode: message}

    def _on_scene(self, message: Any) -> None:
        message.robot_state.joint_state = get_message("sensor_msgs/msg/JointState")()
        if message == self._last_scene:
            return
        self._last_scene = message
        self._scene.apply(message, lambda frame: self._robot.frame_pose(frame, self._robot.positions))
        self._collision_scene = None

    def _check_collisions(self) -> None:
        if self._is_paused or not self._robot.has_state:
            return
        if self._collision_scene is None:
            settings, scene = self._settings, self._scene
            range_m = max(settings.self_collision_proximity_threshold, settings.scene_collision_proximity_threshold)
            self._collision_scene = CollisionScene(
                self._robot.robot, self._robot.shapes, scene.scene_objects(), scene.allowed, scene.margins, range_m
            )
        self._servo.set_clearances(*self._collision_scene.clearances(self._robot.positions))

    # --- motion ---------------------------------------------------------------------------------------------

    def _step(self) -> None:
        condition = Condition.NO_WARNING
        if not self._is_paused and self._robot.has_state:
            condition = self._move()
        self._publish_status(condition)

    def _move(self) -> Condition:
        mode, command = next(iter(self._commands.items()), (_JOINT_JOG, None))
        if command is None or self._is_stale(command):
            self._commands.clear()
            return self._halt()
        if not self._remaining_halts:  # It starts where the robot is.
            self._servo.reset(self._robot.positions)
        parameters = self._parameters
        self._servo.halts_all_joints = (
            parameters.halt_all_joints_in_joint_mode
            if mode == _JOINT_JOG
            else parameters.halt_all_joints_in_cartesian_mode
        )
        if not self._follow(mode, command):
            self._commands.clear()
            return Condition.INVALID
        self._remaining_halts = max(1, parameters.num_outgoing_halt_msgs_to_publish)
        self._publish()
        return self._servo.condition

    def _halt(self) -> Condition:
        """Slow down, and publish that the robot is at rest as often as the parameters ask."""
        if not self._remaining_halts:
            return Condition.NO_WARNING
        self._servo.step_halt()
        self._publish()
        if self._servo.is_at_rest and self._parameters.num_outgoing_halt_msgs_to_publish:
            self._remaining_halts -= 1
        return self._servo.condition

    def _is_stale(self, command: Any) -> bool:
        age = self._node.get_clock().now() - Time.from_msg(command.header.stamp)
        return bool(age.nanoseconds >= self._parameters.incoming_command_timeout * NANOSECONDS_PER_SECOND)

    def _follow(self, mode: int, command: Any) -> bool:
        """Move for one period as a command says, and return whether the command is valid."""
        try:
            if mode == _JOINT_JOG:
                self._servo.step_joints(self._read_jog(command))
            elif mode == _TWIST:
                self._servo.step_twist(self._read_twist(command))
            else:
                self._servo.step_twist(self._read_pose(command))
        except (ValueError, UnknownFrameError) as error:
            self._node.get_logger().warning(f"The command is not valid: {error}", throttle_duration_sec=1.0)
            return False
        return True

    def _read_jog(self, command: Any) -> Array:
        velocities = np.zeros(len(self._group.joint_names))
        if len(command.joint_names) != len(command.velocities):
            raise ValueError("a joint jog needs one velocity for each joint")
        for name, velocity in zip(command.joint_names, command.velocities, strict=True):
            if name not in self._group.joint_names:
                raise ValueError(f"the group '{self._group.name}' has no joint '{name}'")
            velocities[self._group.joint_names.index(name)] = velocity
        self._check_range(velocities)
        return velocities * (self._parameters.joint_scale if self._is_unitless else 1.0)

    def _read_twist(self, command: Any) -> Array:
        linear, angular = (
            np.array((vector.x, vector.y, vector.z)) for vector in (command.twist.linear, command.twist.angular)
        )
        self._check_range(np.concatenate((linear, angular)))
        linear, angular = (linear, angular) * self._controlled_dimensions.reshape(2, 3)
        if self._is_unitless:
            linear, angular = linear * self._parameters.linear_scale, angular * self._parameters.rotational_scale
        frame = self._robot.frame_pose(
            command.header.frame_id or self._parameters.robot_link_command_frame, self._servo.positions
        )
        linear, angular = rotate(frame[3:], linear), rotate(frame[3:], angular)
        if not self._parameters.apply_twist_commands_about_ee_frame:
            linear = linear + np.cross(angular, self._tip()[:3] - frame[:3])
        return np.concatenate((linear, angular))

    def _read_pose(self, command: Any) -> Array:
        """Return the velocity toward a pose, which is reached in one period if the scales allow it."""
        parameters, period = self._parameters, self._settings.publish_period
        target = compose(self._robot.frame_pose(command.header.frame_id, self._servo.positions), pose_row(command.pose))
        self._check_finite(target)
        tip = self._tip()
        turn = quaternion_multiply(target[3:], quaternion_inverse(tip[3:]))
        turn = turn if turn[3] >= 0.0 else -turn
        length = float(np.linalg.norm(turn[:3]))
        angle = 2.0 * float(np.arctan2(length, turn[3]))
        linear, angular = target[:3] - tip[:3], (angle / length if length > 0.0 else 0.0) * turn[:3]
        result = []
        for error, tolerance, speed in (
            (linear, parameters.linear_tolerance, parameters.linear_scale),
            (angular, parameters.angular_tolerance, parameters.rotational_scale),
        ):
            size = float(np.linalg.norm(error))
            result.append(error * (min(1.0 / period, speed / size) if size > tolerance else 0.0))
        return np.concatenate(result)

    @property
    def _is_unitless(self) -> bool:
        return self._parameters.command_in_type == "unitless"

    def _check_range(self, values: Array) -> None:
        self._check_finite(values)
        if self._is_unitless and np.any(np.abs(values) > 1.0):
            raise ValueError("a component of a unitless command is larger than 1")

    @staticmethod
    def _check_finite(values: Array) -> None:
        if not np.all(np.isfinite(values)):
            raise ValueError("a component is not finite")

    def _tip(self) -> Array:
        return self._robot.frame_pose(self._group.tip, self._servo.positions)

    # --- output ---------------------------------------------------------------------------------------------

    def _publish(self) -> None:
        parameters = self._parameters
        positions, velocities = self._servo.group_positions.tolist(), self._servo.velocities.tolist()
        if parameters.command_out_type == "std_msgs/Float64MultiArray":
            message = get_message("std_msgs/msg/Float64MultiArray")()
            message.data = positions if parameters.publish_joint_positions else velocities
        else:
            message = get_message("trajectory_msgs/msg/JointTrajectory")()
            message.joint_names = list(self._group.joint_names)
            point = get_message("trajectory_msgs/msg/JointTrajectoryPoint")()
            period_ns = round(self._settings.publish_period * NANOSECONDS_PER_SECOND)
            point.time_from_start = Duration(nanoseconds=period_ns).to_msg()
            point.positions = positions if parameters.publish_joint_positions else []
            point.velocities = velocities if parameters.publish_joint_velocities else []
            point.accelerations = [0.0] * len(positions) if parameters.publish_joint_accelerations else []
            message.points = [point]
        self._publisher.publish(message)

    def _publish_status(self, condition: Condition) -> None:
        status = get_message("moveit_msgs/msg/ServoStatus")
        code = getattr(status, condition.name)
        if self._is_humble:
            self._status_publisher.publish(get_message("std_msgs/msg/Int8")(data=_HUMBLE_CODES.get(condition, code)))
        else:
            self._status_publisher.publish(status(code=code, message=condition.value))


def _read_dimensions(request: Any, word: str) -> NDArray[np.bool_]:
    """Return which dimensions a request names: linear and angular along and about x, y and z, shape (6,)."""
    names = [f"{word}_{axis}_{kind}" for kind in ("translation", "rotation") for axis in "xyz"]
    return np.array([getattr(request, name) for name in names], dtype=bool)
