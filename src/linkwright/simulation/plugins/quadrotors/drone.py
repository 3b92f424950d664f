"""Quadrotors of sjtu_drone: ``libplugin_drone.so``.

Source: sjtu_drone (parameters, defaults, topics, states, formulas). The true motion replaces the topic ``imu``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.control.odometry import create_transform_output, transform_message
from linkwright.geometry.arrays import Array, rotation_matrix
from linkwright.messages import Header, Quaternion, Vector3, from_values, get_message
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.quadrotors.control import (
    LOOPS,
    TWIST_TYPE,
    Motion,
    Quadrotor,
    QuadrotorParameters,
    gain_names,
)

_EMPTY_TYPE, _BOOL_TYPE = "std_msgs/msg/Empty", "std_msgs/msg/Bool"
_POSITION_LOOPS = ("positionXY", "positionZ")


@dataclass(frozen=True, kw_only=True)
class DroneParameters(QuadrotorParameters):
    """Parameters of ``libplugin_drone.so``."""

    pub_odom: bool = False
    odom_hz: float = 30.0
    motion_small_noise: float = parameter(0.0, aliases=("motionSmallNoise",))
    motion_drift_noise: float = parameter(0.0, aliases=("motionDriftNoise",))
    motion_drift_noise_time: float = parameter(1.0, aliases=("motionDriftNoiseTime",))


_LANDED, _FLYING, _TAKING_OFF, _LANDING = range(4)
_STATE_SECONDS = {_TAKING_OFF: (0.5, _FLYING), _LANDING: (1.0, _LANDED)}
_STATE_FACTORS = {_LANDED: 0.0, _FLYING: 1.0, _TAKING_OFF: 1.5, _LANDING: 0.8}


class Drone(Quadrotor[DroneParameters]):
    """The substitute for ``libplugin_drone.so`` of sjtu_drone.

    ``takeoff`` and ``land`` change its state. In flight, ``cmd_vel`` is a velocity, or a position after true on
    ``posctrl``; while the drone takes off or lands, it is a tilt, or a velocity after true on ``dronevel_mode``.
    """

    PARAMETERS = DroneParameters
    LOOPS = (*LOOPS, *_POSITION_LOOPS)
    DEFAULT_GAINS = (5.0, 0.0, 1.0)
    IS_LATE = True
    IGNORED = (*gain_names(LOOPS), "xyzOffset", "rpyOffset", "topicName", "imuTopic")
    CARRIED = ("command", "loops", "_state", "_state_seconds", "_holds_position", "_has_velocity_mode")

    def start(self) -> None:
        """Find the body, and create topics.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, a gain is not a number.
        """
        super().start()
        self._clear()
        node, guard = self.node, self.node.command_guard(self.stop_motion)
        node.subscribe(TWIST_TYPE, "cmd_vel", self._on_command, 1, command_guard=guard, stop_motion=self.stop_motion)
        node.subscribe(_BOOL_TYPE, "posctrl", self._on_position_mode, 1)
        node.subscribe(_BOOL_TYPE, "dronevel_mode", self._on_velocity_mode, 1)
        node.subscribe(_EMPTY_TYPE, "takeoff", lambda _: self._change_state((_LANDED,), _TAKING_OFF), 1)
        node.subscribe(_EMPTY_TYPE, "land", lambda _: self._change_state((_FLYING, _TAKING_OFF), _LANDING), 1)
        node.subscribe(_EMPTY_TYPE, "reset", lambda _: self.reset_loops(), 1)
        self._pose_output = node.publisher("geometry_msgs/msg/Pose", "gt_pose")
        self._velocity_output = node.publisher(TWIST_TYPE, "gt_vel")
        self._acceleration_output = node.publisher(TWIST_TYPE, "gt_acc")
        self._mode_output = node.publisher("std_msgs/msg/String", "cmd_mode")
        self._state_output = node.publisher("std_msgs/msg/Int8", "state")
        self.every(0.0, self._control)
        if self.parameters.pub_odom:
            self._odometry_output = node.publisher("nav_msgs/msg/Odometry", "odom")
            self._transform_output = create_transform_output(node)
            self.every(self.parameters.odom_hz, self._publish_odometry)

    def reset(self) -> None:
        """Land at once, and drop the command."""
        super().reset()
        self._clear()

    def _clear(self) -> None:
        self._state, self._state_seconds = _LANDED, 0.0
        self._holds_position = self._has_velocity_mode = False
        self._old_position: Array = np.array(self.simulation.link_pose(self.body)[:3])
        self._generator, self._drift_seconds = self.random, 0.0
        self._drift: Array = np.zeros(4)

    def _change_state(self, from_states: tuple[int, ...], state: int) -> None:
        if self._state in from_states:
            self._state, self._state_seconds = state, 0.0

    def _on_position_mode(self, message: Any) -> None:
        self._holds_position = bool(message.data)

    def _on_velocity_mode(self, message: Any) -> None:
        self._has_velocity_mode = bool(message.data)
        mode = "velocity" if self._has_velocity_mode else "position"
        self._mode_output.publish(get_message("std_msgs/msg/String")(data=mode))

    def _on_command(self, twist: Any) -> None:
        """Take a command, with noise on its tilt, climb and turning rate."""
        self.set_command(twist)
        parameters = self.parameters
        if self._drift_seconds > parameters.motion_drift_noise_time:
            self._drift = parameters.motion_drift_noise * self._generator.uniform(-1.0, 1.0, 4)
            self._drift_seconds = 0.0
        noise = self._drift + parameters.motion_small_noise * self._generator.uniform(-1.0, 1.0, 4)
        self.command[1][:] += noise[[0, 1, 3]]
        self.command[0][2] += noise[2]

    def _control(self) -> None:
        motion = self.sense()
        change, self._old_position = motion.position - self._old_position, motion.position
        self._drift_seconds += motion.seconds
        self._state_seconds += motion.seconds
        duration, next_state = _STATE_SECONDS.get(self._state, (float("inf"), self._state))
        if self._state_seconds > duration:
            self._state = next_state
        force, torque = self._compute_wrench(motion, change)
        rotation = _STATE_FACTORS[self._state] * motion.rotation
        self.push(self.body, rotation @ force, rotation @ torque)
        self._publish(motion)

    def _compute_wrench(self, motion: Motion, change: Array) -> tuple[Array, Array]:
        """Return the force and the torque in the axes of the body, before the factor of the state.

        Args:
            motion: the motion of the body.
            change: the change of its position in the last step, in m, which replaces its velocity as in the source.
        """
        linear, angular = self.command
        if self._holds_position:
            if self._state != _FLYING:
                return np.zeros(3), np.zeros(3)
            loops = (self.loops["positionXYx"], self.loops["positionXYy"], self.loops["positionZ"])
            velocity = np.array(
                [
                    loop.update(linear[index], motion.position[index], change[index], motion.seconds)
                    for index, loop in enumerate(loops)
                ]
            )
            return self.compute_force(motion, velocity[2]), self.compute_velocity_torque(
                motion, motion.to_heading(velocity)
            )
        if self._state == _FLYING:
            torque = self.compute_velocity_torque(motion, linear)
        elif self._has_velocity_mode:
            torque = self.compute_velocity_torque(motion, angular)
        else:
            torque = self.compute_tilt_torque(motion, angular[0], angular[1])
        return self.compute_force(motion, linear[2]), torque + self.compute_yaw_torque(motion, angular[2])

    def _publish(self, motion: Motion) -> None:
        """Publish the pose, the velocity and the acceleration in the axes of the body, and the state.

        sjtu_drone rotates velocity and acceleration in the wrong direction, as do the mistakes of Gazebo.
        """
        express = motion.rotation if self.gazebo_mistakes else motion.rotation.T
        for output, vector in (
            (self._velocity_output, motion.velocity),
            (self._acceleration_output, motion.acceleration),
        ):
            if output.is_wanted:
                twist = get_message(TWIST_TYPE)()
                twist.linear = from_values(Vector3, (express @ vector).tolist())
                output.publish(twist)
        if self._pose_output.is_wanted:
            message = get_message("geometry_msgs/msg/Pose")()
            pose = self.simulation.link_pose(self.body)
            message.position.x, message.position.y, message.position.z = pose[:3]
            message.orientation = from_values(Quaternion, pose[3:])
            self._pose_output.publish(message)
        if self._state_output.is_wanted:
            self._state_output.publish(get_message("std_msgs/msg/Int8")(data=self._state))

    def _publish_odometry(self) -> None:
        simulation, namespace = self.simulation, self.node.name.rpartition("/")[0].strip("/")
        pose, (linear, angular) = simulation.link_pose(self.body), simulation.link_velocity(self.body)
        rotation = np.array(rotation_matrix(np.array(pose[3:])))
        prefix = f"{namespace}/" if namespace else ""
        header = Header(stamp=self.stamp(), frame_id=f"{prefix}odom")
        message = get_message("nav_msgs/msg/Odometry")(header=header, child_frame_id=f"{prefix}base_footprint")
        position = message.pose.pose.position
        position.x, position.y, position.z = pose[:3]
        message.pose.pose.orientation = from_values(Quaternion, pose[3:])
        message.twist.twist.linear = from_values(Vector3, (rotation.T @ linear).tolist())
        message.twist.twist.angular = from_values(Vector3, (rotation.T @ angular).tolist())
        self._odometry_output.publish(message)
        self._transform_output.publish(transform_message(header, message.child_frame_id, pose))
