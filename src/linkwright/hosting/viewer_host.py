"""The viewers in this process, whose pages replace RViz's windows."""

from __future__ import annotations

import asyncio
import os
import sys
import threading
from collections.abc import Iterator
from importlib import import_module
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.hosting.plans import HostedPlan, NodeWithPanel, Supervisor

if TYPE_CHECKING:
    from linkwright.graph import Graph
    from linkwright.nodes import RunningNode
    from linkwright.page.page_server import PageServer
    from linkwright.viewer import Viewer
    from linkwright.viewer.guests import GuestRecordings

_CLOSE_TIMEOUT_S = 0.8

_RECONNECT_TIMEOUT_S = 2.5
"""The seconds to wait for the pages of a previous run.

This is longer than the interval at which the pages try to reconnect.
"""

_POLL_INTERVAL_S = 0.1


class ViewerHost:
    """The host of the viewers of this process, which starts and ends them."""

    def __init__(self, session: Supervisor) -> None:
        self._session = session
        self._viewers: dict[str, tuple[HostedPlan, Viewer]] = {}
        self._servers: dict[str, PageServer] = {}
        self._findings: list[Diagnostic] = []
        self._port_owner = ""

    def __bool__(self) -> bool:
        return bool(self._viewers)

    @property
    def shows_world(self) -> bool:
        """Whether a page shows the simulated world."""
        from linkwright.hosting.world_config import shows_world

        return any(shows_world(viewer.config) for _, viewer in self._viewers.values())

    def plans(self) -> Iterator[HostedPlan]:
        """Yield the plans of the running viewers."""
        return iter([plan for plan, _ in self._viewers.values()])

    def show_findings(self, findings: list[Diagnostic]) -> None:
        """Show the current findings about description files in the viewers."""
        self._findings = findings
        for _, viewer in self._viewers.values():
            viewer.show_diagnostics(findings)

    def attach_panel(self, node: RunningNode) -> None:
        """Show the panel of a node.

        Sliders are shown in all viewers. A panel that the node requests opens in the first viewer.
        """
        for number, (_, viewer) in enumerate(self._viewers.values()):
            _attach_panel(viewer, node)
            if number == 0:
                _open_panel(viewer, node)

    async def serve_page(self, plan: HostedPlan) -> None:
        """Serve the page of a viewer that does not exist yet, and print the address of the page.

        The browser can then load the page while the viewer is created.

        Raises:
            LinkwrightError: VIEW101 to VIEW104, the server cannot listen on the address.
        """
        server = self._create_server(plan)
        try:
            await server.open()
        except LinkwrightError:
            self._release_port(plan)
            raise
        self._servers[plan.process_name] = server
        await self._announce(server)

    def _create_server(self, plan: HostedPlan) -> PageServer:
        from linkwright.page.page_server import PageServer

        options = self._session.options
        return PageServer(
            options.host,
            self._choose_port(plan),
            only_loopback=options.terminal is not None,
            needs_terminal=options.needs_terminal,
        )

    async def _announce(self, server: PageServer) -> None:
        """Print the address of a page, and open the page in a browser if the options ask for it.

        If this program runs in a terminal of another page, that page shows it in a frame instead.
        """
        options = self._session.options
        self._session.log.announce(f"Viewer: {server.url}")
        if not options.open_browser or await server.embed(os.environ, options.title):
            return
        if not server.pages_wait:
            _open_in_browser(server.url)

    async def start(
        self, plan: HostedPlan, graph: Graph, nodes: list[RunningNode], *, with_world: bool = False
    ) -> None:
        """Start a viewer, and print the address of its page.

        Args:
            plan: the plan of the viewer.
            graph: the graph that the viewer shows.
            nodes: the nodes that are already running.
            with_world: whether the page also shows the simulated world, for which there is then no separate viewer.

        Raises:
            LinkwrightError: the viewer cannot be started.
        """
        from linkwright.rviz import find_unsaved
        from linkwright.viewer import Viewer

        session = self._session
        if plan.viewer_config is not None:
            config, findings = plan.viewer_config(), list[Diagnostic]()
        else:
            from linkwright.hosting.rviz2_arguments import read_viewer_config

            config, findings = read_viewer_config(plan.arguments)
        session.log.write_diagnostics([*findings, *find_unsaved(config)])
        if with_world:
            from linkwright.hosting.world_config import show_world

            show_world(config)
        server = self._servers.get(plan.process_name)  # If creating the viewer fails, the server must be closed here.
        is_announced = server is not None
        if server is None:
            server = self._create_server(plan)
        viewer = Viewer(
            graph,
            library=session.descriptions.library,
            finder=session.finder,
            config=config,
            server=server,
            title=session.options.title,
            options=plan.node_options(session.descriptions.library),
            history=session.options.history,
        )
        self._servers.pop(plan.process_name, None)
        viewer.make_guests = lambda: _create_guests(viewer)
        if session.options.terminal is not None:
            from linkwright.panels.terminal.feature import TerminalFeature

            viewer.add_feature(TerminalFeature).enable(session.options.terminal, programs=server.program_pages)
        await viewer.start()
        self._viewers[plan.process_name] = plan, viewer
        if plan.viewer_started is not None:
            plan.viewer_started(viewer)
        if session.options.viewer_started is not None:
            session.options.viewer_started(viewer)
        if not is_announced:
            await self._announce(server)
        if server.is_embedded:
            from linkwright.hosting.world_pause import WorldPause  # few programs run in a terminal of a page

            server.on_pause(WorldPause(viewer.context.node).set_active)
        if session.options.open_browser and server.pages_wait and not server.is_embedded:
            session.spawn(self._open_unless_reconnected(viewer))
        session.log.write_info(
            plan.process_name,
            f"started in the launcher's process: the viewer in the browser replaces {plan.replaced_window}",
        )
        viewer.show_diagnostics([*self._findings, *findings])
        for node in nodes:
            _attach_panel(viewer, node)
            if len(self._viewers) == 1:
                _open_panel(viewer, node)

    async def _open_unless_reconnected(self, viewer: Viewer) -> None:
        """Open the page in a browser, unless a page of the previous run reconnects."""
        for _ in range(round(_RECONNECT_TIMEOUT_S / _POLL_INTERVAL_S)):
            if self._session.is_ending or len(viewer.audience) > 0:
                return
            await asyncio.sleep(_POLL_INTERVAL_S)
        _open_in_browser(viewer.url)

    def _choose_port(self, plan: HostedPlan) -> int | None:
        """Return the port that the user requested.

        Return None if another page of this run already uses it.
        """
        port = self._session.options.port
        if port and self._port_owner not in ("", plan.process_name):
            return None
        self._port_owner = plan.process_name
        return port

    def _release_port(self, plan: HostedPlan) -> None:
        if plan.process_name == self._port_owner:
            self._port_owner = ""

    def pop_viewer(self, plan: HostedPlan) -> Viewer:
        """Remove a viewer from the running viewers, and return it.

        The caller must end it.
        """
        self._release_port(plan)
        return self._viewers.pop(plan.process_name)[1]

    async def close(self) -> None:
        """Close the servers of pages whose viewers were not created."""
        while self._servers:
            await self._servers.popitem()[1].close()

    async def stop(self, plan: HostedPlan, viewer: Viewer) -> None:
        """Store the unsaved edits of a viewer, and end it.

        The edits are stored first, because the end may take too long.
        """
        self._session.log.write_diagnostics(viewer.keep_unsaved())
        try:
            await asyncio.wait_for(viewer.close(), _CLOSE_TIMEOUT_S)
        except asyncio.TimeoutError:
            self._session.log.write_warning(plan.process_name, "a browser did not close its connection in time")


def load_viewer() -> None:
    """Import the modules of viewers.

    This takes time, and may run in another thread.
    """
    import linkwright.viewer.viewer  # noqa: F401 - only loaded


def _create_guests(viewer: Viewer) -> GuestRecordings:
    from linkwright.viewer.guests import GuestRecordings  # few users upload recordings

    return GuestRecordings(viewer)


def _attach_panel(viewer: Viewer, node: RunningNode) -> None:
    from linkwright.nodes.options import NodeWithWindow
    from linkwright.panels.joints import NodeWithSliders

    if isinstance(node, NodeWithSliders):
        viewer.attach_joint_panel(node.panel)
    if isinstance(node, NodeWithWindow):
        module, _, name = node.window_feature.partition(":")
        viewer.add_feature(getattr(import_module(module), name)).show(node)


def _open_panel(viewer: Viewer, node: RunningNode) -> None:
    if isinstance(node, NodeWithPanel) and node.requests:
        from linkwright.panels.requested_panels import RequestedPanelsFeature  # few launches open panels

        feature = viewer.add_feature(RequestedPanelsFeature)
        for request in node.requests:
            feature.add(request)


def _open_in_browser(url: str) -> None:
    """Open a page in the user's browser, in a thread because some browsers respond slowly.

    Without a display, nothing is opened, because a text browser would take over the terminal.
    """
    displays = ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")
    if sys.platform.startswith("linux") and not any(os.environ.get(name) for name in displays):
        return
    import webbrowser

    threading.Thread(target=webbrowser.open, args=(url,), name="linkwright-browser", daemon=True).start()
