"""Joint actuators: motors that hold a velocity, and servos that hold a position."""

from __future__ import annotations

from math import isfinite
from typing import Any, Protocol

from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.scene.scene import SERVO_TIME_CONSTANT, Scene

_DEFAULT_SERVO_SPEED = 2.0
"""The speed of a servo if neither the caller nor the joint limits it, in rad/s or m/s."""
_SERVO_LAG_S = 2.0 * SERVO_TIME_CONSTANT
"""The time in s by which a joint follows the moving target of a critically damped constraint."""

EXACT_VELOCITY_GAIN = 10_000.0
"""The gain of motors without a limit, in N m per rad/s of velocity error (N per m/s for prismatic joints).

Gazebo sets velocities exactly. With a gain of 20, a level arm of 1 kg sinks at 0.25 rad/s, and the wheels of a
skid-steered robot of 46 kg yield to the friction of a turn.
"""


class ActuatedSimulation(Protocol):
    """The attributes and methods of `Simulation` that actuators use."""

    @property
    def scene(self) -> Scene:
        """The scene whose joints the actuators move."""

    @property
    def model(self) -> Any:
        """The current MuJoCo model, which `recompile_if_changed` replaces."""

    @property
    def data(self) -> Any:
        """The current MuJoCo data, which `recompile_if_changed` replaces."""

    @property
    def revision(self) -> int:
        """The number of times that the model and the data were rebuilt.

        A cached index is valid for one revision.
        """

    def recompile_if_changed(self) -> None:
        """Recompile the MuJoCo model if the scene has changed."""

    def refresh(self) -> None:
        """Call `recompile_if_changed`, and update the MuJoCo data that is derived from positions."""

    def joint_state(self, name: str) -> tuple[float, float]:
        """Return the position and velocity of a joint with one axis.

        Units are rad and rad/s, or m and m/s.
        """


class Motor:
    """A motor that keeps a joint at a target velocity."""

    def __init__(self, simulation: ActuatedSimulation, name: str) -> None:
        self._simulation = simulation
        self._name = name
        self._revision = -1
        self._cached_index = -1
        self._released_gain = 0.0

    @property
    def target(self) -> float:
        """The target velocity, in rad/s, or in m/s for a prismatic joint."""
        index = self._find_actuator()
        return float(self._simulation.data.ctrl[index])

    @target.setter
    def target(self, velocity: float) -> None:
        index = self._find_actuator()
        self._simulation.data.ctrl[index] = velocity
        if self._released_gain:
            self._set_gain(index, self._released_gain)
            self._released_gain = 0.0

    def release(self) -> None:
        """Switch the motor off until a target is set."""
        index = self._find_actuator()
        gain = float(self._simulation.model.actuator_gainprm[index, 0])
        if gain:
            self._released_gain = gain
            self._set_gain(index, 0.0)

    def _set_gain(self, index: int, gain: float) -> None:
        model = self._simulation.model
        model.actuator_gainprm[index, 0], model.actuator_biasprm[index, 2] = gain, -gain

    def _find_actuator(self) -> int:
        """Return the index of the actuator in MuJoCo's current model."""
        simulation = self._simulation
        simulation.recompile_if_changed()
        if self._revision != simulation.revision:
            self._cached_index = int(simulation.model.actuator(self._name).id)
            self._revision = simulation.revision
        return self._cached_index


class Servo:
    """A servo that holds a joint with one axis at a position, and moves it to new positions.

    The constraint that holds the joint also damps its velocity, so that the joint would lag behind targets that move
    steadily. The constraint is therefore set ahead of them. It is not ahead of targets that jump, or that are reached
    at the maximum speed, because the joint would overshoot.

    The friction of the joint does not act meanwhile, because it would hold light joints beside their targets: MuJoCo
    computes the force of the constraint as if the friction were soft.

    `Simulation.recompile_if_changed` runs on first use, so adding many servos compiles the model only once.

    Args:
        simulation: the simulation that contains the joint.
        joint: the name of the joint.
        name: the name of the constraint that holds the joint.
        speed: the maximum speed in rad/s (or m/s), limited to the joint's speed limit. If both are infinite, the servo
            moves at 2 rad/s (or m/s).
    """

    def __init__(self, simulation: ActuatedSimulation, joint: str, name: str, speed: float) -> None:
        self._simulation = simulation
        self._joint = joint
        self._name = name
        speed = min(speed, simulation.scene.speed_limit(joint))
        self._speed = speed if isfinite(speed) else _DEFAULT_SERVO_SPEED
        self._position = 0.0
        self._rate = 0.0
        self._friction = 0.0

    @property
    def model(self) -> str:
        """The name of the model to which the joint belongs."""
        return self._joint.partition(SEPARATOR)[0]

    @property
    def position(self) -> float:
        """The position at which the joint is held, in rad (or m)."""
        self._simulation.recompile_if_changed()
        return self._position

    def restart(self) -> None:
        """Hold the joint at its current position."""
        self._position, self._rate = self._simulation.joint_state(self._joint)[0], 0.0
        self._hold(self._position)

    def release(self) -> None:
        """Switch the servo off until `restart` or `move` is called."""
        simulation = self._simulation
        simulation.refresh()
        simulation.data.eq_active[simulation.model.equality(self._name).id] = 0
        if self._friction:
            simulation.model.dof_frictionloss[simulation.model.joint(self._joint).dofadr[0]] = self._friction
            self._friction = 0.0

    def move(self, target: float, seconds: float) -> None:
        """Move the joint towards a target, by at most the maximum speed times `seconds`.

        The target is a position in rad (or m), which is clipped to the joint's limits.
        """
        self._simulation.recompile_if_changed()
        model = self._simulation.model
        joint = model.joint(self._joint)
        if model.jnt_limited[joint.id]:
            lower, upper = model.jnt_range[joint.id]
            target = min(max(target, float(lower)), float(upper))
        max_change = self._speed * seconds
        position = min(max(target, self._position - max_change), self._position + max_change)
        rate = (position - self._position) / seconds if position == target and seconds > 0.0 else 0.0
        is_steady = rate * self._rate > 0.0
        lag_s = _SERVO_LAG_S - (seconds - model.opt.timestep) / 2.0  # The joint has the target of a period at its end.
        lead = max(0.0, lag_s) * min(rate, self._rate, key=abs) if is_steady else 0.0
        self._position, self._rate = position, rate
        self._hold(position + lead)

    def _hold(self, position: float) -> None:
        self._simulation.refresh()
        model = self._simulation.model
        joint = model.joint(self._joint)
        reference_position, dof = model.qpos0[joint.qposadr[0]], joint.dofadr[0]
        if model.dof_frictionloss[dof]:  # A compiled model has it again.
            self._friction = float(model.dof_frictionloss[dof])
            model.dof_frictionloss[dof] = 0.0
        constraint_index = model.equality(self._name).id
        model.eq_data[constraint_index, 0] = position - reference_position
        self._simulation.data.eq_active[constraint_index] = 1
