"""The controllers of quadrotors without rotors.

A force along the z axis of the body and a torque keep the commanded velocity. The controllers of the horizontal
velocity tilt the body; those of the tilt, the turning rate and the vertical velocity give accelerations.

Source: hector_quadrotor and sjtu_drone (parameters, defaults, formulas).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin
from typing import Any, ClassVar, TypeVar

import numpy as np

from linkwright.geometry.arrays import Array, rotation_matrix
from linkwright.geometry.single import rpy_from_quaternion
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.plugins.entities import vector_components
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

P = TypeVar("P", bound="QuadrotorParameters")
TWIST_TYPE = "geometry_msgs/msg/Twist"
LOOPS = ("rollpitch", "yaw", "velocityXY", "velocityZ")
_AXES = dict.fromkeys(("rollpitch", "velocityXY", "positionXY"), ("x", "y"))
_GAINS = ("ProportionalGain", "IntegralGain", "DifferentialGain", "TimeConstant", "Limit")


def gain_names(loops: tuple[str, ...]) -> tuple[str, ...]:
    """Return the names of the parameters of controllers."""
    return tuple(f"{loop}{gain}" for loop in loops for gain in _GAINS)


@dataclass(kw_only=True)
class _Loop:
    """A PID controller of a value, with a limit and a filter for its command.

    Attributes:
        p, i, d: the gains.
        time_constant: the time constant of the filter in s.
        limit: the greatest command; there is no limit if it is not positive.
        is_late: whether the derivative of the command is that after filtering.
        integral: the integral of the error.
    """

    p: float
    i: float
    d: float
    time_constant: float
    limit: float
    is_late: bool
    integral: float = 0.0
    _filtered: float = 0.0

    def update(self, command: float, value: float, rate: float, seconds: float) -> float:
        """Return the output for a command, and for the current value and its rate of change."""
        if self.limit > 0.0:
            command = min(max(command, -self.limit), self.limit)
        time = seconds + self.time_constant
        old_error = command - self._filtered
        self._filtered += seconds / time * old_error
        change = (command - self._filtered if self.is_late else old_error) / time
        error = self._filtered - value
        self.integral += seconds * error
        return self.p * error + self.i * self.integral + self.d * (change - rate)

    def reset(self) -> None:
        """Forget the command and the integral."""
        self.integral = self._filtered = 0.0


@dataclass(frozen=True, slots=True)
class Motion:
    """The motion of the body: `velocity`, `acceleration` and `rates` are in the axes of the world."""

    rotation: Array
    rpy: tuple[float, float, float]
    position: Array
    velocity: Array
    acceleration: Array
    rates: Array
    seconds: float

    def to_heading(self, vector: Array) -> Array:
        """Return a vector of the world in axes that turn with the body about the vertical."""
        yaw = self.rpy[2]
        x, y, z = vector
        return np.array((cos(yaw) * x + sin(yaw) * y, -sin(yaw) * x + cos(yaw) * y, z))


@dataclass(frozen=True, kw_only=True)
class QuadrotorParameters:
    """Parameters of both plugins; the gains are read from the element."""

    body_name: str = parameter("", aliases=("bodyName",))
    max_force: float = parameter(-1.0, aliases=("maxForce",))


class Quadrotor(SimulatedPlugin[P]):
    """The controllers of a quadrotor."""

    LOOPS: ClassVar[tuple[str, ...]] = LOOPS
    DEFAULT_GAINS: ClassVar[tuple[float, float, float]] = (0.0, 0.0, 0.0)
    IS_LATE: ClassVar[bool] = False

    def start(self) -> None:
        """Find the body, and read the gains.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, a gain is not a number.
        """
        name, simulation = self.parameters.body_name, self.simulation
        self.body = self.link(name) if name else self.first_link
        index = simulation.body(self.body)
        self.mass, self.inertia = float(simulation.model.body_mass[index]), simulation.model.body_inertia[index].copy()
        self.loops = {f"{loop}{axis}": self._read_loop(loop) for loop in self.LOOPS for axis in _AXES.get(loop, ("",))}
        simulation.keep_awake(self.body)
        self.command: tuple[Array, Array] = (np.zeros(3), np.zeros(3))
        self._old_velocity: Array = np.zeros(3)

    def _read_loop(self, loop: str) -> _Loop:
        element, defaults = self.context.element, (*self.DEFAULT_GAINS, 0.0, -1.0)
        p, i, d, time_constant, limit = (
            self.number_in(element, f"{loop}{gain}", default) for gain, default in zip(_GAINS, defaults, strict=True)
        )
        return _Loop(p=p, i=i, d=d, time_constant=time_constant, limit=limit, is_late=self.IS_LATE)

    def reset(self) -> None:
        """Reset the controllers, and drop the command."""
        self.command = np.zeros(3), np.zeros(3)
        self.reset_loops()

    def reset_loops(self) -> None:
        """Reset the controllers."""
        for loop in self.loops.values():
            loop.reset()
        self._old_velocity = np.zeros(3)

    def set_command(self, twist: Any) -> None:
        """Take the linear and angular velocity of a message as the command."""
        self.command = np.array(vector_components(twist.linear)), np.array(vector_components(twist.angular))

    def stop_motion(self) -> bool:
        """Command the body to hover, and return whether a motion was commanded before."""
        had_motion = bool(self.command[0].any() or self.command[1].any())
        self.command = np.zeros(3), np.zeros(3)
        return had_motion

    def sense(self) -> Motion:
        """Return the current motion of the body."""
        pose, (velocity, rates) = self.simulation.link_pose(self.body), self.simulation.link_velocity(self.body)
        seconds = self.simulation.step / NANOSECONDS_PER_SECOND
        acceleration, self._old_velocity = (velocity - self._old_velocity) / seconds, velocity
        rotation = np.array(rotation_matrix(np.array(pose[3:])))
        rpy = rpy_from_quaternion(pose[3:])
        return Motion(rotation, rpy, np.array(pose[:3]), velocity, acceleration, rates, seconds)

    def compute_tilt_torque(self, motion: Motion, roll: float, pitch: float) -> Array:
        """Return the torque in N m, in the axes of the body, that tilts it by commanded angles in rad."""
        rates = motion.rotation.T @ motion.rates
        angles = (roll, pitch)
        accelerations = [
            self.loops[f"rollpitch{axis}"].update(angles[index], motion.rpy[index], rates[index], motion.seconds)
            for index, axis in enumerate("xy")
        ]
        torque: Array = self.inertia * (*accelerations, 0.0)
        return torque

    def compute_velocity_torque(self, motion: Motion, target: Array) -> Array:
        """Return the torque that tilts the body toward a horizontal velocity in m/s, in the axes of the heading."""
        velocity, acceleration = motion.to_heading(motion.velocity), motion.to_heading(motion.acceleration)
        forward, left = (
            self.loops[f"velocityXY{axis}"].update(target[index], velocity[index], acceleration[index], motion.seconds)
            for index, axis in enumerate("xy")
        )
        gravity = float(np.linalg.norm(self.simulation.model.opt.gravity))
        return self.compute_tilt_torque(motion, -left / gravity, forward / gravity)

    def compute_yaw_torque(self, motion: Motion, rate: float) -> Array:
        """Return the torque about z for a commanded turning rate in rad/s."""
        acceleration = self.loops["yaw"].update(rate, motion.rates[2], 0.0, motion.seconds)
        return np.array((0.0, 0.0, self.inertia[2] * acceleration))

    def compute_force(self, motion: Motion, climb: float) -> Array:
        """Return the force in N, in the axes of the body, for a commanded vertical velocity in m/s."""
        velocity, acceleration = motion.velocity[2], motion.acceleration[2]
        gravity = float(np.linalg.norm(self.simulation.model.opt.gravity))
        upright = motion.rotation[2, 2]
        lift = self.loops["velocityZ"].update(climb, velocity, acceleration, motion.seconds)
        force = self.mass * (lift + (gravity / upright if upright else gravity))
        limit = self.parameters.max_force
        return np.array((0.0, 0.0, max(min(force, limit) if limit > 0.0 else force, 0.0)))
