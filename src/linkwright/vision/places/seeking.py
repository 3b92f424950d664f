"""The decisions of a robot that searches for an object, drives to it, and follows it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from math import inf, pi

from linkwright.vision.places.words import Answer

_FRESH_SECONDS = 0.5
"""An object that was seen within these is seen now."""
_ROUND = 2 * pi + 0.3
_TURN_FIRST = 0.6
"""An object that is further to the side, rad, is turned to before the robot drives."""
_TURN_GAIN, _SPEED_GAIN = 1.8, 0.8
_SLOWEST = 0.06
_NEAR_ENOUGH, _FACING = 0.03, 0.15
_BEHIND_OBSTACLE = 0.2
"""An obstacle that is nearer than the object by less than this is the object."""


class Phase(Enum):
    """The phases of seeking."""

    IDLE = "idle"
    LOOKING = "looking"
    GOING = "going"


@dataclass(frozen=True, slots=True)
class SeekSettings:
    """Settings of seeking.

    Attributes:
        distance: the final distance from the robot's centre to the object's nearest side, metres.
        speed: the maximum speed, m/s.
        turn_speed: the maximum angular speed, rad/s; half of it is used to look around.
        lost_time: the time without seeing the object after which the robot stops, seconds.
        obstacle_distance: the minimum distance from the robot's centre to obstacles ahead, metres.
        blocked_time: how long the robot waits for a clear path, seconds.
    """

    distance: float = 0.5
    speed: float = 0.3
    turn_speed: float = 1.0
    lost_time: float = 3.0
    obstacle_distance: float = 0.35
    blocked_time: float = 5.0


@dataclass(frozen=True, slots=True)
class View:
    """The robot's knowledge at a step.

    Attributes:
        time: seconds.
        heading: the robot's heading, rad, in a frame that does not turn with it.
        bearing: the bearing of the object, rad to the left; valid if the object was ever seen.
        surface: the distance from the robot's centre to the object's nearest side, metres; infinite if it was never
            seen.
        seen_ago: seconds since the object was seen; infinite if it was never seen.
        silence: the seconds since the last message of a detector.
        free: the distance from the robot's centre to the nearest obstacle in its way, metres.
    """

    time: float
    heading: float
    bearing: float = 0.0
    surface: float = inf
    seen_ago: float = inf
    silence: float = 0.0
    free: float = inf


@dataclass(frozen=True, slots=True)
class Move:
    """A velocity in m/s and rad/s, and an event."""

    linear: float = 0.0
    angular: float = 0.0
    event: Answer | None = None


class Seeker:
    """Seeks an object. It stops when the object is lost, when detections stop arriving, or when the path is blocked.

    Args:
        settings: the settings.

    Attributes:
        phase: the current phase.
        follow: whether to keep following the object after reaching it.
    """

    def __init__(self, settings: SeekSettings | None = None) -> None:
        self.settings = settings or SeekSettings()
        self.phase = Phase.IDLE
        self.follow = False
        self._heading: float | None = None
        self._blocked_at: float | None = None
        self._turned = self._side = 0.0
        self._was_found = False

    def stop(self) -> None:
        """Stop seeking."""
        self.phase = Phase.IDLE
        self.follow = False
        self._forget()

    def begin(self, *, follow: bool = False) -> None:
        """Begin to seek a new object."""
        self.stop()
        self.phase, self.follow = Phase.LOOKING, follow

    def step(self, view: View) -> Move:
        """Return the next move; call it several times per second unless the seeker is idle."""
        if self.phase is Phase.IDLE:
            return Move()
        if view.silence > self.settings.lost_time:
            return self._end(Answer.BLIND)
        if self.phase is Phase.LOOKING:
            return self._look(view)
        if view.seen_ago > self.settings.lost_time:
            self.phase = Phase.LOOKING
            self._forget()
            self._was_found = True
            return self._look(view)
        return self._go(view)

    def _look(self, view: View) -> Move:
        if view.seen_ago < _FRESH_SECONDS:
            first = not self._was_found
            self.phase = Phase.GOING
            move = self._go(view)
            return Move(move.linear, move.angular, move.event or Answer.FOUND) if first else move
        if self._heading is not None:
            self._turned += abs((view.heading - self._heading + pi) % (2 * pi) - pi)
        self._heading = view.heading
        if self._turned > _ROUND:
            return self._end(Answer.LOST if self._was_found else Answer.NOT_FOUND)
        side = -1.0 if view.seen_ago < inf and view.bearing < 0 else 1.0
        self._side = self._side or side
        return Move(0.0, self._side * self.settings.turn_speed / 2)

    def _go(self, view: View) -> Move:
        settings = self.settings
        angular = max(-settings.turn_speed, min(settings.turn_speed, _TURN_GAIN * view.bearing))
        left = view.surface - settings.distance
        if left <= _NEAR_ENOUGH:
            if abs(view.bearing) > _FACING:
                return Move(0.0, angular)
            return Move(0.0, angular) if self.follow else self._end(Answer.ARRIVED)
        if abs(view.bearing) > _TURN_FIRST:
            return Move(0.0, angular)
        speed = max(_SLOWEST, min(settings.speed, _SPEED_GAIN * left)) * (1.0 - abs(view.bearing) / _TURN_FIRST / 2)
        if view.free < view.surface - _BEHIND_OBSTACLE:
            room = view.free - settings.obstacle_distance
            if room <= 0:
                self._blocked_at = view.time if self._blocked_at is None else self._blocked_at
                waited = view.time - self._blocked_at
                return self._end(Answer.BLOCKED) if waited > settings.blocked_time else Move(0.0, angular)
            speed = min(speed, _SPEED_GAIN * room)
        self._blocked_at = None
        return Move(speed, angular)

    def _end(self, event: Answer) -> Move:
        self.stop()
        return Move(event=event)

    def _forget(self) -> None:
        self._heading = self._blocked_at = None
        self._turned = self._side = 0.0
        self._was_found = False
