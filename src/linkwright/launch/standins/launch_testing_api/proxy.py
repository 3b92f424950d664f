"""A proxy for a process of a launch in tests (``launch_testing.tools.process``)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from linkwright.launch.engine.service import LaunchService
from linkwright.launch.model import events
from linkwright.launch.model.actions.execute import ExecuteProcess
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.standins.launch_testing_api.asserts import join_output
from linkwright.launch.standins.launch_testing_api.records import ActiveIoHandler, ActiveProcInfoHandler


class Outcome:
    """The result of a wait: true if the wait succeeded before its timeout.

    Args:
        is_true: whether the wait succeeded before its timeout.
        output: the output of the process up to the end of the wait; None if it was not read.
    """

    def __init__(self, is_true: bool, output: str | None) -> None:
        self._is_true = is_true
        self._output = output

    def __bool__(self) -> bool:
        return self._is_true

    def __repr__(self) -> str:
        return f"<{self._is_true}: {self._output!r}>"


class ProcessProxy:
    """A proxy that provides the state, output and exit code of a process.

    Args:
        process_action: the action that starts the process.
        proc_info: the records of the starts and exits of processes.
        proc_output: the output of the processes.
        output_filter: a function that filters the output.

    Raises:
        TypeError: an argument has another type.
    """

    def __init__(
        self,
        process_action: ExecuteProcess,
        proc_info: ActiveProcInfoHandler,
        proc_output: ActiveIoHandler,
        *,
        output_filter: Callable[[str], str] | None = None,
    ) -> None:
        _check_type(process_action, ExecuteProcess, "process_action")
        _check_type(proc_info, ActiveProcInfoHandler, "proc_info")
        _check_type(proc_output, ActiveIoHandler, "proc_output")
        _check_callable(output_filter, "output_filter")
        self._process_action = process_action
        self._proc_info = proc_info
        self._proc_output = proc_output
        self._output_filter = output_filter

    @property
    def target_process_action(self) -> ExecuteProcess:
        """The action that starts the process."""
        return self._process_action

    @property
    def stdout(self) -> str:
        """The standard output of the process."""
        return self._read_output("stdout")

    @property
    def stderr(self) -> str:
        """The standard error of the process."""
        return self._read_output("stderr")

    @property
    def output(self) -> str:
        """The output of the process to both streams, in order."""
        return self._read_output(None)

    @property
    def running(self) -> bool:
        """Whether the process has started and not ended."""
        return isinstance(self._last_event, events.ProcessStarted)

    @property
    def terminated(self) -> bool:
        """Whether the process has ended."""
        return isinstance(self._last_event, events.ProcessExited)

    @property
    def exit_code(self) -> int:
        """The exit code of the process."""
        code: int = self._proc_info[self._process_action].returncode
        return code

    def wait_for_shutdown(self, timeout: float | None = None) -> bool:
        """Wait until the process has ended, and return whether it ended in time.

        Args:
            timeout: the timeout in seconds; None to wait without limit.
        """
        with self._proc_info.proc_event:
            return self._proc_info.proc_event.wait_for(lambda: self.terminated, timeout=timeout)

    def wait_for_output(self, condition: Callable[[str], Any] | None = None, timeout: float | None = None) -> Outcome:
        """Wait for output of the process.

        Return whether the output arrived in time, with the output so far.

        Args:
            condition: a predicate on the entire output; if omitted, any output suffices.
            timeout: the timeout in seconds; None to wait without limit.
        """
        _check_callable(condition, "condition")
        output: str | None = None

        def has_arrived() -> bool:
            nonlocal output
            if not self.running:
                return False
            output = self.output
            return condition is None or bool(condition(output))

        with self._proc_output.io_event:
            has_succeeded = self._proc_output.io_event.wait_for(has_arrived, timeout=timeout)
            return Outcome(has_succeeded, output)

    @property
    def _last_event(self) -> object:
        actions = self._proc_info.processes()
        return self._proc_info[self._process_action] if self._process_action in actions else None

    def _read_output(self, stream: str | None) -> str:
        text = join_output(self._proc_output[self._process_action], stream)
        return text if self._output_filter is None else self._output_filter(text)


@contextmanager
def launch_process(
    launch_service: LaunchService,
    process_action: ExecuteProcess,
    proc_info: ActiveProcInfoHandler,
    proc_output: ActiveIoHandler,
    **kwargs: Any,
) -> Iterator[ProcessProxy]:
    """Start a process in a running launch for the duration of a context.

    At the end of the context, the process is shut down if it is still running.

    Args:
        launch_service: the service that runs the launch.
        process_action: the action that starts the process.
        proc_info: the records of starts and exits.
        proc_output: the output of the processes.
        kwargs: passed to `ProcessProxy`.
    """
    _check_type(process_action, ExecuteProcess, "process_action")
    launch_service.include_launch_description(LaunchDescription([process_action]))
    process = ProcessProxy(process_action, proc_info, proc_output, **kwargs)
    try:
        yield process
    finally:
        if not process.terminated:
            matcher = events.matches_action(process_action)
            launch_service.emit_event(events.ShutdownProcess(process_matcher=matcher))


def _check_type(value: object, kind: type, name: str) -> None:
    if not isinstance(value, kind):
        raise TypeError(f"'{name}' must be of type {kind.__name__}, not {type(value).__name__}")


def _check_callable(value: object, name: str) -> None:
    if value is not None and not callable(value):
        raise TypeError(f"Expected '{name}' to be callable but got '{value!r}'")
