"""The display moveit_rviz_plugin/Trajectory, and a player for motions."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise, zip_longest
from typing import Any

from linkwright.diagnostics import foreign, phrase
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, Schema
from linkwright.rviz.displays.base.display import DisplayHost, Pose
from linkwright.rviz.displays.moveit.base import STATE, MoveItDisplay
from linkwright.rviz.displays.moveit.properties import DESCRIPTION_SPEC, TRAJECTORY_TOPIC, path_specs, read_appearance
from linkwright.rviz.displays.moveit.robot import JointPositions, PosableRobot, UnusableStateError

_SECONDS_PATTERN = re.compile(r"([0-9]*\.?[0-9]+)\s*s?")
_FACTOR_PATTERN = re.compile(r"([0-9]*\.?[0-9]+)\s*x")
_LOOP_PROPERTY = "Loop Animation"
_MIN_DELAY_S = 0.005
_MAX_STATES = 100_000
_MAX_TRAIL_STATES = 200
"""The largest number of states in a trail. Longer trails are drawn with larger steps."""

DEFAULT_DISPLAY_TIME = "3x"
"""The value that is used if the State Display Time is not valid."""


@dataclass(frozen=True, slots=True)
class Motion:
    """A robot's motion as a sequence of states.

    Attributes:
        states: the states, beginning with the start state.
        durations: the time from each state to the next, seconds.
        joints: the names of the joints that move.
        unknown_joints: the names of joints in the message that the robot does not have.
    """

    states: list[JointPositions]
    durations: list[float]
    joints: frozenset[str]
    unknown_joints: list[str]


def read_motion(robot: PosableRobot, message: Any) -> Motion:
    """Return the motion in a moveit_msgs/msg/DisplayTrajectory.

    Raises:
        UnusableStateError: the message has no states, too many states, or a state that cannot be shown.
    """
    state = JointPositions()
    unknown = robot.set_state(state, message.trajectory_start)
    states, durations = [state.copy()], []
    joints: set[str] = set()
    for partial_trajectory in message.trajectory:
        joint_trajectory, root_trajectory = (
            partial_trajectory.joint_trajectory,
            partial_trajectory.multi_dof_joint_trajectory,
        )
        if len(states) + max(len(joint_trajectory.points), len(root_trajectory.points)) > _MAX_STATES:
            raise UnusableStateError(phrase("The motion has more than {maximum} states", maximum=_MAX_STATES))
        joints.update(joint_trajectory.joint_names)
        times = [0.0]
        for point, root_point in zip_longest(joint_trajectory.points, root_trajectory.points):
            if point is not None:
                unknown_names = robot.set_joints(state, joint_trajectory.joint_names, point.positions)
                unknown += [name for name in unknown_names if name not in unknown]
            if root_point is not None:
                _set_root(robot, state, root_trajectory, root_point)
            times.append(_to_seconds((root_point if point is None else point).time_from_start))
            states.append(state.copy())
        durations += [max(0.0, after - before) for before, after in pairwise(times)]
    if len(states) < 2:
        raise UnusableStateError(phrase("The motion has no states"))
    return Motion(states, durations, frozenset(joints), unknown)


def _set_root(robot: PosableRobot, state: JointPositions, trajectory: Any, point: Any) -> None:
    """Set the root's pose from a point of a trajectory_msgs/msg/MultiDOFJointTrajectory.

    Joints that the robot does not have move the root.
    """
    for name, transform in zip(trajectory.joint_names, point.transforms, strict=False):
        if not robot.has_joint(name):
            robot.set_root(state, trajectory.header.frame_id, transform)


def _to_seconds(duration: Any) -> float:
    return float(duration.sec) + float(duration.nanosec) * 1e-9


def compute_display_time_s(text: str, duration: float) -> float:
    """Return how long a state is shown, in seconds.

    Args:
        text: the value of the property State Display Time.
        duration: the time from this state to the next in the motion, seconds.
    """
    text = text.strip().lower()
    if text == "realtime":
        return duration
    factor = _FACTOR_PATTERN.fullmatch(text)
    if factor and float(factor[1]) > 0.0:
        return duration / float(factor[1])
    fixed_seconds = _SECONDS_PATTERN.fullmatch(text)
    return float(fixed_seconds[1]) if fixed_seconds else compute_display_time_s(DEFAULT_DISPLAY_TIME, duration)


class MotionPlayer:
    """A player of motions that shows their states one after the other.

    Args:
        display: the display that has the properties.
        group_path: the path of the group that contains the properties of the motion.
        on_state: called when another state is to be drawn.
    """

    def __init__(self, display: MoveItDisplay, group_path: Path, on_state: Callable[[], None]) -> None:
        self._display = display
        self._group_path = group_path
        self._on_state = on_state
        self._message: Any = None
        self._next_message: Any = None
        self._state_index = 0
        self._timer: asyncio.TimerHandle | None = None
        self.motion: Motion | None = None

    @property
    def is_playing(self) -> bool:
        """Whether a motion is being played."""
        return self._timer is not None

    @property
    def state(self) -> JointPositions | None:
        """The state to draw, or None if no motion is being played."""
        return self.motion.states[self._state_index] if self.motion and self.is_playing else None

    def play(self, message: Any) -> None:
        """Play a moveit_msgs/msg/DisplayTrajectory, immediately or after the current motion.

        The new motion waits for the end of the current motion, unless ``Interrupt Display`` or ``Loop Animation`` is
        on.
        """
        if self.is_playing and not self._flag("Interrupt Display") and not self._flag(_LOOP_PROPERTY):
            self._next_message = message
            return
        self._message = message
        self._begin()

    def on_property_changed(self, path: Path) -> None:
        """Play the last motion again if looping was just enabled."""
        if path == (*self._group_path, _LOOP_PROPERTY) and self._flag(_LOOP_PROPERTY) and not self.is_playing:
            self.restart()

    def restart(self) -> None:
        """Play the last motion from its beginning, with the display's current robot."""
        if self._message is not None:
            self._begin()

    def clear(self) -> None:
        """Stop playing and discard the motion."""
        self._stop()
        self._message = self._next_message = self.motion = None

    def draw(self, group: str) -> None:
        """Put the current state and the trail into two marker groups of the display."""
        robot, motion = self._display.robot, self.motion
        state_markers, trail_markers = [], []
        if robot is not None and motion is not None:
            properties = self._display.properties
            color = properties.text(*self._group_path, "Robot Color") if self._flag("Color Enabled") else None
            if self.state is not None:
                state_markers = robot.make_markers(
                    self.state, read_appearance(properties, robot, group, self._group_path, color)
                )
            if self._flag("Show Trail"):
                step = int(properties.number(*self._group_path, "Trail Step Size"))
                step = max(step, -(-len(motion.states) // _MAX_TRAIL_STATES))
                for state_index in range(0, len(motion.states), step):
                    appearance = read_appearance(properties, robot, f"{group} {state_index}", self._group_path, color)
                    trail_markers += robot.make_markers(motion.states[state_index], appearance)
        self._display.put(group, state_markers)
        self._display.put(f"{group} trail", trail_markers)

    def _begin(self) -> None:
        self._stop()
        robot = self._display.robot
        if robot is None:
            return
        try:
            self.motion = read_motion(robot, self._message)
        except UnusableStateError as error:
            self.motion = None
            self._display.set_status_row(STATE, "error", foreign(error))
            self._on_state()
            return
        self._display.delete_status_row(STATE)
        self._display.report_unknown_joints(self.motion.unknown_joints)
        self._state_index = 0
        self._wait()
        self._on_state()

    def _wait(self) -> None:
        assert self.motion is not None
        text = self._display.properties.text(*self._group_path, "State Display Time")
        durations = self.motion.durations
        seconds = compute_display_time_s(text, durations[min(self._state_index, len(durations) - 1)])
        self._timer = asyncio.get_running_loop().call_later(max(_MIN_DELAY_S, seconds), self._step)

    def _step(self) -> None:
        self._timer = None
        if self.motion is None:
            return
        if self._display.host.time.paused:
            self._wait()
            return
        if self._state_index + 1 < len(self.motion.states):
            self._state_index += 1
            self._wait()
        elif self._next_message is not None:
            self._message, self._next_message = self._next_message, None
            self._begin()
            return
        elif self._flag(_LOOP_PROPERTY):
            self._state_index = 0
            self._wait()
        self._on_state()

    def _stop(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _flag(self, name: str) -> bool:
        return self._display.properties.flag(*self._group_path, name)


class TrajectoryDisplay(MoveItDisplay):
    """A display that plays the motions published on a topic."""

    CLASS = "moveit_rviz_plugin/Trajectory"
    MESSAGE = "moveit_msgs/msg/DisplayTrajectory"
    TOPIC = (TRAJECTORY_TOPIC,)
    SCHEMA = (DESCRIPTION_SPEC, *path_specs(()))

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._player = MotionPlayer(self, (), self.draw)

    def schema(self) -> Schema:
        """Return the properties, with a check box for each link."""
        return (DESCRIPTION_SPEC, *path_specs(self.link_names))

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Play a motion."""
        self._player.play(message)

    def on_property_changed(self, path: Path) -> None:
        """Apply a changed property, and play the last motion again if looping was just enabled."""
        super().on_property_changed(path)
        self._player.on_property_changed(path)

    def on_robot_changed(self) -> None:
        """Play the motion again with the new robot."""
        self._player.restart()

    def reset(self) -> None:
        """Discard the motion."""
        self._player.clear()
        super().reset()

    def stop(self) -> None:
        """Unsubscribe, and stop playing."""
        self._player.clear()
        super().stop()

    def draw(self) -> None:
        """Draw the robot in the current state, and the trail."""
        self._player.draw("Planned Path")
        self.send_markers()
