"""Systems of PX4 for gz: motors of boats and vehicles under water, motor failures, moving platforms and air speed.

They are ``libGenericMotorModelPlugin.so``, ``libMotorFailurePlugin.so``, ``libMovingPlatformController.so`` and
``libAirSpeedPlugin.so``.

Source: PX4-Autopilot, gz_plugins (parameters, defaults, topics, formulas). Topics of gz's transport are topics of ROS.
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from math import copysign, isfinite, pi, radians
from typing import Any

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import Array, rotation_matrix
from linkwright.geometry.single import quaternion_from_rpy, quaternion_inverse, quaternion_multiply
from linkwright.messages import Header, get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.multicopter import GzMulticopterMotor, MotorParameters
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.sensors.air_speed import measure_dynamic_pressure
from linkwright.simulation.sensors.mount import Mount

_POLYNOMIAL, _DUTY_CYCLE = "force_polynomial", "duty_cycle"
_ROTOR_JOINT = re.compile(r"rotor_(\d+)_joint")


@dataclass(frozen=True, kw_only=True)
class GenericMotorParameters(MotorParameters):
    """Parameters of ``libGenericMotorModelPlugin.so``."""

    turning_direction: str = parameter("cw", aliases=("turningDirection",))
    control_method: str = parameter("rpm", aliases=("controlMethod",))
    min_command: float = parameter(0.0, aliases=("minCommand",))
    min_duty_cycle: float = parameter(0.0, aliases=("minDutyCycle",))
    max_duty_cycle: float = parameter(0.0, aliases=("maxDutyCycle",))
    bidirectional_motor: int = parameter(0, aliases=("bidirectionalMotor",))
    positive_thrust_polynomial: str = parameter("", aliases=("positiveThrustPolynomial",))
    negative_thrust_polynomial: str = parameter("", aliases=("negativeThrustPolynomial",))


class GenericMotor(GzMulticopterMotor):
    """The substitute for ``libGenericMotorModelPlugin.so``: a motor that may turn in both directions.

    Its thrust follows the squared speed, or a polynomial of the command without delay (``force_polynomial``). The
    command is then a speed in rad/s or a pulse in µs (``duty_cycle``), which becomes a number up to 1.
    """

    PARAMETERS = GenericMotorParameters
    MOTOR_TYPES = ("velocity", _POLYNOMIAL)

    parameters: GenericMotorParameters

    def start(self) -> None:
        """Read the polynomials, find the rotor, and subscribe to its commands.

        Raises:
            LinkwrightError: SIM133, SIM134, there is no such link or joint; SIM160, the type of the motor is unknown,
                or a polynomial or the range of the pulses is missing or wrong.
        """
        parameters = self.parameters
        self._has_polynomial = parameters.motor_type == _POLYNOMIAL
        if self._has_polynomial:
            self._positive = self._read_polynomial(parameters.positive_thrust_polynomial)
            negative = parameters.negative_thrust_polynomial
            self._negative = self._read_polynomial(negative) if negative else self._positive
        if parameters.control_method == _DUTY_CYCLE and parameters.max_duty_cycle <= parameters.min_duty_cycle:
            message = phrase(
                "plugin '{plugin}': <maxDutyCycle> must be greater than <minDutyCycle>", plugin=self.context.name
            )
            raise self.parameter_error(message)
        super().start()

    def _read_polynomial(self, text: str) -> list[float]:
        """Return the coefficients of a polynomial, the constant first."""
        try:
            coefficients = [float(word) for word in text.replace(",", " ").split()]
        except ValueError:
            coefficients = []
        if not coefficients:
            message = phrase(
                "plugin '{plugin}': <positiveThrustPolynomial> and <negativeThrustPolynomial> need numbers, the "
                "constant first",
                plugin=self.context.name,
            )
            raise self.parameter_error(message)
        return coefficients

    def limit_target(self, speed: float) -> float:
        """Return a commanded speed within the limits of the motor, in rad/s."""
        return min(speed, self.parameters.max_rot_velocity)

    def compute_thrust(self, axial_velocity: float) -> float:
        """Return the thrust in N, which has the sign of the speed."""
        return copysign(super().compute_thrust(axial_velocity), self.speed)

    @property
    def wind(self) -> Array:
        """The velocity of the air in m/s in the axes of the world."""
        return np.array(self.simulation.wind)

    def apply_thrust(self) -> None:
        """Turn the rotor, and apply its forces to its links."""
        if not self._has_polynomial:
            super().apply_thrust()
            return
        command = 0.0 if self.is_blocked else self._normalize(self.target_speed)
        thrust = 0.0
        if command >= self.parameters.min_command:
            thrust = _evaluate(self._positive, command)
        elif command <= -self.parameters.min_command:
            thrust = -_evaluate(self._negative, -command)
        axis = rotation_matrix(self.simulation.link_pose(self.rotor_link)[3:])[:, 2]
        self.push(self.rotor_link, thrust * axis)
        self.set_spin(command)

    def _normalize(self, command: float) -> float:
        """Return the command of a polynomial: a speed in rad/s, or a share of the range of pulses."""
        parameters = self.parameters
        if parameters.control_method != _DUTY_CYCLE:
            return self.limit_target(command)
        if command < parameters.min_duty_cycle:
            return 0.0
        length = parameters.max_duty_cycle - parameters.min_duty_cycle
        zero = length * parameters.bidirectional_motor / 2
        return (command - parameters.min_duty_cycle - zero) / (length - zero)


def _evaluate(coefficients: Sequence[float], value: float) -> float:
    return float(sum(coefficient * value**power for power, coefficient in enumerate(coefficients)))


@dataclass(frozen=True, kw_only=True)
class MotorFailureParameters:
    """Parameters of ``libMotorFailurePlugin.so``."""

    failure_topic: str = parameter("", aliases=("MotorFailureTopic",))


class MotorFailure(SimulatedPlugin[MotorFailureParameters]):
    """The substitute for ``libMotorFailurePlugin.so``: a message blocks the rotor of a motor.

    ``std_msgs/msg/Int32`` with N blocks the joint ``rotor_(N-1)_joint``, and 0 releases it.
    """

    PARAMETERS = MotorFailureParameters
    CARRIED = ("_failed",)

    def start(self) -> None:
        """Subscribe to failures."""
        self.reset()
        topic = self.parameters.failure_topic or f"/model/{self.context.path}/motor_failure/motor_number"
        self.node.subscribe("std_msgs/msg/Int32", topic, self._on_failure)
        self.every(0.0, self._block)

    def reset(self) -> None:
        """Release all rotors."""
        self._failed = 0

    def _on_failure(self, message: Any) -> None:
        self._failed = int(message.data)

    def _block(self) -> None:
        for motor in self.model_plugins:
            if isinstance(motor, GzMulticopterMotor):
                match = _ROTOR_JOINT.fullmatch(motor.parameters.joint_name.rpartition(SEPARATOR)[2])
                motor.is_blocked = match is not None and int(match[1]) == self._failed - 1


_MAX_ACCELERATION = 2.0
"""The greatest horizontal acceleration in m/s² with which a platform corrects its velocity."""
_NOISE_CUTOFF_HZ = 5.0


@dataclass(frozen=True, kw_only=True)
class MovingPlatformParameters:
    """Parameters of ``libMovingPlatformController.so``."""

    link_name: str = parameter()


class MovingPlatform(SimulatedPlugin[MovingPlatformParameters]):
    """The substitute for ``libMovingPlatformController.so``: a platform that drives or sails straight on, and shakes.

    The environment variables ``PX4_GZ_PLATFORM_VEL`` (m/s) and ``PX4_GZ_PLATFORM_HEADING_DEG`` set its velocity. The
    platform moves at once, because no vehicle of PX4 appears.
    """

    PARAMETERS = MovingPlatformParameters

    def start(self) -> None:
        """Find the link, and turn the platform to its heading.

        Raises:
            LinkwrightError: SIM133, there is no such link.
        """
        simulation = self.simulation
        self._link = self.link(self.parameters.link_name)
        heading = radians(_read_number("PX4_GZ_PLATFORM_HEADING_DEG", 0.0))
        self._heading = quaternion_from_rpy((0.0, 0.0, heading))
        self._velocity = rotation_matrix(self._heading) @ (_read_number("PX4_GZ_PLATFORM_VEL", 1.0), 0.0, 0.0)
        self._height = simulation.link_pose(self._link)[2]
        pose = simulation.model_pose(self.context.path)
        simulation.set_model_pose(self.context.path, (*pose[:3], *self._heading))
        body = simulation.body(self._link)
        self._mass = float(simulation.model.body_mass[body])
        self._inertia = np.array(simulation.model.body_inertia[body])
        seconds = simulation.step / NANOSECONDS_PER_SECOND
        self._noise_share = seconds / (seconds + 1.0 / (2 * pi * _NOISE_CUTOFF_HZ))
        self.simulation.keep_awake(self._link)
        self.reset()
        self.every(0.0, self._apply_force)

    def resume(self, previous: SimulatedPlugin[MovingPlatformParameters]) -> None:
        """Keep the height of the platform."""
        assert isinstance(previous, MovingPlatform)
        self._height = previous._height

    def reset(self) -> None:
        """Restart the noise."""
        self._generator = self.random
        self._noise = np.zeros((2, 3))

    def _apply_force(self) -> None:
        simulation = self.simulation
        self._noise += self._noise_share * (self._generator.normal(size=(2, 3)) - self._noise)
        pose, (linear, angular) = simulation.link_pose(self._link), simulation.link_velocity(self._link)
        acceleration = self._velocity - linear
        horizontal = float(np.linalg.norm(acceleration[:2]))
        if horizontal > _MAX_ACCELERATION:
            acceleration[:2] *= _MAX_ACCELERATION / horizontal
        acceleration[2] += self._height - pose[2]
        acceleration += self._noise[0] - simulation.model.opt.gravity
        x, y, z, w = quaternion_multiply(pose[3:], quaternion_inverse(self._heading))
        turning = -2.0 * np.array((x, y, z)) * (1.0 if w > 0.0 else -1.0) - angular + self._noise[1]
        self.push(self._link, self._mass * acceleration, self._inertia * turning)


def _read_number(variable: str, default: float) -> float:
    """Return the number in an environment variable, or the default if there is none."""
    try:
        value = float(os.environ.get(variable, ""))
    except ValueError:
        return default
    return value if isfinite(value) else default


_AIR_SPEED_ELEVATION_M, _AIR_SPEED_DEVIATION_PA = 488.0, 1.0
_PRESSURE_TYPE = "sensor_msgs/msg/FluidPressure"


@dataclass(frozen=True, kw_only=True)
class AirSpeedParameters:
    """Parameters of ``libAirSpeedPlugin.so``."""

    link_name: str = parameter()


class AirSpeed(SimulatedPlugin[AirSpeedParameters]):
    """The substitute for ``libAirSpeedPlugin.so``: the dynamic pressure in Pa of the air along the x axis of a link."""

    PARAMETERS = AirSpeedParameters

    def start(self) -> None:
        """Find the link, and create the publisher of ``sensor_msgs/msg/FluidPressure``.

        Raises:
            LinkwrightError: SIM133, there is no such link.
        """
        self._mount = Mount(self.simulation, self.link(self.parameters.link_name))
        model = f"/world/{self.context.world.name}/model/{self.context.path}"
        topic = f"{model}/link/airspeed_link/sensor/air_speed/air_speed"
        self._output = self.node.publisher(_PRESSURE_TYPE, topic, conventional_topic="/air_speed")
        self.reset()
        self.every(0.0, self._publish)

    def reset(self) -> None:
        """Restart the noise."""
        self._generator = self.random

    def _publish(self) -> None:
        if not self._output.is_wanted:
            return
        pressure = measure_dynamic_pressure(self._mount, elevation=_AIR_SPEED_ELEVATION_M)
        message = get_message(_PRESSURE_TYPE)(header=Header(stamp=self.stamp()))
        message.fluid_pressure = pressure + self._generator.normal(0.0, _AIR_SPEED_DEVIATION_PA)
        message.variance = _AIR_SPEED_DEVIATION_PA**2
        self._output.publish(message)
