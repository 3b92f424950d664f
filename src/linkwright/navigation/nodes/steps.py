"""Managed nodes that execute a goal in steps, mostly goals of other servers.

A generator executes the goal. It is resumed once each cycle, so ``yield`` waits for the next cycle. It returns when the
goal is reached, raises `StepError` when the goal cannot be reached, and is closed when the goal is canceled.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from typing import Any

from linkwright.graph import ActionClient
from linkwright.graph.actions.goal import GoalStatus
from linkwright.navigation.nodes.goals import GoalError, GoalServer
from linkwright.navigation.nodes.managed import ManagedNode

Step = Generator[None, None, Any]
"""A generator that does one step of work in each cycle."""

_CYCLE_PERIOD_S = 0.05
_SERVER_TIMEOUT_S = 5.0
"""The maximum time to wait for a response of another server, in seconds."""


class StepError(GoalError):
    """Raised when a step fails.

    Attributes:
        is_final: whether a retry would not help.
    """

    def __init__(self, code: str, reason: str, *, is_final: bool = False) -> None:
        super().__init__(code, reason)
        self.is_final = is_final


class StepNode(ManagedNode):
    """A managed node that executes one goal at a time, in steps."""

    _work: Step | None = None
    _server: GoalServer | None = None

    def work_on(self, server: GoalServer, work: Step, period: float = _CYCLE_PERIOD_S) -> None:
        """Start executing the goal of a server, and abort an earlier goal of another server.

        Args:
            server: the server of the goal.
            work: executes the goal in steps.
            period: the seconds between two steps.
        """
        self._stop()
        if self._server is not None and self._server is not server:
            self._server.abort("UNKNOWN", "another goal replaced it")
        self._server, self._work = server, work
        self.begin_cycles(period, self._run_cycle)

    def publish_feedback(self, server: GoalServer) -> None:
        """Publish feedback for the active goal.

        This is called once per cycle. By default, do nothing.
        """

    def result(self) -> dict[str, Any]:
        """Return the fields of the result message, by name."""
        return {}

    def deactivate(self) -> None:
        """Stop the execution, and abort the active goal."""
        self._stop()
        if self._server is not None:
            self._server.abort("UNKNOWN", "the server was deactivated", **self.result())

    def cleanup(self) -> None:
        """Stop the execution."""
        self._stop()
        self._server = None

    def run_remote_goal(self, client: ActionClient, goal: Any, summary: str) -> Step:
        """Send a goal to another server, wait for the result, and return it.

        The goal is canceled when this generator is closed. `summary` begins the message of the error.

        Raises:
            StepError: the server is not available, or it did not reach the goal.
        """
        if not client.server_is_ready():
            raise StepError("UNKNOWN", f"{summary}: there is no action {client.action_name}")
        sent_goal = SentGoal(client, goal)
        try:
            while not sent_goal.is_over:
                yield
        finally:
            sent_goal.cancel()
        if sent_goal.has_failed:
            raise StepError("UNKNOWN", sent_goal.reason(summary))
        return sent_goal.result

    def wait_until(self, is_done: Callable[[], bool], server_name: str) -> Step:
        """Wait until a condition holds.

        `server_name` names the server in the error.

        Raises:
            StepError: the condition does not hold in time.
        """
        deadline_ns = self.now_ns() + round(_SERVER_TIMEOUT_S * 1e9)
        while not is_done():
            if self.now_ns() > deadline_ns:
                raise StepError("UNKNOWN", f"{server_name} does not answer")
            yield

    def _run_cycle(self) -> None:
        """Run the next step, or end the goal."""
        server, work = self._server, self._work
        if server is None or work is None:
            self._stop()
            return
        if server.is_canceled:
            self.get_logger().info("Goal canceled")
            self._stop()
            server.end_canceled(**self.result())
            return
        try:
            next(work)
        except StopIteration:
            self.get_logger().info("Goal succeeded")
            self._stop()
            server.succeed(**self.result())
        except StepError as failure:
            self.get_logger().error(f"Goal failed: {failure}")
            self._stop()
            server.abort(failure.code, str(failure), **self.result())
        else:
            self.publish_feedback(server)

    def _stop(self) -> None:
        """Stop the cycles, and close the generator.

        Closing the generator cancels its goals at other servers.
        """
        work, self._work = self._work, None
        if work is not None:
            work.close()
        self.end_cycles()


class SentGoal:
    """A goal sent to another server."""

    def __init__(self, client: ActionClient, goal: Any) -> None:
        self._handle: Any = None
        self._response: Any = None
        self._is_cancel_requested = False
        self.result: Any = None
        client.send_goal_async(goal).add_done_callback(self._on_accepted)

    def _on_accepted(self, future: Any) -> None:
        self._handle = future.result()
        if not self._handle.accepted:
            return
        if self._is_cancel_requested:
            self._handle.cancel_goal_async()
            return
        self._handle.get_result_async().add_done_callback(self._on_result)

    def _on_result(self, future: Any) -> None:
        self._response = future.result()
        self.result = self._response.result

    @property
    def is_over(self) -> bool:
        """Whether the goal was rejected or has ended."""
        return self._response is not None or (self._handle is not None and not self._handle.accepted)

    @property
    def has_succeeded(self) -> bool:
        """Whether the goal succeeded."""
        return self._response is not None and self._response.status == GoalStatus.SUCCEEDED

    @property
    def has_failed(self) -> bool:
        """Whether the goal has ended without success."""
        return self.is_over and not self.has_succeeded

    def reason(self, summary: str) -> str:
        """Return a failure message: `summary` and the server's error message, if there is one."""
        message = getattr(self.result, "error_msg", "")
        return f"{summary}: {message}" if message else summary

    def cancel(self) -> None:
        """Cancel the goal, unless it has ended.

        A goal that is not accepted yet is canceled when it is accepted.
        """
        if not self.is_over:
            self._is_cancel_requested = True
            if self._handle is not None:
                self._handle.cancel_goal_async()
