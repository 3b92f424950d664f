"""The interface by which the parts that run processes use their session."""

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
    """How a launch is run.

    Attributes:
        isolate: whether our own nodes run as processes, each by itself.
        shutdown_when_idle: whether the launch ends when nothing runs any more.
        skip_missing: whether what cannot run because something is not there is left out.
        command_to_skip_missing: what the user may type to have that; None where it is so, or there is no such command.
    """

    isolate: bool = False
    shutdown_when_idle: bool = True
    skip_missing: bool = False
    command_to_skip_missing: str | None = None


class Supervisor(RunningLaunch, Protocol):
    """What supervises the processes of a launch."""

    def emit(self, event: Event) -> None:
        """Put an event into the queue."""

    def would_handle(self, event: Event) -> bool:
        """Whether any handler takes an event."""

    def could_not_start(self, what: object, error: LinkwrightError) -> None:
        """Report why something could not be started; the launch goes on without it."""
