"""A process that computes plans, so that callbacks of this process do not wait for them.

The planners of OMPL hold Python's lock while they search. In a thread, they would stop the callbacks of nodes and
controllers of the same process for tens of milliseconds.
"""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any, NamedTuple, TypeVar

from linkwright.planning.collision_scene import AllowedCollisions, CollisionScene, LinkMargin, SceneObject
from linkwright.planning.planner import Failure, PlanError
from linkwright.planning.robot_model import RobotModel, Shapes
from linkwright.urdf import Robot

Result = TypeVar("Result")
MustStop = Callable[[], bool]
Work = Callable[[RobotModel, CollisionScene, MustStop], Result]
"""A computation with a robot and a scene, which it may move; the function tells it to stop."""

IS_POSSIBLE = os.name == "posix"
"""Whether a program can inherit a socket, which it cannot on Windows."""

_PROGRAM = "linkwright.planning.planner_program"
_POLL_S = 0.02
"""The time in s between two checks of whether a computation is canceled."""


@dataclass(frozen=True, slots=True, eq=False)
class SceneContent:
    """The objects among which a robot moves, the pairs that may collide, and the margins of links by name."""

    objects: Sequence[SceneObject]
    allowed: AllowedCollisions
    margins: Mapping[str, LinkMargin]


class Request(NamedTuple):
    """A computation for the process.

    Attributes:
        number: the number of the computation.
        robot: the robot and the collision shapes of its links, in the first request.
        scene: the objects around the robot, if they differ from those of the request before.
        work: the computation.
    """

    number: int
    robot: tuple[Robot, Shapes] | None
    scene: SceneContent | None
    work: Work[Any]


class Cancellation(NamedTuple):
    """The number of the computation that must stop."""

    number: int


@dataclass(frozen=True, slots=True)
class Outcome:
    """The result of a computation, or its error."""

    result: Any = None
    error: Exception | None = None


class PlannerProcess:
    """A process with a planner, for one computation at a time.

    It ends with `close`, and also when this process ends for any reason.

    Args:
        robot: the robot.
        shapes: the collision shapes of its links.
    """

    def __init__(self, robot: Robot, shapes: Shapes) -> None:
        self._robot = robot, shapes
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._connection: Connection | None = None
        self._scene: SceneContent | None = None  # the scene that the process has
        self._number = 0
        self._is_closed = False

    def start(self) -> None:
        """Start the process early, so that it has imported its libraries when it is needed."""
        with self._lock, suppress(OSError):  # The first computation reports the error.
            self._ensure_running()

    def run(self, scene: SceneContent, work: Work[Result], must_stop: MustStop) -> Result:
        """Return what the process computes, in a thread that can wait.

        Args:
            scene: the objects around the robot; the process compiles them unless they are those of the call before.
            work: the computation, which is pickled: a function of a module, or a `functools.partial` of one.
            must_stop: returns whether the computation must stop.

        Raises:
            PlanError: the computation raised it, or the process has ended.
        """
        with self._lock:
            try:
                outcome = self._exchange(self._ensure_running(), scene, work, must_stop)
            except (EOFError, OSError):
                status = self._end()
                if self._is_closed:
                    raise PlanError(Failure.PREEMPTED) from None
                raise PlanError(Failure.FAILURE, reason=_describe_end(status)) from None
        if outcome.error is not None:
            raise outcome.error
        result: Result = outcome.result
        return result

    def close(self) -> None:
        """End the process, even during a computation."""
        self._is_closed = True
        process = self._process
        if process is not None:
            process.kill()
        with self._lock:
            self._end()

    def _exchange(self, connection: Connection, scene: SceneContent, work: Work[Any], must_stop: MustStop) -> Outcome:
        self._number += 1
        robot = self._robot if self._scene is None else None
        connection.send(Request(self._number, robot, None if scene is self._scene else scene, work))
        self._scene = scene
        is_canceled = False
        while not connection.poll(_POLL_S):
            if not is_canceled and must_stop():
                connection.send(Cancellation(self._number))
                is_canceled = True
        outcome: Outcome = connection.recv()
        return outcome

    def _ensure_running(self) -> Connection:
        if self._is_closed:
            raise PlanError(Failure.PREEMPTED)
        if self._connection is None:
            own, other = socket.socketpair()
            with other:
                self._process = subprocess.Popen(  # noqa: S603 - Linkwright's own program
                    [sys.executable, "-m", _PROGRAM, str(other.fileno())],
                    stdin=subprocess.DEVNULL,
                    pass_fds=[other.fileno()],
                    env={**os.environ, "PYTHONSAFEPATH": "1"},  # A file queue.py in the folder must not be imported.
                )
            self._connection, self._scene = Connection(own.detach()), None
        return self._connection

    def _end(self) -> int | None:
        """End the process, and return its exit status, or None if it was not started."""
        if self._process is None or self._connection is None:
            return None
        self._connection.close()
        self._connection = self._scene = None
        self._process.kill()  # It has ended, or has no unsaved data.
        return self._process.wait()


def _describe_end(status: int | None) -> str:
    if status is None:
        return "the process of the planner cannot be started"
    return f"the process of the planner has ended with status {status}; the next request starts another one"
