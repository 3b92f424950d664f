"""Computations of move_group beside the event loop, so that they do not block controllers there."""

from __future__ import annotations

import asyncio
import threading

from linkwright.planning.collision_scene import CollisionScene
from linkwright.planning.effort import counted_effort
from linkwright.planning.nodes.conversions import RequestError
from linkwright.planning.nodes.robot_context import RobotContext
from linkwright.planning.nodes.scene_monitor import SceneMonitor
from linkwright.planning.nodes.scene_state import SceneState
from linkwright.planning.planner import Failure
from linkwright.planning.planner_process import IS_POSSIBLE, MustStop, PlannerProcess, Result, SceneContent, Work
from linkwright.planning.robot_model import RobotModel

_POLL_S = 0.02
"""The time in s between two checks of whether a computation that waits for others is canceled."""


def never() -> bool:
    """Return False, for what cannot be canceled."""
    return False


class PlanningWorker:
    """Runs computations in another thread, one at a time, in the order in which they were requested.

    In a graph in lockstep, computations run at once in the thread of the event loop, count their work instead of real
    time, and take no time of the graph. So the results do not depend on the computer.

    The robot and the scene are those of the worker alone. A scene is compiled only if its content differs from that of
    the scene before.

    Args:
        robot: the robot.
        monitor: the planning scene, which compiles scenes.
        is_lockstep: whether the graph is in lockstep.
        has_process: whether computations run in a process of their own where this is possible. The other thread
            waits for it.
    """

    def __init__(
        self, robot: RobotContext, monitor: SceneMonitor, *, is_lockstep: bool, has_process: bool = False
    ) -> None:
        self._robot, self._monitor, self._is_lockstep = robot, monitor, is_lockstep
        has_process = has_process and IS_POSSIBLE and not is_lockstep
        self._process = PlannerProcess(robot.robot, robot.shapes) if has_process else None
        self._content: tuple[SceneState, SceneContent] | None = None
        if self._process is not None:
            self._process.start()
        self._turns = asyncio.Lock()
        self._is_stopped = threading.Event()
        self._model: RobotModel | None = None
        self._scene: tuple[SceneState, CollisionScene] | None = None
        self._robot_alone: CollisionScene | None = None

    def stop(self) -> None:
        """Cancel the current computation and those that wait."""
        self._is_stopped.set()
        if self._process is not None:
            self._process.close()

    async def run(self, scene: SceneState | None, work: Work[Result], is_canceled: MustStop = never) -> Result:
        """Return what a function computes in the other thread.

        Args:
            scene: the scene, as it is when the function starts; None for the robot without shapes.
            work: the function. Those for a process are pickled, and have a scene.
            is_canceled: returns whether the computation must stop; it is also called in the other thread.

        Raises:
            RequestError: the computation was canceled while it waited for others.
        """

        def must_stop() -> bool:
            return self._is_stopped.is_set() or is_canceled()

        if self._is_lockstep:
            with counted_effort():
                return self._compute(None if scene is None else scene.copy(), work, must_stop)
        if not await self._wait_for_turn(must_stop):
            raise RequestError(Failure.PREEMPTED.name, Failure.PREEMPTED.value)
        content = None if scene is None else scene.copy()
        computation = asyncio.ensure_future(asyncio.to_thread(self._compute, content, work, must_stop))
        # The turn ends with the thread, also if the caller was canceled.
        computation.add_done_callback(lambda _: self._turns.release())
        return await asyncio.shield(computation)

    async def _wait_for_turn(self, must_stop: MustStop) -> bool:
        """Acquire the lock after others, and return whether the computation was not canceled before."""
        turn = asyncio.ensure_future(self._turns.acquire())
        try:
            while not turn.done() and not must_stop():
                await asyncio.wait({turn}, timeout=_POLL_S)
        except asyncio.CancelledError:
            if not turn.cancel():
                self._turns.release()
            raise
        return not turn.cancel()

    def _compute(self, scene: SceneState | None, work: Work[Result], must_stop: MustStop) -> Result:
        if self._process is not None:
            assert scene is not None, "only planning has a process"
            if self._content is None or not scene.collides_like(self._content[0]):
                self._content = scene, SceneContent(scene.scene_objects(), scene.allowed, scene.margins)
            return self._process.run(self._content[1], work, must_stop)
        if self._model is None:
            self._model = RobotModel(self._robot.robot)
        return work(self._model, self._compile(scene), must_stop)

    def _compile(self, scene: SceneState | None) -> CollisionScene:
        if scene is None:
            if self._robot_alone is None:
                self._robot_alone = self._monitor.compile(None)
            return self._robot_alone
        if self._scene is None or not scene.collides_like(self._scene[0]):
            self._scene = scene, self._monitor.compile(scene)
        return self._scene[1]
