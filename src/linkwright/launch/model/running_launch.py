"""The interface through which actions use the running launch.

The engine (`linkwright.launch.engine`) implements this interface.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from linkwright.diagnostics import Diagnostic, LinkwrightError
    from linkwright.graph import Graph, Node
    from linkwright.hosting.launch_log import LaunchLog
    from linkwright.hosting.plans import HostedPlan
    from linkwright.hosting.xacro_calls import Descriptions
    from linkwright.launch.model.events import Event
    from linkwright.launch.model.plans import ProcessPlan
    from linkwright.packages import PackageFinder


class Scheduled(Protocol):
    """A call that is scheduled for later."""

    def cancel(self) -> None:
        """Cancel the call."""


Schedule = Callable[[float, Callable[[], None]], Scheduled]
"""Calls a function once, after a number of seconds, and returns the scheduled call."""


class NodeHosting(Protocol):
    """The interface of the object that runs nodes in the launcher's own process."""

    @property
    def graph(self) -> Graph:
        """The graph of the nodes in the launcher's process."""

    @property
    def launcher_node(self) -> Node:
        """The launcher's own node for services and topics, created on first use."""

    def schedule_node(self, plan: HostedPlan) -> None:
        """Schedule the start of the node that a plan describes.

        This method has no effect while the launch is ending.
        """

    def find_node(self, full_name: str) -> Node | None:
        """Return the node with a full name in the launcher's process, or None."""

    def use_simulated_time(self, value: bool) -> None:
        """Set whether the launcher's own node follows ``/clock`` or wall time."""


class RunningLaunch(Protocol):
    """The interface of a running launch."""

    @property
    def finder(self) -> PackageFinder:
        """The finder of ROS packages."""

    @property
    def log(self) -> LaunchLog:
        """The log of the launch."""

    @property
    def descriptions(self) -> Descriptions:
        """The robot descriptions of this launch."""

    @property
    def skipped_nodes(self) -> set[str]:
        """The names, without namespaces, of nodes that were skipped because of missing software."""

    @property
    def host(self) -> NodeHosting:
        """The object that runs nodes in the launcher's own process."""

    @property
    def loop(self) -> asyncio.AbstractEventLoop | None:
        """The event loop of the launch, or None if the launch is not running."""

    @property
    def is_ending(self) -> bool:
        """Whether the launch is ending."""

    @property
    def isolates_nodes(self) -> bool:
        """Whether Linkwright's own nodes run in separate processes."""

    @property
    def scratch_folder(self) -> Path:
        """A folder for files that the processes of this launch read.

        The folder is deleted after the launch.
        """

    def assign_process_name(self, base_name: str) -> str:
        """Return the name of a process in the log: its base name with the next number."""

    def start_process(self, plan: ProcessPlan, name: str) -> None:
        """Start a process, monitor it until it ends, and restart it if the plan requests a respawn."""

    def call_later(
        self,
        seconds: float,
        event: Event,
        entities: Sequence[object],
        *,
        cancel_on_shutdown: bool = True,
        schedule: Schedule | None = None,
    ) -> Callable[[], None]:
        """Emit an event and visit entities after a delay in seconds.

        Return a function that cancels both.
        """

    def keep_running_until(self, future: asyncio.Future[Any]) -> None:
        """Keep the launch running until a future is done."""

    def spawn(self, coroutine: Coroutine[Any, Any, None]) -> None:
        """Run a coroutine in the background.

        The launch does not become idle until the coroutine has finished.
        """

    def report_start_failure(self, subject: object, error: LinkwrightError) -> None:
        """Report why a process or node could not be started.

        The launch continues without it.
        """

    def fail(self, failure: object) -> None:
        """Record a failure.

        The launch exits with status 1 unless the failure is cleared.
        """

    def report(self, description: object, findings: Sequence[Diagnostic]) -> None:
        """Report findings about a robot description in the log and the viewer."""
