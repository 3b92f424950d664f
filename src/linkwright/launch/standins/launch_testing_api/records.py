"""Records of the output and exits of processes in a launch, for tests.

These are the handlers of ``launch_testing``. The active handlers are for tests that run during the launch, and can wait
for records. Each active handler contains a plain handler for tests that run after the launch.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from linkwright.launch.model import events
from linkwright.launch.model.actions.execute import ExecuteLocal
from linkwright.launch.standins.launch_testing_api.asserts import assertInStream
from linkwright.launch.standins.launch_testing_api.processes import (
    NoMatchingProcessException,
    get_name,
    resolveProcesses,
)


class IoHandler:
    """The output of processes in the order of writing."""

    def __init__(self) -> None:
        self._all: list[events.ProcessIO] = []
        self._by_name: dict[str, list[events.ProcessIO]] = {}

    def track(self, process_name: str) -> None:
        """Register a process, even if it writes no output."""
        self._by_name.setdefault(process_name, [])

    def append(self, process_io: events.ProcessIO) -> None:
        """Record output of a process."""
        self._all.append(process_io)
        self._by_name.setdefault(process_io.process_name, []).append(process_io)

    def __iter__(self) -> Iterator[events.ProcessIO]:
        return iter(self._all)

    def processes(self) -> list[Any]:
        """Return the actions of the processes with output."""
        return [output_events[0].action for output_events in self._by_name.values() if output_events]

    def process_names(self) -> list[str]:
        """Return the names of all registered processes, with or without output."""
        return list(self._by_name)

    def __getitem__(self, key: str | ExecuteLocal) -> list[events.ProcessIO]:
        """Return the output events of a process, given its name or action.

        Raises:
            KeyError: the process is unknown.
        """
        return list(self._by_name[key if isinstance(key, str) else get_name(key)])


class ProcInfoHandler:
    """The last event of each process: its start or its exit."""

    def __init__(self) -> None:
        self._by_action: dict[Any, events.RunningProcessEvent] = {}

    def append(self, process_info: events.RunningProcessEvent) -> None:
        """Record the start or the exit of a process."""
        self._by_action[process_info.action] = process_info

    def __iter__(self) -> Iterator[events.RunningProcessEvent]:
        return iter(list(self._by_action.values()))

    def processes(self) -> list[Any]:
        """Return the actions of all processes."""
        return list(self._by_action)

    def process_names(self) -> list[str]:
        """Return the names of all processes."""
        return [get_name(action) for action in self._by_action]

    def __getitem__(self, key: str | ExecuteLocal) -> Any:
        """Return the last event of a process, given a part of its name or its action.

        Raises:
            KeyError: the process is unknown.
        """
        if not isinstance(key, str):
            return self._by_action[key]
        for action, event in self._by_action.items():
            if key in get_name(action):
                return event
        raise KeyError(key)


class ActiveIoHandler:
    """The output of processes so far, with methods that wait for output.

    Attributes:
        io_event: the condition that is notified when a process writes output.
    """

    def __init__(self) -> None:
        self.io_event = threading.Condition()
        self._io_handler = IoHandler()

    def track(self, process_name: str) -> None:
        """Register a process, even if it writes no output."""
        with self.io_event:
            self._io_handler.track(process_name)
            self.io_event.notify_all()

    def append(self, process_io: events.ProcessIO) -> None:
        """Record output of a process."""
        with self.io_event:
            self._io_handler.append(process_io)
            self.io_event.notify_all()

    def __iter__(self) -> Iterator[events.ProcessIO]:
        with self.io_event:
            return iter(list(self._io_handler))

    def processes(self) -> list[Any]:
        """Return the actions of the processes with output."""
        with self.io_event:
            return self._io_handler.processes()

    def process_names(self) -> list[str]:
        """Return the names of all registered processes, with or without output."""
        with self.io_event:
            return self._io_handler.process_names()

    def __getitem__(self, key: str | ExecuteLocal) -> list[events.ProcessIO]:
        """Return the output events of a process, given its name or action.

        Raises:
            KeyError: the process is unknown.
        """
        with self.io_event:
            return self._io_handler[key]

    def assertWaitFor(self, *args: Any, **kwargs: Any) -> None:
        """Raise AssertionError unless a text arrives in the output in time. See `waitFor`."""
        if not self.waitFor(*args, **kwargs):
            raise AssertionError("Waiting for output timed out")

    def waitFor(
        self,
        expected_output: Any,
        process: ExecuteLocal | str | None = None,
        cmd_args: str | Sequence[str] | None = None,
        *,
        strict_proc_matching: bool = True,
        output_filter: Callable[[str], str] | None = None,
        timeout: float | None = 10,
        strip_ansi_escape_sequences: bool = True,
        stream: str = "stderr",
    ) -> bool:
        """Wait for a text in the output, and return whether it arrived in time.

        Args:
            expected_output: a text, a regular expression, or several of them in order.
            process: an action, or a part of the name of a process; None for all processes.
            cmd_args: arguments of the process, see `resolveProcesses`.
            strict_proc_matching: whether a name must match only one process.
            output_filter: a function that filters the output before the search.
            timeout: the timeout in seconds; None to wait without limit.
            strip_ansi_escape_sequences: whether to remove ANSI escape sequences before the search.
            stream: ``stdout`` or ``stderr``.

        Raises:
            Exception: no process with this name has output.
        """

        def contains_expected() -> bool:
            try:
                assertInStream(
                    self._io_handler,  # this thread already holds the lock
                    expected_output,
                    process,
                    cmd_args,
                    output_filter=output_filter,
                    strict_proc_matching=strict_proc_matching,
                    strip_ansi_escape_sequences=strip_ansi_escape_sequences,
                    stream=stream,
                )
            except (NoMatchingProcessException, AssertionError):
                return False
            return True

        with self.io_event:
            has_arrived = self.io_event.wait_for(contains_expected, timeout=timeout)
            if not has_arrived:
                resolveProcesses(self._io_handler, process=process, cmd_args=cmd_args, strict_proc_matching=False)
        return has_arrived


class ActiveProcInfoHandler:
    """The starts and exits of processes so far, with methods that wait for a start or an exit.

    Attributes:
        proc_event: the condition that is notified when a process has started or ended.
    """

    def __init__(self) -> None:
        self.proc_event = threading.Condition()
        self._proc_info_handler = ProcInfoHandler()

    def append(self, process_info: events.RunningProcessEvent) -> None:
        """Record the start or the exit of a process."""
        with self.proc_event:
            self._proc_info_handler.append(process_info)
            self.proc_event.notify_all()

    def __iter__(self) -> Iterator[events.RunningProcessEvent]:
        with self.proc_event:
            return iter(self._proc_info_handler)

    def processes(self) -> list[Any]:
        """Return the actions of all processes."""
        with self.proc_event:
            return self._proc_info_handler.processes()

    def process_names(self) -> list[str]:
        """Return the names of all processes."""
        with self.proc_event:
            return self._proc_info_handler.process_names()

    def __getitem__(self, key: str | ExecuteLocal) -> Any:
        """Return the last event of a process, given a part of its name or its action.

        Raises:
            KeyError: the process is unknown.
        """
        with self.proc_event:
            return self._proc_info_handler[key]

    def assertWaitForStartup(
        self,
        process: ExecuteLocal | str,
        cmd_args: str | Sequence[str] | None = None,
        *,
        timeout: float | None = 10,
    ) -> None:
        """Wait until a process has started, and raise AssertionError on a timeout."""
        self._wait(process, cmd_args, events.RunningProcessEvent, "start", timeout)

    def assertWaitForShutdown(
        self,
        process: ExecuteLocal | str,
        cmd_args: str | Sequence[str] | None = None,
        *,
        timeout: float | None = 10,
    ) -> None:
        """Wait until a process has ended, and raise AssertionError on a timeout."""
        self._wait(process, cmd_args, events.ProcessExited, "finish", timeout)

    def _wait(
        self,
        process: ExecuteLocal | str,
        cmd_args: str | Sequence[str] | None,
        kind: type[events.RunningProcessEvent],
        verb: str,
        timeout: float | None,
    ) -> None:
        handler = self._proc_info_handler

        def has_happened() -> bool:
            try:
                (action,) = resolveProcesses(handler, process=process, cmd_args=cmd_args)
            except NoMatchingProcessException:
                return False
            return isinstance(handler[action], kind)

        with self.proc_event:
            if not self.proc_event.wait_for(has_happened, timeout=timeout):
                raise AssertionError(f"Timed out waiting for process '{process}' to {verb}")
