"""The events of a running launch."""

from __future__ import annotations

import signal as signals
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

from linkwright.launch.errors.locations import SourceLocation


class ProcessAction(Protocol):
    """The interface of actions that start a process, or a node in the launcher's process.

    Attributes:
        source_location: the location of the action in the user's program.
        process_details: ``name``, ``cmd``, ``cwd``, ``env`` and ``pid`` of the process; None before the start.
    """

    source_location: SourceLocation | None
    process_details: dict[str, Any] | None

    def record_output(self, stream: int, text: bytes) -> None:
        """Store output that the process wrote to stdout (1) or stderr (2)."""

    def record_exit(self, event: ProcessExited, context: Any) -> list[Any]:
        """Record that the process ended, and return the entities to visit next."""


ProcessMatcher = Callable[[ProcessAction], bool]


class Event:
    """The base class of events.

    An event reports a change, or requests an action.
    """

    name = "launch.Event"


class IncludeLaunchDescription(Event):
    """A request to visit a launch description."""

    name = "launch.events.IncludeLaunchDescription"

    def __init__(self, launch_description: Any) -> None:
        self.launch_description = launch_description


class Shutdown(Event):
    """A request to end the launch."""

    name = "launch.events.Shutdown"

    def __init__(self, *, reason: str = "reason not given", due_to_sigint: bool = False) -> None:
        self.reason = reason
        self.due_to_sigint = due_to_sigint


class TimerEvent(Event):
    """The event that a timer has expired."""

    name = "launch.events.TimerEvent"

    def __init__(self, *, timer_action: object, context: object = None) -> None:
        self.timer_action = timer_action
        self.context = context


class ExecutionComplete(Event):
    """The event that an action has completed."""

    name = "launch.events.ExecutionComplete"

    def __init__(self, *, action: object) -> None:
        self.action = action


class RunningProcessEvent(Event):
    """The base class of the events of a process, or of a node in the launcher's process.

    Attributes:
        action: the action that started the process.
        process_name: the name of the process in the log, such as ``talker-1``.
        cmd: the command as a list of arguments.
        cwd: the working directory; None for the launcher's.
        env: the environment; None for the launcher's.
        pid: the process ID.
    """

    name = "launch.events.process.RunningProcessEvent"

    def __init__(
        self,
        *,
        action: ProcessAction,
        name: str,
        cmd: Sequence[str],
        cwd: str | None,
        env: Mapping[str, str] | None,
        pid: int,
    ) -> None:
        self.action = action
        self.process_name = name
        self.cmd = list(cmd)
        self.cwd = cwd
        self.env = env
        self.pid = pid

    @property
    def execute_process_action(self) -> ProcessAction:
        """The value of `action`, under its former name."""
        return self.action


class ProcessStarted(RunningProcessEvent):
    """The event that a process has started."""

    name = "launch.events.process.ProcessStarted"


class ProcessExited(RunningProcessEvent):
    """The event that a process has ended.

    Args:
        returncode: the exit status; the negative signal number if a signal ended the process.
        details: the arguments of `RunningProcessEvent`.
    """

    name = "launch.events.process.ProcessExited"

    def __init__(self, *, returncode: int, **details: Any) -> None:
        super().__init__(**details)
        self.returncode = returncode


class ProcessIO(RunningProcessEvent):
    """The event that a process wrote output.

    Args:
        text: the bytes that the process wrote.
        fd: 1 for stdout, 2 for stderr.
        details: the arguments of `RunningProcessEvent`, as for `ProcessExited`.
    """

    name = "launch.events.process.ProcessIO"
    fd = 0

    def __init__(self, *, text: bytes, fd: int | None = None, **details: Any) -> None:
        super().__init__(**details)
        self.text = text
        if fd is not None:
            self.fd = fd

    @property
    def from_stdin(self) -> bool:
        """Whether the text was sent to stdin."""
        return self.fd == 0

    @property
    def from_stdout(self) -> bool:
        """Whether the text was written to stdout."""
        return self.fd == 1

    @property
    def from_stderr(self) -> bool:
        """Whether the text was written to stderr."""
        return self.fd == 2


class ProcessStdout(ProcessIO):
    """The event that a process wrote to stdout."""

    name = "launch.events.process.ProcessStdout"
    fd = 1


class ProcessStderr(ProcessIO):
    """The event that a process wrote to stderr."""

    name = "launch.events.process.ProcessStderr"
    fd = 2


class ProcessTargetedEvent(Event):
    """A request to the processes that the matcher accepts."""

    name = "launch.events.process.ProcessTargetedEvent"

    def __init__(self, *, process_matcher: ProcessMatcher) -> None:
        self.process_matcher = process_matcher


class ProcessStdin(ProcessTargetedEvent):
    """A request to send text to the processes that the matcher accepts.

    Attributes:
        text: the bytes to send.
    """

    name = "launch.events.process.ProcessStdin"

    def __init__(self, *, text: bytes, process_matcher: ProcessMatcher) -> None:
        super().__init__(process_matcher=process_matcher)
        self.text = text


class ShutdownProcess(ProcessTargetedEvent):
    """A request to end the processes that the matcher accepts."""

    name = "launch.events.process.ShutdownProcess"


class SignalProcess(ProcessTargetedEvent):
    """A request to send a signal to the processes that the matcher accepts.

    Attributes:
        signal: the signal to send.
        signal_name: the name of the signal, such as ``SIGINT``.
    """

    name = "launch.events.process.SignalProcess"

    def __init__(self, *, signal_number: str | int | signals.Signals, process_matcher: ProcessMatcher) -> None:
        super().__init__(process_matcher=process_matcher)
        if isinstance(signal_number, str):
            self.signal = signals.Signals[signal_number]
        else:
            self.signal = signals.Signals(signal_number)
        self.signal_name = self.signal.name


def matches_action(target_action: object) -> ProcessMatcher:
    """Return a matcher that accepts the process that an action started."""
    return lambda action: action is target_action


def matches_pid(pid: int) -> ProcessMatcher:
    """Return a matcher that accepts the process with the given ID."""
    return lambda action: action.process_details is not None and action.process_details["pid"] == pid


def matches_name(name: str) -> ProcessMatcher:
    """Return a matcher that accepts the process with the given name in the log."""
    return lambda action: action.process_details is not None and action.process_details["name"] == name


def matches_executable(executable: str) -> ProcessMatcher:
    """Return a matcher that accepts processes whose program has the given file name."""

    def accepts(action: ProcessAction) -> bool:
        details = action.process_details
        return details is not None and bool(details["cmd"][0].rsplit("/", 1)[-1] == executable)

    return accepts
