"""The process table of a launch.

The table starts, respawns and ends processes, and makes sure that no process outlives the launch.
"""

from __future__ import annotations

import asyncio
import signal
from typing import TYPE_CHECKING

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.engine.guardian import Guardian
from linkwright.launch.engine.processes import RunningProcess
from linkwright.launch.model.events import ProcessMatcher
from linkwright.launch.model.plans import ProcessPlan

if TYPE_CHECKING:
    from pathlib import Path

    from linkwright.launch.engine.supervisor import Supervisor


class ProcessTable:
    """Starts, finds and ends the processes of a launch."""

    def __init__(self, session: Supervisor) -> None:
        self._session = session
        self._running: set[RunningProcess] = set()
        self._remaining_groups: list[RunningProcess] = []
        self._unfinished: dict[str, ProcessPlan] = {}
        self._ending = asyncio.Event()
        self._is_interrupted = False
        self._guardian = Guardian()

    @property
    def is_busy(self) -> bool:
        """Whether any process is running."""
        return bool(self._running)

    def start(self, plan: ProcessPlan, name: str) -> None:
        """Start a process, monitor it until it ends, and respawn it if the plan requests a respawn."""
        self._unfinished[name] = plan
        self._session.spawn(self._run_process(plan, name))

    def is_named(self, path: str) -> bool:
        """Return whether a path is an argument of a process that has not ended, or not even started."""
        return any(path in plan.command for plan in self._unfinished.values())

    def stop_matching(self, matcher: ProcessMatcher) -> None:
        """Ask the processes with a matching action to end.

        The plan of each process contains the delays before SIGTERM and SIGKILL.
        """
        for process in tuple(self._running):
            if matcher(process.plan.action):
                self._session.spawn(process.stop())

    def signal_matching(self, matcher: ProcessMatcher, signal_number: signal.Signals) -> None:
        """Send a signal to the processes with a matching action."""
        for process in tuple(self._running):
            if matcher(process.plan.action):
                process.signal(signal_number)

    def stop_all(self, *, interrupted: bool) -> None:
        """Ask all processes to end, and do not respawn them.

        Args:
            interrupted: whether the user interrupted the launch. If True, processes that wait for their start do not
                start.
        """
        self._ending.set()
        self._is_interrupted = interrupted
        for process in tuple(self._running):
            self._session.spawn(process.stop())

    def escalate(self) -> None:
        """Send SIGTERM now to the processes that must end, and SIGKILL half a second later."""
        for process in tuple(self._running):
            process.escalate()

    @property
    def names(self) -> list[str]:
        """The names of the running processes in the log, sorted."""
        return sorted(process.name for process in self._running)

    def seconds_to_end(self) -> float:
        """Return the maximum time in seconds until the running processes end after `stop_all`."""
        plans = [process.plan for process in tuple(self._running)]
        return max((plan.seconds_to_sigterm + plan.seconds_to_sigkill for plan in plans), default=0.0)

    def kill_all(self) -> None:
        """Kill all running processes, and the remaining children of ended processes.

        A signal handler may call this method.
        """
        for process in (*self._running, *self._remaining_groups):
            process.signal_group(getattr(signal, "SIGKILL", signal.SIGTERM))

    def register_folder(self, folder: Path) -> None:
        """Register a folder, to be deleted if the launcher is killed."""
        self._guardian.register_folder(folder)

    def close(self) -> None:
        """Close the guardian after all processes have ended."""
        self._guardian.close()

    async def _run_process(self, plan: ProcessPlan, name: str) -> None:
        try:
            await self._run_with_respawns(plan, name)
        finally:
            del self._unfinished[name]

    async def _run_with_respawns(self, plan: ProcessPlan, name: str) -> None:
        start_count = 0
        # As in ROS, if an action starts a process and a later action fails, the process still starts and is then asked
        # to end, because handlers wait for its exit. After an interrupt, it does not start.
        while not self._ending.is_set() or (start_count == 0 and not self._is_interrupted):
            process = RunningProcess(
                plan, name, self._session.log, self._session.emit, self._session.would_handle, self._guardian
            )
            self._running.add(process)
            if self._ending.is_set():
                self._session.spawn(process.stop())
            try:
                await process.run()
            except LinkwrightError as error:
                self._session.report_start_failure(process, error)
                return
            finally:
                self._running.discard(process)
                if process.is_group_alive():
                    self._remaining_groups.append(process)
            start_count += 1
            if not plan.respawn or 0 <= plan.respawn_limit < start_count:
                return
            try:
                await asyncio.wait_for(self._ending.wait(), plan.respawn_delay)
            except asyncio.TimeoutError:
                continue
