"""The execution of trajectories by controllers (``TrajectoryExecutionManager``)."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

from linkwright.planning.nodes.conversions import RequestError
from linkwright.planning.nodes.execution import TrajectoryExecution, check_start, read_controllers
from linkwright.planning.nodes.robot_context import RobotContext
from linkwright.standins.rclpy_api.node import Node

_STATUSES = {"PREEMPTED": "PREEMPTED", "CONTROL_FAILED": "ABORTED"}


class ExecutionStatus:
    """The result of an execution, which is true if it succeeded.

    Attributes:
        status: ``SUCCEEDED``, ``ABORTED``, ``PREEMPTED``, ``FAILED`` or ``UNKNOWN``.
    """

    def __init__(self, status: str) -> None:
        self.status = status

    def __bool__(self) -> bool:
        return self.status == "SUCCEEDED"


class TrajectoryExecutionManager:
    """The controllers of the configuration, and the trajectories that they execute.

    Args:
        node: the node that sends the goals.
        robot: the robot with its current state.
        parameters: the parameters of the node by name.
    """

    def __init__(self, node: Node, robot: RobotContext, parameters: Mapping[str, Any]) -> None:
        self._node, self._robot, self._parameters = node, robot, parameters
        controllers, problems = read_controllers(parameters)
        for problem in problems:
            node.get_logger().error(problem)
        self._execution = TrajectoryExecution(node, controllers, parameters)
        self._threads = ThreadPoolExecutor(1, "moveit_py execution")
        self._pushed: list[Any] = []
        self._running: Future[ExecutionStatus] | None = None
        self._last = ExecutionStatus("SUCCEEDED")

    def is_managing_controllers(self) -> bool:
        """Return False: controllers are not loaded or switched."""
        return False

    def push(self, trajectory: Any, controller: str = "", controllers: Any = ()) -> bool:
        """Add a moveit_msgs/msg/RobotTrajectory to those that `execute` executes.

        Args:
            trajectory: the trajectory.
            controller: accepted for compatibility; the joints decide which controllers move.
            controllers: as `controller`.

        Returns:
            Whether the trajectory has a point.
        """
        if not trajectory.joint_trajectory.points:
            return False
        self._pushed.append(trajectory)
        return True

    def clear(self) -> None:
        """Remove the trajectories that were added."""
        self._pushed.clear()

    def execute(self, callback: Callable[[ExecutionStatus], object] | None = None, auto_clear: bool = True) -> None:
        """Start to execute the trajectories that were added, one after the other.

        Args:
            callback: called with the result at the end.
            auto_clear: whether to remove the trajectories.
        """
        trajectories = list(self._pushed)
        if auto_clear:
            self.clear()

        def run() -> ExecutionStatus:
            self._last = asyncio.run(self._execute_all(trajectories))
            if callback is not None:
                callback(self._last)
            return self._last

        self._running = self._threads.submit(run)

    def execute_and_wait(self, auto_clear: bool = True) -> ExecutionStatus:
        """Execute the trajectories that were added, and return the result."""
        self.execute(None, auto_clear)
        return self.wait_for_execution()

    def wait_for_execution(self) -> ExecutionStatus:
        """Wait for the end of the execution, and return the result."""
        return self._last if self._running is None else self._running.result()

    def get_last_execution_status(self) -> ExecutionStatus:
        """Return the result of the last execution."""
        return self._last

    def stop_execution(self, auto_clear: bool = True) -> None:
        """Stop the execution.

        Args:
            auto_clear: whether to remove the trajectories that were added.
        """
        self._execution.stop()
        if auto_clear:
            self.clear()

    def process_event(self, event: str) -> None:
        """Stop the execution if the event is ``stop``."""
        if event == "stop":
            self.stop_execution()

    async def _execute_all(self, trajectories: list[Any]) -> ExecutionStatus:
        try:
            for trajectory in trajectories:
                check_start(trajectory.joint_trajectory, self._robot, self._parameters)
                await self._execution.execute(trajectory, lambda: not self._node.context.ok())
        except RequestError as error:
            self._node.get_logger().error(str(error))
            return ExecutionStatus(_STATUSES.get(error.code, "FAILED"))
        return ExecutionStatus("SUCCEEDED")
