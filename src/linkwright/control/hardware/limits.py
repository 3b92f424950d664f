"""Limits of joints, applied to commands.

Source: joint_limits of ros2_control (``enforce_command_limits`` of the controller manager, and the limits for each
kind of command). The limits come from the joint's ``<limit>`` and ``<safety_controller>``, narrowed by ``min`` and
``max`` of its command interfaces; ``<limits enable="false"/>`` disables them. A velocity or effort limit of 0 means no
limit. A deliberate difference: a position command never moves faster from the last command than the velocity limit.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from math import inf, isfinite, isnan

from linkwright.control.hardware.description import ComponentDescription, InterfaceDescription
from linkwright.control.hardware.interfaces import (
    ACCELERATION,
    EFFORT,
    POSITION,
    VELOCITY,
    CommandInterface,
    StateInterface,
)
from linkwright.diagnostics import phrase
from linkwright.graph.log.logger import Logger
from linkwright.urdf import Joint
from linkwright.urdf.model import Safety

_UNLIMITED = (-inf, inf)


@dataclass(frozen=True, slots=True)
class JointLimits:
    """The limits of a joint in rad and N m, or m and N, and seconds.

    Missing limits are infinite.

    Attributes:
        position: the minimum and the maximum position.
        velocity, effort: the maximum velocity and effort in both directions.
        acceleration, deceleration: the maximum acceleration and deceleration, for velocity and acceleration commands.
        safety: the soft limits, within the other limits; None if there are none.
        kinds: the kinds of interfaces whose commands are limited.
    """

    position: tuple[float, float] = _UNLIMITED
    velocity: float = inf
    effort: float = inf
    acceleration: float = inf
    deceleration: float = inf
    safety: Safety | None = None
    kinds: frozenset[str] = frozenset()


def limits_from_joint(joint: Joint, component: ComponentDescription) -> JointLimits:
    """Return the limits of a joint, from its URDF element and its description as hardware."""
    limit, interfaces = joint.limit, {command.name: command for command in component.commands}
    position, velocity, effort, acceleration, deceleration = _UNLIMITED, inf, inf, inf, inf
    if limit is not None:
        if joint.type in ("revolute", "prismatic"):
            position = (limit.lower, limit.upper)
        velocity, effort = abs(limit.velocity) or inf, abs(limit.effort) or inf
        acceleration = abs(limit.acceleration or inf)
        deceleration = abs(limit.deceleration or acceleration)
    lower, upper = _get_bounds(interfaces.get(POSITION))
    acceleration = min(acceleration, _get_max_magnitude(interfaces.get(ACCELERATION)))
    return JointLimits(
        (max(position[0], lower), min(position[1], upper)),
        min(velocity, _get_max_magnitude(interfaces.get(VELOCITY))),
        min(effort, _get_max_magnitude(interfaces.get(EFFORT))),
        acceleration,
        deceleration if isfinite(deceleration) else acceleration,
        joint.safety,
        frozenset(command.name for command in component.commands if command.is_limited),
    )


class JointLimiter:
    """A limiter of the commands of a joint.

    Args:
        name: the joint's name.
        limits: the joint's limits.
        commands: the joint's command interfaces by kind.
        states: the joint's state interfaces by kind.
    """

    def __init__(
        self,
        name: str,
        limits: JointLimits,
        commands: Mapping[str, CommandInterface],
        states: Mapping[str, StateInterface],
    ) -> None:
        self.name = name
        self._limits = limits
        self._limit_functions = {
            POSITION: self._limit_position,
            VELOCITY: self._limit_velocity,
            EFFORT: self._limit_effort,
            ACCELERATION: self._limit_acceleration,
        }
        self._commands = {
            kind: command
            for kind, command in commands.items()
            if kind in self._limit_functions and kind in limits.kinds
        }
        self._states = states
        self._last_commands: dict[str, float] = {}

    def enforce(self, period_s: float, claimed_names: Collection[str]) -> list[tuple[str, float, float]]:
        """Limit commands in place.

        Args:
            period_s: the time since the last call, in seconds.
            claimed_names: names of the interfaces that controllers have claimed; other interfaces are ignored.

        Returns:
            For each command outside its limits: the kind, the commanded value and the limited value.
        """
        exceeded = []
        for kind, command in self._commands.items():
            requested = command.value
            if command.name not in claimed_names:
                self._last_commands.pop(kind, None)
            elif not isnan(requested):
                limited = self._last_commands[kind] = self._limit_functions[kind](requested, period_s)
                if limited != requested:
                    command.value = limited
                    exceeded.append((kind, requested, limited))
        return exceeded

    def _get_state(self, kind: str) -> float | None:
        state = self._states.get(kind)
        return None if state is None or not isfinite(state.value) else state.value

    def _compute_velocity_range(self, position: float | None) -> tuple[float, float]:
        """Return the velocity limits in both directions, reduced near soft limits."""
        max_velocity, safety = self._limits.velocity, self._limits.safety
        if safety is None or position is None or not safety.k_position:
            return -max_velocity, max_velocity
        low = safety.k_position * (safety.soft_lower_limit - position)
        high = safety.k_position * (safety.soft_upper_limit - position)
        return _clamp(low, -max_velocity, max_velocity), _clamp(high, -max_velocity, max_velocity)

    def _limit_position(self, requested: float, period_s: float) -> float:
        last_position = self._last_commands.get(POSITION, self._get_state(POSITION))
        requested = _clamp(requested, *self._limits.position)
        if last_position is None:
            return requested
        low, high = self._compute_velocity_range(last_position)
        return _clamp(requested, last_position + low * period_s, last_position + high * period_s)

    def _limit_velocity(self, requested: float, period_s: float) -> float:
        limits, position = self._limits, self._get_state(POSITION)
        low, high = self._compute_velocity_range(position)
        requested = _clamp(requested, low, high)
        last_velocity = self._last_commands.get(VELOCITY, self._get_state(VELOCITY))
        if last_velocity is not None:
            max_increase = limits.acceleration if last_velocity >= 0.0 else limits.deceleration
            max_decrease = limits.deceleration if last_velocity > 0.0 else limits.acceleration
            requested = _clamp(
                requested, last_velocity - max_decrease * period_s, last_velocity + max_increase * period_s
            )
        if position is None or period_s <= 0.0:
            return requested
        lower, upper = limits.position
        return _clamp(requested, min(0.0, (lower - position) / period_s), max(0.0, (upper - position) / period_s))

    def _limit_effort(self, requested: float, period_s: float) -> float:
        limits, safety = self._limits, self._limits.safety
        low, high = -limits.effort, limits.effort
        position, velocity = self._get_state(POSITION), self._get_state(VELOCITY)
        if position is not None:
            low = 0.0 if position <= limits.position[0] else low
            high = 0.0 if position >= limits.position[1] else high
        if velocity is not None:
            min_velocity, max_velocity = self._compute_velocity_range(position)
            if safety is not None and safety.k_velocity:
                low = _clamp(safety.k_velocity * (min_velocity - velocity), low, high)
                high = _clamp(safety.k_velocity * (max_velocity - velocity), low, high)
            else:
                low = 0.0 if velocity < min_velocity else low
                high = 0.0 if velocity > max_velocity else high
        return _clamp(requested, low, high)

    def _limit_acceleration(self, requested: float, period_s: float) -> float:
        velocity = self._get_state(VELOCITY) or 0.0
        is_braking = requested * velocity < 0.0
        max_acceleration = self._limits.deceleration if is_braking else self._limits.acceleration
        return _clamp(requested, -max_acceleration, max_acceleration)


class CommandLimits:
    """A limiter of the commands of all joints.

    The first limited command of each interface is logged.

    Args:
        limiters: the limiters of the joints.
        logger: the logger of the warnings.
    """

    def __init__(self, limiters: Sequence[JointLimiter], logger: Logger) -> None:
        self._limiters = limiters
        self._logger = logger
        self._logged_interfaces: set[tuple[str, str]] = set()

    def enforce(self, period_s: float, claimed_names: Collection[str]) -> None:
        """Limit commands in place, as in `JointLimiter.enforce`."""
        for limiter in self._limiters:
            for kind, requested, limited in limiter.enforce(period_s, claimed_names):
                if (limiter.name, kind) not in self._logged_interfaces:
                    self._logged_interfaces.add((limiter.name, kind))
                    self._logger.warning(
                        phrase(
                            "joint '{joint}': the commanded {kind} {requested:g} is outside its limits; {limited:g} "
                            "is sent instead (reported once)",
                            joint=limiter.name,
                            kind=kind,
                            requested=requested,
                            limited=limited,
                        )
                    )


def _get_bounds(interface: InterfaceDescription | None) -> tuple[float, float]:
    """Return the minimum and maximum of an interface in the description.

    Missing bounds are infinite.
    """
    if interface is None:
        return _UNLIMITED
    return (
        -inf if isnan(interface.minimum) else interface.minimum,
        inf if isnan(interface.maximum) else interface.maximum,
    )


def _get_max_magnitude(interface: InterfaceDescription | None) -> float:
    """Return the largest magnitude that an interface permits in both directions."""
    lower, upper = _get_bounds(interface)
    return min(abs(lower), abs(upper))


def _clamp(value: float, minimum: float, maximum: float) -> float:
    return min(max(value, minimum), maximum)
