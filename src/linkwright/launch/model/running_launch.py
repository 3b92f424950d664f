"""The interface of the running launch for actions: they describe what is to be done, and the engine does it."""

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
    """A call that is to come."""

    def cancel(self) -> None:
        """Do not call."""


Schedule = Callable[[float, Callable[[], None]], Scheduled]
"""Has a function called once after some seconds."""


class NodeHosting(Protocol):
    """Runs nodes in the launcher's own process."""

    @property
    def graph(self) -> Graph:
        """The graph of these nodes."""

    @property
    def launcher_node(self) -> Node:
        """The launcher's own node, with which it asks services and follows topics; made when first asked for."""

    def plan(self, plan: HostedPlan) -> None:
        """Have a node started as soon as the launcher comes to it; none any more once the launch ends."""

    def use_simulated_time(self, value: bool) -> None:
        """Switch the launcher's own node between ``/clock`` and wall time."""


class RunningLaunch(Protocol):
    """The launch that runs."""

    @property
    def finder(self) -> PackageFinder:
        """Where packages are."""

    @property
    def log(self) -> LaunchLog:
        """The log of the launch."""

    @property
    def descriptions(self) -> Descriptions:
        """The robot descriptions of this launch."""

    @property
    def left_out(self) -> set[str]:
        """The names, without namespaces, of nodes that were left out since they cannot be had."""

    @property
    def host(self) -> NodeHosting:
        """Runs nodes in the launcher's own process."""

    @property
    def loop(self) -> asyncio.AbstractEventLoop | None:
        """The loop it runs on, while it does."""

    @property
    def ending(self) -> bool:
        """Whether it is about to end."""

    @property
    def isolates_nodes(self) -> bool:
        """Whether our own nodes run as processes, each by itself."""

    @property
    def scratch_folder(self) -> Path:
        """A folder for files that the processes of this launch read; it goes when the launch is over."""

    def number_process(self, base_name: str) -> str:
        """The name of a process in the log: that of its program with the next number."""

    def start_process(self, plan: ProcessPlan, name: str) -> None:
        """Start a process and follow it to its end, and start it again where it respawns."""

    def call_later(
        self,
        seconds: float,
        event: Event,
        entities: Sequence[object],
        *,
        cancel_on_shutdown: bool = True,
        schedule: Schedule | None = None,
    ) -> Callable[[], None]:
        """Emit an event and visit entities after a while; returns what cancels that."""

    def hold(self, future: asyncio.Future[Any]) -> None:
        """Have the launch not end before something that an entity began is done."""

    def spawn(self, work: Coroutine[Any, Any, None]) -> None:
        """Run something in the background; the launch does not end before it has."""

    def could_not_start(self, what: object, error: LinkwrightError) -> None:
        """Report why something could not be started; the launch goes on without it."""

    def fail(self, what: object) -> None:
        """Record a failure: the launch exits with 1."""

    def report(self, about: object, findings: Sequence[Diagnostic]) -> None:
        """Report findings about a robot description, here and in the viewer."""
