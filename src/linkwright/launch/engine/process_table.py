"""The processes of a launch: which run, how they are started again, and that none is left behind."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Callable
from typing import TYPE_CHECKING

from linkwright.launch.engine.guardian import Guardian
from linkwright.launch.engine.processes import ProcessPlan, RunningProcess

if TYPE_CHECKING:
    from pathlib import Path

    from linkwright.launch.actions.execute import ExecuteLocal
    from linkwright.launch.context import LaunchContext
    from linkwright.launch.engine.session import LaunchSession


_DEFAULT_SECONDS = 5.0
_SHORT_GRACE = (1.0, 0.5)
"""Seconds to SIGTERM and from there to SIGKILL on the user's interrupt: a launch ends within two seconds."""


class ProcessTable:
    """Starts, finds and ends the processes of a launch."""

    def __init__(self, session: LaunchSession) -> None:
        self._session = session
        self._running: set[RunningProcess] = set()
        self._left_behind: list[RunningProcess] = []
        self._ending = asyncio.Event()
        self._interrupted = False
        self._guardian = Guardian()

    @property
    def is_busy(self) -> bool:
        """Whether any process runs."""
        return bool(self._running)

    def start(self, plan: ProcessPlan, name: str, context: LaunchContext) -> None:
        """Start a process and follow it to its end, and begin anew where it respawns."""
        self._session.spawn(self._follow(plan, name, context))

    def stop_matching(self, matcher: Callable[[ExecuteLocal], bool]) -> None:
        """Ask the processes to end whose actions a matcher accepts, in the time that they are given."""
        for process in tuple(self._running):
            plan = process.plan
            if matcher(plan.action):
                self._session.spawn(process.stop(plan.seconds_to_sigterm, plan.seconds_to_sigkill))

    def signal_matching(self, matcher: Callable[[ExecuteLocal], bool], number: signal.Signals) -> None:
        """Send a signal to the processes whose actions a matcher accepts."""
        for process in tuple(self._running):
            if matcher(process.plan.action):
                process.signal(number)

    def stop_all(self, *, at_once: bool) -> None:
        """Ask all processes to end, and start none any more.

        Args:
            at_once: whether somebody waits for the end, so that processes get the time ROS gives them by default only
                if the launch file says so.
        """
        self._ending.set()
        self._interrupted = at_once
        for process in tuple(self._running):
            plan = process.plan
            grace = _short_grace(plan) if at_once else (plan.seconds_to_sigterm, plan.seconds_to_sigkill)
            self._session.spawn(process.stop(*grace))

    def seconds_to_end(self) -> float:
        """How long `stop_all` at once takes at most."""
        return max((sum(_short_grace(process.plan)) for process in tuple(self._running)), default=0.0)

    def kill_all(self) -> None:
        """End all processes at once, and what ended ones left behind; safe to call from a signal handler."""
        for process in (*self._running, *self._left_behind):
            process.signal_group(getattr(signal, "SIGKILL", signal.SIGTERM))

    def owns(self, folder: Path) -> None:
        """Have a folder deleted should the launcher be killed."""
        self._guardian.owns(folder)

    def close(self) -> None:
        """Take note that all processes are gone."""
        self._guardian.close()

    async def _follow(self, plan: ProcessPlan, name: str, context: LaunchContext) -> None:
        starts = 0
        # A process whose action was executed before a later one failed is started all the same and then asked to end,
        # as in ROS: handlers wait for its exit. Not so when the user waits for the end.
        while not self._ending.is_set() or (starts == 0 and not self._interrupted):
            process = RunningProcess(
                plan, name, self._session.log, self._session.emit, context.would_handle_event, self._guardian
            )
            self._running.add(process)
            if self._ending.is_set():
                self._session.spawn(process.stop(*_short_grace(plan)))
            try:
                returncode = await process.run()
            finally:
                self._running.discard(process)
                if process.group_lives():
                    self._left_behind.append(process)
            if returncode is None:
                self._session.fail(process)
                return
            starts += 1
            if not plan.respawn or 0 <= plan.respawn_limit < starts:
                return
            try:
                await asyncio.wait_for(self._ending.wait(), plan.respawn_delay)
            except asyncio.TimeoutError:
                continue


def _short_grace(plan: ProcessPlan) -> tuple[float, float]:
    given = plan.seconds_to_sigterm, plan.seconds_to_sigkill
    to_sigterm, to_sigkill = (
        short if seconds == _DEFAULT_SECONDS else seconds for seconds, short in zip(given, _SHORT_GRACE, strict=True)
    )
    return to_sigterm, to_sigkill
