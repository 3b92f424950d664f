"""What the parts of a session that run processes and nodes may ask of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from linkwright.launch.model.running_launch import RunningLaunch

if TYPE_CHECKING:
    from linkwright.diagnostics import LinkwrightError
    from linkwright.launch.engine.reload import LiveReload
    from linkwright.launch.model.events import Event


@dataclass(frozen=True)
class SessionOptions:
    """How a launch is run.

    Attributes:
        host: the address that the viewer's server binds to.
        port: its port; None for the default one, or the next that is free.
        open_browser: whether the page is opened in the user's browser.
        title: what the page is called.
        isolate: whether our own nodes run as processes, each by itself.
        network: whether the nodes of this process are to be seen by others.
        shutdown_when_idle: whether the launch ends when nothing runs any more.
        skip_missing: whether what cannot run because something is not there is left out.
        command_to_skip_missing: what the user may type to have that; None where it is so, or there is no such command.
    """

    host: str = "127.0.0.1"
    port: int | None = None
    open_browser: bool = True
    title: str = ""
    isolate: bool = False
    network: bool = True
    shutdown_when_idle: bool = True
    skip_missing: bool = False
    command_to_skip_missing: str | None = None


class Supervisor(RunningLaunch, Protocol):
    """What supervises the processes and nodes of a launch."""

    @property
    def options(self) -> SessionOptions:
        """How the launch is run."""

    @property
    def reload(self) -> LiveReload:
        """What gives nodes the new text of a description."""

    @property
    def has_processes(self) -> bool:
        """Whether any process runs."""

    def emit(self, event: Event) -> None:
        """Put an event into the queue."""

    def would_handle(self, event: Event) -> bool:
        """Whether any handler takes an event."""

    def could_not_start(self, what: object, error: LinkwrightError) -> None:
        """Report why something could not be started; the launch goes on without it."""

    def mend(self, what: object) -> None:
        """Clear a failure: what had failed works now."""
