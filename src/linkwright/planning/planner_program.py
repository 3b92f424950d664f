"""The program that computes plans for another process, see `linkwright.planning.planner_process`."""

from __future__ import annotations

import os
import signal
import sys
import threading
import traceback
from contextlib import suppress
from multiprocessing.connection import Connection
from queue import SimpleQueue

from linkwright.diagnostics import LinkwrightError
from linkwright.planning.collision_scene import CollisionScene
from linkwright.planning.library import load_ompl
from linkwright.planning.planner import PlanError
from linkwright.planning.planner_process import Cancellation, Outcome, Request
from linkwright.planning.robot_model import RobotModel, Shapes
from linkwright.urdf import Robot


class _Computer:
    """The robot and its scene, for the computations of requests."""

    def __init__(self) -> None:
        self._robot: Robot | None = None
        self._shapes: Shapes = {}
        self._model: RobotModel | None = None
        self._scene: CollisionScene | None = None
        self.canceled_number = 0

    def compute(self, request: Request) -> Outcome:
        """Return the outcome of a request."""
        try:
            model, scene = self._prepare(request)
            return Outcome(request.work(model, scene, lambda: self.canceled_number == request.number))
        except (PlanError, LinkwrightError) as error:
            return Outcome(error=error)
        except Exception:  # noqa: BLE001 - a defect, which the other process reports
            return Outcome(error=RuntimeError(traceback.format_exc()))

    def _prepare(self, request: Request) -> tuple[RobotModel, CollisionScene]:
        """Return the robot and the scene of a request, which are compiled if the request has them."""
        if request.robot is not None:
            self._robot, self._shapes = request.robot
            self._model = RobotModel(self._robot)
        assert self._robot is not None
        assert self._model is not None, "the first request has a robot"
        if request.scene is not None:
            content = request.scene
            self._scene = CollisionScene(self._robot, self._shapes, content.objects, content.allowed, content.margins)
        assert self._scene is not None, "the first request has a scene"
        return self._model, self._scene


def main() -> None:
    """Compute what the requests ask for, until the other process closes the connection."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # The other process decides when this one ends.
    connection = Connection(int(sys.argv[1]))
    requests: SimpleQueue[Request] = SimpleQueue()
    computer = _Computer()
    threading.Thread(target=_receive, args=(connection, requests, computer), daemon=True).start()
    with suppress(LinkwrightError):  # Requests that need OMPL report that it is missing.
        load_ompl()
    while True:
        connection.send(computer.compute(requests.get()))


def _receive(connection: Connection, requests: SimpleQueue[Request], computer: _Computer) -> None:
    """Receive requests and cancellations, and end this process with the other one."""
    status = 1  # of a request that cannot be read
    try:
        while True:
            message = connection.recv()
            if isinstance(message, Cancellation):
                computer.canceled_number = message.number
            else:
                requests.put(message)
    except (EOFError, OSError):
        status = 0
    finally:
        os._exit(status)


if __name__ == "__main__":
    main()
