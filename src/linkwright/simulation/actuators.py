"""Actuators of joints: motors that hold a velocity, servos that hold a position."""

from __future__ import annotations

from math import isfinite
from typing import Any, Protocol

from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.scene.scene import Scene

_SERVO_SPEED = 2.0
"""The default speed of a servo in rad/s or m/s."""


class Actuated(Protocol):
    """The part of `Simulation` that actuators use; see there."""

    @property
    def scene(self) -> Scene:
        """The scene whose joints are moved."""

    @property
    def model(self) -> Any:
        """The current MuJoCo model, which `renew` replaces."""

    @property
    def data(self) -> Any:
        """The current MuJoCo data, which `renew` replaces."""

    @property
    def revision(self) -> int:
        """The number of times that model and data were rebuilt."""

    def renew(self) -> None:
        """Compile MuJoCo's model again if the scene has changed."""

    def refresh(self) -> None:
        """Do the work of `renew`, and compute the values that depend on positions."""

    def joint_state(self, name: str) -> tuple[float, float]:
        """Position and velocity of a joint of one axis."""


class Motor:
    """A motor of a joint that holds a velocity."""

    def __init__(self, simulation: Actuated, name: str) -> None:
        self._simulation = simulation
        self._name = name
        self._revision = -1
        self._number = -1
        self._gain = 0.0

    @property
    def target(self) -> float:
        """The velocity to be held, in rad/s (m/s)."""
        number = self._actuator()
        return float(self._simulation.data.ctrl[number])

    @target.setter
    def target(self, velocity: float) -> None:
        number = self._actuator()
        self._simulation.data.ctrl[number] = velocity
        if self._gain:
            self._set_gain(number, self._gain)
            self._gain = 0.0

    def release(self) -> None:
        """Switch the motor off until a target is set; to be called again after the model has changed."""
        number = self._actuator()
        gain = float(self._simulation.model.actuator_gainprm[number, 0])
        if gain:
            self._gain = gain
            self._set_gain(number, 0.0)

    def _set_gain(self, number: int, gain: float) -> None:
        model = self._simulation.model
        model.actuator_gainprm[number, 0], model.actuator_biasprm[number, 2] = gain, -gain

    def _actuator(self) -> int:
        """The index of the actuator in MuJoCo's current model."""
        simulation = self._simulation
        simulation.renew()
        if self._revision != simulation.revision:
            self._number = int(simulation.model.actuator(self._name).id)
            self._revision = simulation.revision
        return self._number


class Servo:
    """Holds a joint of one axis in a position, and moves it to others.

    It begins with `Simulation.renew`, so that many servos make one new model.

    Args:
        simulation: the simulation.
        joint: the name of the joint.
        name: that of the constraint.
        speed: how fast it may move in rad/s (m/s).
    """

    def __init__(self, simulation: Actuated, joint: str, name: str, speed: float) -> None:
        self._simulation = simulation
        self._joint = joint
        self._name = name
        speed = min(speed, simulation.scene.speed_limit(joint))
        self._speed = speed if isfinite(speed) else _SERVO_SPEED
        self._position = 0.0

    @property
    def model(self) -> str:
        """The name of the model whose joint it holds."""
        return self._joint.partition(SEPARATOR)[0]

    @property
    def position(self) -> float:
        """The position at which the joint is held, in rad (m)."""
        self._simulation.renew()
        return self._position

    def restart(self) -> None:
        """Hold the joint where it is."""
        self._position = self._simulation.joint_state(self._joint)[0]
        self._hold()

    def release(self) -> None:
        """Switch the servo off until `restart` or `move`."""
        simulation = self._simulation
        simulation.refresh()
        simulation.data.eq_active[simulation.model.equality(self._name).id] = 0

    def move(self, target: float, seconds: float) -> None:
        """Move to a position within the joint's limits, in rad (m), within a number of seconds."""
        self._simulation.renew()
        model = self._simulation.model
        joint = model.joint(self._joint)
        if model.jnt_limited[joint.id]:
            lower, upper = model.jnt_range[joint.id]
            target = min(max(target, float(lower)), float(upper))
        way = self._speed * seconds
        self._position = min(max(target, self._position - way), self._position + way)
        self._hold()

    def _hold(self) -> None:
        self._simulation.refresh()
        model = self._simulation.model
        start = model.qpos0[model.joint(self._joint).qposadr[0]]
        number = model.equality(self._name).id
        model.eq_data[number, 0] = self._position - start
        self._simulation.data.eq_active[number] = 1
