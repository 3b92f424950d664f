"""The processes of a launch: which run, how they are started again, and that none is left behind."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Callable
from typing import TYPE_CHECKING

from linkwright.launch.engine.processes import ProcessPlan, RunningProcess

if TYPE_CHECKING:
    from linkwright.launch.actions.execute import ExecuteProcess
    from linkwright.launch.context import LaunchContext
    from linkwright.launch.engine.session import LaunchSession


class ProcessTable:
    """Starts, finds and ends the processes of a launch."""

    def __init__(self, session: LaunchSession) -> None:
        self._session = session
        self._running: set[RunningProcess] = set()
        self._left_behind: list[RunningProcess] = []
        self._ending = asyncio.Event()

    @property
    def is_busy(self) -> bool:
        """Whether any process runs."""
        return bool(self._running)

    def start(self, plan: ProcessPlan, name: str, context: LaunchContext) -> None:
        """Start a process and follow it to its end, and begin anew where it respawns."""
        self._session.spawn(self._follow(plan, name, context))

    def stop_matching(self, matcher: Callable[[ExecuteProcess], bool]) -> None:
        """Ask the processes to end whose actions a matcher accepts, in the time that they are given."""
        for process in tuple(self._running):
            plan = process.plan
            if matcher(plan.action):
                self._session.spawn(process.stop(plan.seconds_to_sigterm, plan.seconds_to_sigkill))

    def signal_matching(self, matcher: Callable[[ExecuteProcess], bool], number: signal.Signals) -> None:
        """Send a signal to the processes whose actions a matcher accepts."""
        for process in tuple(self._running):
            if matcher(process.plan.action):
                process.signal(number)

    def stop_all(self, grace: tuple[float, float] | None) -> None:
        """Ask all processes to end, and start none any more.

        Args:
            grace: seconds to SIGTERM and from there to SIGKILL; None for those of each process.
        """
        self._ending.set()
        for process in tuple(self._running):
            plan = process.plan
            self._session.spawn(process.stop(*(grace or (plan.seconds_to_sigterm, plan.seconds_to_sigkill))))

    def kill_all(self) -> None:
        """End all processes at once, and what ended ones left behind; safe to call from a signal handler."""
        for process in (*self._running, *self._left_behind):
            process.signal_group(getattr(signal, "SIGKILL", signal.SIGTERM))

    async def _follow(self, plan: ProcessPlan, name: str, context: LaunchContext) -> None:
        starts = 0
        while not self._ending.is_set():
            process = RunningProcess(plan, name, self._session.log, self._session.emit, context.would_handle_event)
            self._running.add(process)
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
