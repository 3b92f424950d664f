"""Rotors and velocity control of multicopters.

The systems are ``gz-sim-multicopter-motor-model-system`` and ``gz-sim-multicopter-control-system``.

The thrust of a rotor acts along the z axis of its link and grows with the square of its speed. The rotor exerts a
reaction torque on its parent link, and air drag acts on a rotor that moves across its axis. The controller tilts the
model so that it reaches the commanded velocity.

Source: gz-sim (parameters, topics, formulas); T. Lee, M. Leok, N. H. McClamroch, "Geometric tracking control of a
quadrotor UAV on SE(3)", 2010.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from math import exp, hypot, inf, isfinite
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from linkwright.diagnostics import phrase, quoted_names
from linkwright.geometry.arrays import rotation_matrix
from linkwright.geometry.single import Vector3
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.plugins.entities import vector_components
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.xmltree import Element

Array = npt.NDArray[np.float64]

_SPIN_GAIN = 1e-3
"""The gain of a rotor's motor, in N m of torque per rad/s of speed error.

The gain affects only the visible rotation of the rotor, not its thrust.
"""
_MIN_SQUARED_SINE = 1e-3


@dataclass(frozen=True, kw_only=True)
class MotorParameters:
    """Parameters of ``gz-sim-multicopter-motor-model-system``."""

    joint_name: str = parameter(aliases=("jointName",))
    link_name: str = parameter(aliases=("linkName",))
    turning_direction: str = parameter("ccw", aliases=("turningDirection",))
    motor_type: str = parameter("velocity", aliases=("motorType",))
    actuator_number: int = parameter(0, aliases=("motorNumber",))
    command_topic: str = parameter("command/motor_speed", aliases=("commandSubTopic",))
    max_rot_velocity: float = parameter(838.0, aliases=("maxRotVelocity",))
    motor_constant: float = parameter(8.54858e-06, aliases=("motorConstant",))
    moment_constant: float = parameter(0.016, aliases=("momentConstant",))
    rotor_drag_coefficient: float = parameter(1.0e-4, aliases=("rotorDragCoefficient",))
    rolling_moment_coefficient: float = parameter(1.0e-6, aliases=("rollingMomentCoefficient",))
    slowdown: float = parameter(10.0, aliases=("rotorVelocitySlowdownSim",))
    time_constant_up: float = parameter(1.0 / 80.0, aliases=("timeConstantUp",))
    time_constant_down: float = parameter(1.0 / 40.0, aliases=("timeConstantDown",))


class GzMulticopterMotor(SimulatedPlugin[MotorParameters]):
    """A rotor that follows speed commands of a controller or topic, with a motor's delay.

    The topic contains the speeds of all rotors in rad/s. The commands of a controller in the model take precedence.

    Attributes:
        target_speed: the commanded speed, in rad/s.
        speed: the current speed, in rad/s.
        is_blocked: whether a failure holds the rotor.
        rotor_link: the full name of the rotor's link.
        MOTOR_TYPES: the values of ``<motorType>`` that are simulated.
    """

    PARAMETERS: ClassVar[type[Any]] = MotorParameters
    IGNORED: ClassVar[Collection[str]] = ("motorSpeedPubTopic",)
    CARRIED: ClassVar[tuple[str, ...]] = ("target_speed", "speed")
    MOTOR_TYPES: ClassVar[tuple[str, ...]] = ("velocity",)

    def start(self) -> None:
        """Find the rotor, and subscribe to its speed commands.

        Raises:
            LinkwrightError: SIM133, SIM134, there is no such link or joint; SIM160, the motor type is not ``velocity``.
        """
        parameters = self.parameters
        if parameters.motor_type not in self.MOTOR_TYPES:
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}': <motorType> must be {types}, because other types are not simulated",
                    plugin=self.context.name,
                    types=quoted_names(self.MOTOR_TYPES, " or "),
                )
            )
        self.rotor_link = self.link(parameters.link_name)
        joint = self.joint(parameters.joint_name)
        self._parent = self.simulation.scene.joints[joint].parent
        self._sign = -1.0 if parameters.turning_direction.strip().lower() == "cw" else 1.0
        self._motor = self.simulation.add_velocity_motor(joint, _SPIN_GAIN, inf)
        self.simulation.keep_awake(self.rotor_link)
        self.reset()
        namespace = self.text_in(self.context.element, "robotNamespace").strip("/") or self.context.path
        self.node.subscribe(
            "actuator_msgs/msg/Actuators", f"/{namespace}/{parameters.command_topic.lstrip('/')}", self._on_actuators
        )
        self.every(0.0, self.apply_thrust)

    def limit_target(self, speed: float) -> float:
        """Return a commanded speed within the limits of the motor, in rad/s."""
        return min(max(speed, 0.0), self.parameters.max_rot_velocity)

    def compute_thrust(self, axial_velocity: float) -> float:
        """Return the thrust in N, for the velocity in m/s of the rotor along its axis, relative to the air."""
        return self.parameters.motor_constant * self.speed**2

    @property
    def wind(self) -> Array:
        """The velocity of the air in m/s in the axes of the world, which gz ignores."""
        return np.zeros(3)

    @property
    def rolling_sign(self) -> float:
        """The sign of the rolling moment."""
        return 1.0

    def reset(self) -> None:
        """Stop the rotor."""
        self.target_speed = self.speed = 0.0
        self.is_blocked = False

    def _on_actuators(self, actuators: Any) -> None:
        number = self.parameters.actuator_number
        speeds = actuators.velocity
        if number < len(speeds) and isfinite(speeds[number]):
            self.target_speed = float(speeds[number])

    def apply_thrust(self) -> None:
        """Turn the rotor, and apply its forces to its links."""
        parameters, simulation = self.parameters, self.simulation
        target_speed = self.limit_target(self.target_speed)
        time_constant = parameters.time_constant_up if target_speed > self.speed else parameters.time_constant_down
        old_weight = exp(-simulation.step / NANOSECONDS_PER_SECOND / time_constant) if time_constant > 0.0 else 0.0
        self.speed = old_weight * self.speed + (1.0 - old_weight) * target_speed
        if self.is_blocked:
            self.speed = 0.0
        axis = rotation_matrix(simulation.link_pose(self.rotor_link)[3:])[:, 2]
        velocity = simulation.link_velocity(self.rotor_link)[0] - self.wind
        axial_velocity = float(velocity @ axis)
        thrust = self.compute_thrust(axial_velocity)
        cross_velocity = abs(self.speed) * (velocity - axial_velocity * axis)
        force = thrust * axis - parameters.rotor_drag_coefficient * cross_velocity
        torque = (
            -self._sign * thrust * parameters.moment_constant * axis
            - self.rolling_sign * parameters.rolling_moment_coefficient * cross_velocity
        )
        self.push(self.rotor_link, force)
        self.push(self._parent, (0.0, 0.0, 0.0), torque)
        self.set_spin(self._sign * self.speed)

    def set_spin(self, speed: float) -> None:
        """Set the speed in rad/s at which the rotor turns before it is slowed down for the display."""
        self._motor.target = speed / self.parameters.slowdown


@dataclass(frozen=True, kw_only=True)
class ControlParameters:
    """Parameters of ``gz-sim-multicopter-control-system``."""

    com_link_name: str = parameter(aliases=("comLinkName",))
    command_topic: str = parameter("cmd_vel", aliases=("commandSubTopic",))
    enable_topic: str = parameter("enable", aliases=("enableSubTopic",))
    velocity_gain: Vector3 = parameter(aliases=("velocityGain",))
    attitude_gain: Vector3 = parameter(aliases=("attitudeGain",))
    angular_rate_gain: Vector3 = parameter(aliases=("angularRateGain",))
    max_acceleration: Vector3 = parameter((inf, inf, inf), aliases=("maximumLinearAcceleration",))
    max_linear: Vector3 = parameter((inf, inf, inf), aliases=("maximumLinearVelocity",))
    max_angular: Vector3 = parameter((inf, inf, inf), aliases=("maximumAngularVelocity",))


class GzMulticopterControl(SimulatedPlugin[ControlParameters]):
    """The substitute for ``gz-sim-multicopter-control-system``: flies at a commanded velocity.

    The model hovers when the publisher of the commands disappears.
    """

    PARAMETERS = ControlParameters
    IGNORED = (
        "rotorConfiguration",  # read by _find_rotors
        "linearVelocityNoiseMean",
        "linearVelocityNoiseStdDev",
        "angularVelocityNoiseMean",
        "angularVelocityNoiseStdDev",
    )
    CARRIED = ("_command", "_is_enabled")

    def start(self) -> None:
        """Find the rotors, and subscribe to the commands.

        Raises:
            LinkwrightError: SIM133, SIM134, there is no such link or joint; SIM160, the rotors cannot hold the model.
        """
        parameters, element = self.parameters, self.context.element
        self._body = self.link(parameters.com_link_name)
        self._find_rotors(element)
        self._rotors: dict[str, GzMulticopterMotor] = {}
        self.reset()
        namespace = self.text_in(element, "robotNamespace").strip("/")
        topic_prefix = f"/{namespace}/" if namespace else "/"
        command_guard = self.node.command_guard(self._stop_motion)
        twist_type = "geometry_msgs/msg/Twist"
        self.node.subscribe(
            twist_type,
            topic_prefix + parameters.command_topic,
            self._on_twist,
            command_guard=command_guard,
            stop_motion=self._stop_motion,
        )
        self.node.subscribe("std_msgs/msg/Bool", topic_prefix + parameters.enable_topic, self._on_enable)
        self.every(0.0, self._command_rotors)

    def reset(self) -> None:
        """Drop the command, and enable the controller."""
        self._command: tuple[Array, float] | None = None
        self._is_enabled = True

    def _find_rotors(self, element: Element | None) -> None:
        """Find the rotors, and compute the gains and the matrix that gives the rotor speeds.

        The matrix gives the squared speeds of the rotors from an angular acceleration and a thrust.
        """
        simulation = self.simulation
        configuration = None if element is None else element.first("rotorConfiguration")
        rotors = [] if configuration is None else list(configuration.elements("rotor"))
        body_pose = np.array(simulation.link_pose(self._body))
        body_rotation = rotation_matrix(body_pose[3:])
        columns = []
        self._joints = []
        for rotor in rotors:
            joint = self.joint(self.text_in(rotor, "jointName"))
            rotor_position = body_rotation.T @ (
                np.array(simulation.link_pose(simulation.scene.joints[joint].child)[:3]) - body_pose[:3]
            )
            force, moment = self.number_in(rotor, "forceConstant"), self.number_in(rotor, "momentConstant")
            direction = self.number_in(rotor, "direction")
            arm = hypot(rotor_position[0], rotor_position[1])
            moment_arm = (rotor_position[1], -rotor_position[0]) if arm else (0.0, 0.0)
            columns.append((force * moment_arm[0], force * moment_arm[1], -direction * force * moment, force))
            self._joints.append(joint)
        allocation = np.array(columns).T
        if len(rotors) < 4 or np.linalg.matrix_rank(allocation) < 4:
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}': its rotors cannot control thrust and all three torques",
                    plugin=self.context.name,
                )
            )
        self._mass, inertia = self._compute_mass_and_inertia()
        inertias = np.eye(4)
        inertias[:3, :3] = inertia
        self._allocation = np.linalg.pinv(allocation) @ inertias
        inverse_inertia = np.linalg.inv(inertia)
        self._attitude_gain = np.array(self.parameters.attitude_gain) @ inverse_inertia
        self._rate_gain = np.array(self.parameters.angular_rate_gain) @ inverse_inertia

    def _compute_mass_and_inertia(self) -> tuple[float, Array]:
        """Return the model's mass in kg, and its inertia tensor in kg m2.

        The tensor is about the center of mass, in the axes of the body.
        """
        simulation = self.simulation
        model, data = simulation.model, simulation.data
        body = simulation.body(self._body)
        root = int(model.body_rootid[body])
        bodies = [index for index in range(model.nbody) if int(model.body_rootid[index]) == root]
        masses = model.body_mass[bodies]
        center = masses @ data.xipos[bodies] / masses.sum()
        total = np.zeros((3, 3))
        for body_index in bodies:
            axes, offset = data.ximat[body_index].reshape(3, 3), data.xipos[body_index] - center
            total += axes @ np.diag(model.body_inertia[body_index]) @ axes.T
            total += model.body_mass[body_index] * (offset @ offset * np.eye(3) - np.outer(offset, offset))
        rotation = data.xmat[body].reshape(3, 3)
        return float(masses.sum()), rotation.T @ total @ rotation

    def _on_twist(self, twist: Any) -> None:
        max_linear = np.array(self.parameters.max_linear)
        max_yaw_rate = self.parameters.max_angular[2]
        linear = np.clip(np.array(vector_components(twist.linear)), -max_linear, max_linear)
        self._command = (linear, min(max(float(twist.angular.z), -max_yaw_rate), max_yaw_rate))

    def _stop_motion(self) -> bool:
        """Command the model to hover, and return whether a motion was commanded before."""
        old_command = self._command
        if old_command is None:
            return False
        self._command = (np.zeros(3), 0.0)
        return bool(old_command[0].any()) or old_command[1] != 0.0

    def _on_enable(self, message: Any) -> None:
        self._is_enabled = bool(message.data)

    def _command_rotors(self) -> None:
        motors = self._find_motors()
        if not self._is_enabled:
            for motor in motors.values():
                motor.target_speed = 0.0
        elif self._command is not None:
            for joint, speed in zip(self._joints, self._compute_speeds(*self._command), strict=True):
                if joint in motors:
                    motors[joint].target_speed = float(speed)

    def _find_motors(self) -> dict[str, GzMulticopterMotor]:
        """Return the motors of the model that have started, by the names of their joints."""
        if len(self._rotors) < len(self._joints):  # the other motors have not started yet
            motors = [
                simulated_plugin
                for simulated_plugin in self.model_plugins
                if isinstance(simulated_plugin, GzMulticopterMotor)
            ]
            self._rotors = {self.joint(motor.parameters.joint_name): motor for motor in motors}
        return self._rotors

    def _compute_speeds(self, linear: Array, yaw_rate: float) -> Array:
        """Return the target speed of each rotor, in rad/s, for a commanded velocity."""
        parameters, simulation = self.parameters, self.simulation
        rotation = rotation_matrix(simulation.link_pose(self._body)[3:])
        velocity, rates = simulation.link_velocity(self._body)
        error = (velocity - rotation @ linear) * np.array(parameters.velocity_gain) / self._mass
        max_acceleration = np.array(parameters.max_acceleration)
        acceleration = np.clip(error, -max_acceleration, max_acceleration) + simulation.model.opt.gravity
        target_attitude = _compute_attitude(rotation, acceleration)
        skew = 0.5 * (target_attitude.T @ rotation - rotation.T @ target_attitude)
        tilt = np.array((skew[2, 1], skew[0, 2], skew[1, 0]))
        rate_error = rotation.T @ rates - rotation.T @ target_attitude @ np.array((0.0, 0.0, yaw_rate))
        angular = -tilt * self._attitude_gain - rate_error * self._rate_gain
        thrust = -self._mass * float(acceleration @ rotation[:, 2])
        squares: Array = self._allocation @ np.array((*angular, thrust))
        speeds: Array = np.sqrt(np.maximum(squares, 0.0))
        return speeds


def _compute_attitude(rotation: Array, acceleration: Array) -> Array:
    """Return the rotation matrix whose z axis is opposite to an acceleration.

    The heading stays the same.
    """
    up = -acceleration / max(float(np.linalg.norm(acceleration)), 1e-9)
    heading = next(
        (axis for axis in rotation.T if np.sum(np.cross(axis, up) ** 2) >= _MIN_SQUARED_SINE), rotation[:, 0]
    )
    left = np.cross(up, heading)
    left /= np.linalg.norm(left)
    return np.column_stack((np.cross(left, up), left, up))
