"""Joints that follow a trajectory: ``gz-sim-joint-trajectory-controller-system``.

Source: gz-sim (parameters, topics, defaults, the times of the points). Joints are held at a point until the time of the
next point; positions between two points are not interpolated.
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

_SINGLE_AXIS_TYPES = frozenset(("revolute", "continuous", "prismatic"))
Floats = tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class TrajectoryParameters:
    """Parameters of ``gz-sim-joint-trajectory-controller-system``.

    Each list has one item per joint.
    """

    joint_name: tuple[str, ...] = ()
    topic: str = ""
    use_header_start_time: bool = False
    initial_position: Floats = ()
    position_p_gain: Floats = ()
    position_i_gain: Floats = ()
    position_d_gain: Floats = ()
    position_i_min: Floats = ()
    position_i_max: Floats = ()
    position_cmd_min: Floats = ()
    position_cmd_max: Floats = ()
    position_cmd_offset: Floats = ()
    velocity_p_gain: Floats = ()
    velocity_i_gain: Floats = ()
    velocity_d_gain: Floats = ()
    velocity_i_min: Floats = ()
    velocity_i_max: Floats = ()
    velocity_cmd_min: Floats = ()
    velocity_cmd_max: Floats = ()
    velocity_cmd_offset: Floats = ()

    def gains(self, kind: str, index: int) -> Gains:
        """Return the gains of joint `index` for ``position`` or ``velocity``.

        Gains that are not set are zero, so the controller has no effect.
        """

        def parameter_value(name: str, default: float) -> float:
            return _get_value(getattr(self, f"{kind}_{name}"), index, default)

        return Gains(
            p=parameter_value("p_gain", 0.0),
            i=parameter_value("i_gain", 0.0),
            d=parameter_value("d_gain", 0.0),
            i_min=parameter_value("i_min", 0.0),
            i_max=parameter_value("i_max", -1.0),
            cmd_min=parameter_value("cmd_min", 0.0),
            cmd_max=parameter_value("cmd_max", -1.0),
            cmd_offset=parameter_value("cmd_offset", 0.0),
        )


class _Joint:
    """A joint with its target position, velocity and effort.

    Units are rad, rad/s and N m, or m, m/s and N.
    """

    def __init__(self, name: str, index: int, parameters: TrajectoryParameters) -> None:
        self.name = name
        self.position = _get_value(parameters.initial_position, index, 0.0)
        self.velocity = self.effort = 0.0
        self._position_controller = Pid(parameters.gains("position", index))
        self._velocity_controller = Pid(parameters.gains("velocity", index))

    def set_targets(self, point: Any, index: int) -> None:
        """Set the targets from item `index` of the lists of a trajectory point.

        A target without a value in the point remains unchanged.
        """
        self.position = _get_value(point.positions, index, self.position)
        self.velocity = _get_value(point.velocities, index, self.velocity)
        self.effort = _get_value(point.effort, index, self.effort)

    def force(self, position: float, velocity: float, seconds: float) -> float:
        """Return the force in N m (or N) towards the targets, from the current state.

        `seconds` is the time since the last call.
        """
        force = self._position_controller.force(self.position - position, seconds)
        return force + self._velocity_controller.force(self.velocity - velocity, seconds) + self.effort


@dataclass(slots=True)
class _Trajectory:
    """A trajectory that the joints follow.

    `start` is the start time in ns; `index` is the index of the current point.
    """

    message: Any
    start: int
    index: int = 0

    @property
    def is_at_last_point(self) -> bool:
        return self.index + 1 >= len(self.message.points)

    def advance(self, time: int) -> bool:
        """Advance to the current point for a time in ns, and return whether the point has changed."""
        old_index = self.index
        while not self.is_at_last_point and self.start + _to_nanoseconds(self._point.time_from_start) < time:
            self.index += 1
        return self.index != old_index

    @property
    def _point(self) -> Any:
        return self.message.points[self.index]

    def set_targets(self, find_joint: Callable[[str], _Joint | None]) -> None:
        """Set the targets of the joints that the trajectory names to the current point."""
        for index, name in enumerate(self.message.joint_names):
            joint = find_joint(name)
            if joint is not None:
                joint.set_targets(self._point, index)


class GzJointTrajectory(SimulatedPlugin[TrajectoryParameters]):
    """The substitute for ``gz-sim-joint-trajectory-controller-system``."""

    PARAMETERS = TrajectoryParameters

    def start(self) -> None:
        """Find the joints, subscribe to the trajectories, and create the topic for the progress."""
        parameters, simulation = self.parameters, self.simulation
        prefix = f"{self.context.path}::"
        self._names = parameters.joint_name or tuple(
            name.removeprefix(prefix)
            for name, scene_joint in simulation.scene.joints.items()
            if name.startswith(prefix) and scene_joint.joint.type in _SINGLE_AXIS_TYPES
        )
        self._scene_names = [self.joint(name) for name in self._names]
        for joint in self._scene_names:
            simulation.keep_awake(simulation.scene.joints[joint].child)
        topic = parameters.topic or f"/model/{self.context.path}/joint_trajectory"
        self._progress = self.node.publisher("std_msgs/msg/Float32", f"{topic}_progress")
        self.node.subscribe("trajectory_msgs/msg/JointTrajectory", topic, self._on_trajectory, stop_motion=lambda: None)
        self.reset()
        self.every(0.0, self._move)

    def reset(self) -> None:
        """Drop the trajectory, and hold the joints at the initial positions of the parameters."""
        self._joints = {
            name: _Joint(scene_name, index, self.parameters)
            for index, (name, scene_name) in enumerate(zip(self._names, self._scene_names, strict=True))
        }
        self._trajectory: _Trajectory | None = None

    def _on_trajectory(self, message: Any) -> None:
        unknown_names = [name for name in message.joint_names if name not in self._joints]
        if unknown_names:
            names, plugin = joined(unknown_names), self.context.name
            self.node.logger.warning(
                phrase("plugin '{plugin}' does not control a joint named {names}", plugin=plugin, names=names)
            )
        start = _to_nanoseconds(message.header.stamp) if self.parameters.use_header_start_time else 0
        if not message.points:
            self._trajectory = None
            return
        self._trajectory = _Trajectory(message, start or self.simulation.time)
        self._apply_point(self._trajectory)

    def _apply_point(self, trajectory: _Trajectory) -> None:
        """Set the targets to the current point, and publish the progress from 0 to 1.

        The trajectory is dropped when it reaches the last point.
        """
        trajectory.set_targets(self._joints.get)
        progress = (trajectory.index + 1) / len(trajectory.message.points)
        self._progress.publish(get_message("std_msgs/msg/Float32")(data=progress))
        if trajectory.is_at_last_point:
            self._trajectory = None

    def _move(self) -> None:
        if self._trajectory is not None and self._trajectory.advance(self.simulation.time):
            self._apply_point(self._trajectory)
        seconds = self.simulation.step / NANOSECONDS_PER_SECOND
        for joint in self._joints.values():
            force = joint.force(*self.simulation.joint_state(joint.name), seconds)
            self.simulation.push_joint(joint.name, force)


def _get_value(values: Any, index: int, default: float) -> float:
    return float(values[index]) if index < len(values) else default


def _to_nanoseconds(time: Any) -> int:
    return int(time.sec) * NANOSECONDS_PER_SECOND + int(time.nanosec)
