"""The interface through which the modules for processes use the session."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from linkwright.hosting.plans import HostOptions
from linkwright.launch.model.running_launch import RunningLaunch

if TYPE_CHECKING:
    from linkwright.diagnostics import LinkwrightError
    from linkwright.launch.model.events import Event


@dataclass(frozen=True)
class SessionOptions(HostOptions):
    """The options of a launch.

    Attributes:
        isolate: whether Linkwright's own nodes run in separate processes.
        shutdown_when_idle: whether the launch ends when it is idle.
        skip_missing: whether to skip the parts of the launch whose package, program or file is missing.
        command_to_skip_missing: the command that repeats the launch with `skip_missing`; None if `skip_missing` is set
            already, or there is no such command.
    """

    isolate: bool = False
    shutdown_when_idle: bool = True
    skip_missing: bool = False
    command_to_skip_missing: str | None = None


class Supervisor(RunningLaunch, Protocol):
    """The interface of the session for starting and ending the processes of a launch."""

    def emit(self, event: Event) -> None:
        """Queue an event."""

    def would_handle(self, event: Event) -> bool:
        """Return whether any handler accepts an event."""

    def report_start_failure(self, subject: object, error: LinkwrightError) -> None:
        """Report why a process or node could not be started.

        The launch continues without it.
        """
