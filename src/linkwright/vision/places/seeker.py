"""The decisions of a robot that searches for an object, drives to it, and follows it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from math import inf, pi

from linkwright.vision.places.object_requests import Answer

_MAX_AGE_S = 0.5
"""The maximum age of a detection of an object that counts as visible now, seconds."""
_SEARCH_ANGLE_RAD = 2 * pi + 0.3
"""The angle in rad through which the robot turns to search: a full turn and 0.3 rad of overlap."""
_MAX_DRIVING_BEARING_RAD = 0.6
"""The bearing in rad beyond which the robot turns to the object before it drives."""
_TURN_GAIN, _SPEED_GAIN = 1.8, 0.8
"""The angular speed per bearing, and the speed per remaining distance, in 1/s."""
_MIN_SPEED_MPS = 0.06
"""The minimum speed while the robot approaches the object."""
_DISTANCE_TOLERANCE_M, _BEARING_TOLERANCE_RAD = 0.03, 0.15
_OBJECT_MARGIN_M = 0.2
"""The distance in m in front of the object's surface within which an obstacle counts as the object."""


class Phase(Enum):
    """The phases of seeking."""

    IDLE = "idle"
    SEARCHING = "looking"
    APPROACHING = "going"


@dataclass(frozen=True, slots=True)
class SeekSettings:
    """The settings of a seeker.

    Attributes:
        distance: the final distance from the robot's center to the object's nearest side, meters.
        speed: the maximum speed, m/s.
        turn_speed: the maximum angular speed, rad/s; half of it is used to look around.
        lost_timeout: the time without seeing the object after which the robot stops, seconds.
        obstacle_distance: the minimum distance from the robot's center to obstacles ahead, meters.
        blocked_timeout: how long the robot waits for a clear path, seconds.
    """

    distance: float = 0.5
    speed: float = 0.3
    turn_speed: float = 1.0
    lost_timeout: float = 3.0
    obstacle_distance: float = 0.35
    blocked_timeout: float = 5.0


@dataclass(frozen=True, slots=True)
class Observation:
    """The observations of the robot at a step of seeking.

    Attributes:
        time: the time of the step, seconds.
        heading: the robot's heading in a fixed frame, rad.
        bearing: the angle from the robot's heading to the object, rad, positive to the left; valid if it was ever seen.
        surface_distance: the distance from the robot's center to the object's nearest side, meters; infinite if it was
            never seen.
        age: seconds since the object was last seen; infinite if it was never seen.
        time_since_detections: seconds since the last message of a detector.
        free_distance: the distance from the robot's center to the nearest obstacle ahead, meters.
    """

    time: float
    heading: float
    bearing: float = 0.0
    surface_distance: float = inf
    age: float = inf
    time_since_detections: float = 0.0
    free_distance: float = inf


@dataclass(frozen=True, slots=True)
class Command:
    """A linear velocity in m/s, an angular velocity in rad/s, and an event to report or None."""

    linear: float = 0.0
    angular: float = 0.0
    event: Answer | None = None


class Seeker:
    """A robot's search for an object.

    The search ends when the robot arrives, unless the robot follows the object. It also ends if the object is lost, the
    path is blocked, or detections stop arriving.

    Args:
        settings: the settings; None for the defaults.

    Attributes:
        phase: the current phase.
        follows_object: whether to follow the object after reaching it.
    """

    def __init__(self, settings: SeekSettings | None = None) -> None:
        self.settings = settings or SeekSettings()
        self.phase = Phase.IDLE
        self.follows_object = False
        self._heading: float | None = None
        self._blocked_since: float | None = None
        self._turned_angle = self._turn_direction = 0.0
        self._was_found = False

    def stop(self) -> None:
        """Stop seeking, without an event."""
        self.phase = Phase.IDLE
        self.follows_object = False
        self._reset()

    def begin(self, *, follow: bool = False) -> None:
        """Begin to seek a new object.

        Args:
            follow: whether to follow the object after reaching it.
        """
        self.stop()
        self.phase, self.follows_object = Phase.SEARCHING, follow

    def step(self, observation: Observation) -> Command:
        """Return the next velocity and event.

        Unless the seeker is idle, the method must be called several times per second.
        """
        if self.phase is Phase.IDLE:
            return Command()
        if observation.time_since_detections > self.settings.lost_timeout:
            return self._finish(Answer.NO_DETECTIONS)
        if self.phase is Phase.SEARCHING:
            return self._turn_and_look(observation)
        if observation.age > self.settings.lost_timeout:
            self.phase = Phase.SEARCHING
            self._reset()
            self._was_found = True
            return self._turn_and_look(observation)
        return self._approach(observation)

    def _turn_and_look(self, observation: Observation) -> Command:
        if observation.age < _MAX_AGE_S:
            is_first = not self._was_found
            self.phase = Phase.APPROACHING
            command = self._approach(observation)
            return Command(command.linear, command.angular, command.event or Answer.FOUND) if is_first else command
        if self._heading is not None:
            self._turned_angle += abs((observation.heading - self._heading + pi) % (2 * pi) - pi)
        self._heading = observation.heading
        if self._turned_angle > _SEARCH_ANGLE_RAD:
            return self._finish(Answer.LOST if self._was_found else Answer.NOT_FOUND)
        direction = -1.0 if observation.age < inf and observation.bearing < 0 else 1.0
        self._turn_direction = self._turn_direction or direction
        return Command(0.0, self._turn_direction * self.settings.turn_speed / 2)

    def _approach(self, observation: Observation) -> Command:
        settings = self.settings
        angular = max(-settings.turn_speed, min(settings.turn_speed, _TURN_GAIN * observation.bearing))
        remaining = observation.surface_distance - settings.distance
        if remaining <= _DISTANCE_TOLERANCE_M:
            if abs(observation.bearing) > _BEARING_TOLERANCE_RAD:
                return Command(0.0, angular)
            return Command(0.0, angular) if self.follows_object else self._finish(Answer.ARRIVED)
        if abs(observation.bearing) > _MAX_DRIVING_BEARING_RAD:
            return Command(0.0, angular)
        speed = max(_MIN_SPEED_MPS, min(settings.speed, _SPEED_GAIN * remaining)) * (
            1.0 - abs(observation.bearing) / _MAX_DRIVING_BEARING_RAD / 2
        )
        if observation.free_distance < observation.surface_distance - _OBJECT_MARGIN_M:
            free_distance = observation.free_distance - settings.obstacle_distance
            if free_distance <= 0:
                self._blocked_since = observation.time if self._blocked_since is None else self._blocked_since
                waiting_time = observation.time - self._blocked_since
                return (
                    self._finish(Answer.BLOCKED) if waiting_time > settings.blocked_timeout else Command(0.0, angular)
                )
            speed = min(speed, _SPEED_GAIN * free_distance)
        self._blocked_since = None
        return Command(speed, angular)

    def _finish(self, event: Answer) -> Command:
        self.stop()
        return Command(event=event)

    def _reset(self) -> None:
        self._heading = self._blocked_since = None
        self._turned_angle = self._turn_direction = 0.0
        self._was_found = False
