"""Joints that follow a trajectory: ``gz-sim-joint-trajectory-controller-system``.

Source: gz-sim (parameters, topics, defaults, when each point is approached). Joints are held at a point until the time
of the next point; positions between two points are not interpolated.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from linkwright.diagnostics import joined, phrase
from linkwright.messages import get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.plugins.pid import Gains, Pid
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_ONE_AXIS = frozenset(("revolute", "continuous", "prismatic"))
Many = tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class TrajectoryParameters:
    """Parameters of ``gz-sim-joint-trajectory-controller-system``; lists have one item for each joint, in order."""

    joint_name: tuple[str, ...] = ()
    topic: str = ""
    use_header_start_time: bool = False
    initial_position: Many = ()
    position_p_gain: Many = ()
    position_i_gain: Many = ()
    position_d_gain: Many = ()
    position_i_min: Many = ()
    position_i_max: Many = ()
    position_cmd_min: Many = ()
    position_cmd_max: Many = ()
    position_cmd_offset: Many = ()
    velocity_p_gain: Many = ()
    velocity_i_gain: Many = ()
    velocity_d_gain: Many = ()
    velocity_i_min: Many = ()
    velocity_i_max: Many = ()
    velocity_cmd_min: Many = ()
    velocity_cmd_max: Many = ()
    velocity_cmd_offset: Many = ()

    def gains(self, kind: str, number: int) -> Gains:
        """Return the gains of joint `number` for ``position`` or ``velocity``.

        Gains that are not set are zero, so the controller has no effect.
        """

        def value(name: str, default: float) -> float:
            return _nth(getattr(self, f"{kind}_{name}"), number, default)

        return Gains(
            p=value("p_gain", 0.0),
            i=value("i_gain", 0.0),
            d=value("d_gain", 0.0),
            i_min=value("i_min", 0.0),
            i_max=value("i_max", -1.0),
            cmd_min=value("cmd_min", 0.0),
            cmd_max=value("cmd_max", -1.0),
            cmd_offset=value("cmd_offset", 0.0),
        )


class _Joint:
    """A joint and its targets: position in rad (m), velocity in rad/s (m/s), effort in N m (N)."""

    def __init__(self, name: str, number: int, parameters: TrajectoryParameters) -> None:
        self.name = name
        self.position = _nth(parameters.initial_position, number, 0.0)
        self.velocity = self.effort = 0.0
        self._by_position = Pid(parameters.gains("position", number))
        self._by_velocity = Pid(parameters.gains("velocity", number))

    def aim(self, point: Any, number: int) -> None:
        """Set the targets from item `number` of the lists of a trajectory point.

        A target without a value in the point remains unchanged.
        """
        self.position = _nth(point.positions, number, self.position)
        self.velocity = _nth(point.velocities, number, self.velocity)
        self.effort = _nth(point.effort, number, self.effort)

    def force(self, position: float, velocity: float, seconds: float) -> float:
        """Return the force in N m (N) towards the targets, given the current position and velocity.

        `seconds` is the time since the last call.
        """
        force = self._by_position.force(self.position - position, seconds)
        return force + self._by_velocity.force(self.velocity - velocity, seconds) + self.effort


@dataclass(slots=True)
class _Trajectory:
    """A trajectory that is being followed.

    `start` is the start time in ns, and `index` the index of the point that is being approached.
    """

    message: Any
    start: int
    index: int = 0

    @property
    def is_at_last(self) -> bool:
        return self.index + 1 >= len(self.message.points)

    def advance(self, time: int) -> bool:
        """Advance to the point to approach at a time in ns; return whether the point has changed."""
        before = self.index
        while not self.is_at_last and self.start + _nanoseconds(self._point.time_from_start) < time:
            self.index += 1
        return self.index != before

    @property
    def _point(self) -> Any:
        return self.message.points[self.index]

    def aim(self, joint_of: Callable[[str], _Joint | None]) -> None:
        """Set the targets of the joints that the trajectory names to the current point."""
        for number, name in enumerate(self.message.joint_names):
            joint = joint_of(name)
            if joint is not None:
                joint.aim(self._point, number)


class GzJointTrajectory(SimulatedPlugin[TrajectoryParameters]):
    """The substitute for ``gz-sim-joint-trajectory-controller-system``."""

    PARAMETERS = TrajectoryParameters

    def start(self) -> None:
        """Find the joints, and subscribe to the trajectories."""
        parameters, simulation = self.parameters, self.simulation
        begin = f"{self.place.path}::"
        self._names = parameters.joint_name or tuple(
            name.removeprefix(begin)
            for name, placed in simulation.scene.joints.items()
            if name.startswith(begin) and placed.joint.type in _ONE_AXIS
        )
        self._inside = [self.joint(name) for name in self._names]
        for joint in self._inside:
            simulation.keep_awake(simulation.scene.joints[joint].child)
        topic = parameters.topic or f"/model/{self.place.path}/joint_trajectory"
        self._progress = self.node.publisher("std_msgs/msg/Float32", f"{topic}_progress")
        self.node.subscribe("trajectory_msgs/msg/JointTrajectory", topic, self._commanded, rest=lambda: None)
        self.reset()
        self.every(0.0, self._move)

    def reset(self) -> None:
        """Drop the trajectory, and hold the joints at the initial positions of the parameters."""
        self._joints = {
            name: _Joint(inside, number, self.parameters)
            for number, (name, inside) in enumerate(zip(self._names, self._inside, strict=True))
        }
        self._trajectory: _Trajectory | None = None

    def _commanded(self, message: Any) -> None:
        strange = [name for name in message.joint_names if name not in self._joints]
        if strange:
            names, plugin = joined(strange), self.place.name
            self.node.logger.warning(
                phrase("plugin '{plugin}' does not move a joint named {names}", plugin=plugin, names=names)
            )
        start = _nanoseconds(message.header.stamp) if self.parameters.use_header_start_time else 0
        if not message.points:
            self._trajectory = None
            return
        self._trajectory = _Trajectory(message, start or self.simulation.time)
        self._follow(self._trajectory)

    def _follow(self, trajectory: _Trajectory) -> None:
        """Set the targets to the current point, and publish the progress, from 0 to 1.

        The trajectory ends with its last point.
        """
        trajectory.aim(self._joints.get)
        progress = (trajectory.index + 1) / len(trajectory.message.points)
        self._progress.publish(get_message("std_msgs/msg/Float32")(data=progress))
        if trajectory.is_at_last:
            self._trajectory = None

    def _move(self) -> None:
        if self._trajectory is not None and self._trajectory.advance(self.simulation.time):
            self._follow(self._trajectory)
        seconds = self.simulation.step / NANOSECONDS_PER_SECOND
        for joint in self._joints.values():
            force = joint.force(*self.simulation.joint_state(joint.name), seconds)
            self.simulation.push_joint(joint.name, force)


def _nth(values: Any, number: int, default: float) -> float:
    return float(values[number]) if number < len(values) else default


def _nanoseconds(time: Any) -> int:
    return int(time.sec) * NANOSECONDS_PER_SECOND + int(time.nanosec)
