"""The nodes and viewers in this process, of a launch or of the view of a description."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import partial
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.hosting.launch_log import SCREEN, output_destinations
from linkwright.hosting.plans import HostedPlan, Supervisor
from linkwright.hosting.reload import WatchedFiles
from linkwright.hosting.viewer_host import ViewerHost, load_viewer

if TYPE_CHECKING:
    from linkwright.graph import Graph, LogRecord, Node
    from linkwright.hosting.network import Network, SharedNames
    from linkwright.hosting.xacro_calls import XacroCall
    from linkwright.nodes import RunningNode
    from linkwright.viewer import Viewer

_SCREEN_DESTINATIONS = output_destinations("screen")[2]


class NodeHost:
    """The host of the nodes of this process, which starts and ends them.

    A viewer is started before the nodes that were planned with it, so that its page responds early.
    """

    def __init__(self, session: Supervisor) -> None:
        self._session = session
        self._planned: list[HostedPlan] = []
        self._running: dict[str, tuple[HostedPlan, RunningNode]] = {}
        self._viewers = ViewerHost(session)
        self._windows: dict[str, HostedPlan] = {}
        self._graph: Graph | None = None
        self._shared_names: SharedNames | None = None
        self._model_findings: list[Diagnostic] = []
        self._launcher: Node | None = None
        self._uses_simulated_time = False
        self._process_of_logger: dict[str, str] = {}
        self._destinations: dict[str, frozenset[str]] = {}
        self._current_process = "launch"
        self._delayed_records: list[tuple[str, LogRecord]] | None = None
        self._start_lock = asyncio.Lock()
        self._is_closing = False
        self._closed = asyncio.Event()
        self._network: Network | None = None
        if session.options.network:
            from linkwright.hosting.network import Network

            self._network = Network(session)

    @property
    def is_busy(self) -> bool:
        """Whether any node is running in this process or is planned."""
        return bool(self._planned or self._running or self._viewers or self._start_lock.locked())

    @property
    def has_viewer(self) -> bool:
        """Whether a viewer is running."""
        return bool(self._viewers)

    @property
    def viewer_arguments(self) -> list[list[str]]:
        """The command-line arguments of each viewer that is running."""
        return [plan.arguments for plan in self._viewers.plans()]

    @property
    def shows_world(self) -> bool:
        """Whether a page shows the simulated world."""
        return self._viewers.shows_world

    @property
    def graph(self) -> Graph:
        """The graph of the nodes of this process."""
        if self._graph is None:
            from linkwright.graph import Graph

            if self._network is None:
                self._graph = Graph(on_log=self._on_log)
            else:
                self._graph = self._open_shared_graph(self._network)
        return self._graph

    @property
    def launcher_node(self) -> Node:
        """The launcher's own node, which calls services and subscribes to topics.

        The node is created on first access.
        """
        if self._launcher is None:
            self._launcher = self.graph.create_node(
                f"launch_ros_{os.getpid()}", enable_rosout=False, parameters={"use_sim_time": self._uses_simulated_time}
            )
            self.join_network_soon()
        return self._launcher

    def find_node(self, full_name: str) -> Node | None:
        """Return the node with a full name that runs in this process, or None."""
        nodes = (running.node for _, running in self._running.values())
        return next((node for node in nodes if node.get_fully_qualified_name() == full_name), None)

    def use_simulated_time(self, value: bool) -> None:
        """Set whether the launcher's own node follows ``/clock`` or system time."""
        from linkwright.graph import Parameter

        self._uses_simulated_time = value
        if self._launcher is not None:
            self._launcher.set_parameters([Parameter("use_sim_time", value=value)])

    def join_network_soon(self) -> None:
        """Join the ROS 2 network after a delay, unless this was already requested.

        This method has no effect before `graph` is used, or if the options or the environment disable the network.
        """
        if self._network is not None:
            self._network.join_soon(with_viewer=self.has_viewer)

    def schedule_node(self, plan: HostedPlan) -> None:
        """Plan a node, which starts as soon as possible.

        This has no effect while the launch is ending.
        """
        if not self._is_closing:
            self._planned.append(plan)

    def discard_planned(self) -> None:
        """Discard all plans of nodes that have not been started."""
        self._planned.clear()

    async def serve_pages(self) -> None:
        """Serve the pages of the planned viewers, and then load the modules that viewers need.

        If a server cannot listen on its port, the start of its viewer raises the error.
        """
        planned = [plan for plan in self._planned if plan.is_viewer]
        for plan in planned:
            with suppress(LinkwrightError):
                await self._viewers.serve_page(plan)
        if planned or any(plan.has_panel for plan in self._planned):
            await asyncio.to_thread(load_viewer)

    async def start_planned(self) -> None:
        """Start all planned nodes, viewers first, and let other callbacks run between two nodes."""
        if not self._planned:
            return
        async with self._start_lock:
            while self._planned and not self._is_closing:
                plan = next((hosted_plan for hosted_plan in self._planned if hosted_plan.is_viewer), self._planned[0])
                self._planned.remove(plan)
                if self._session.postpones(plan):
                    continue
                self._destinations[plan.process_name] = plan.destinations[2]
                with_world = any(hosted_plan.opens_gazebo_window for hosted_plan in self._planned)
                if plan.is_viewer:
                    await self._start_viewer(plan, with_world=with_world)
                else:
                    if plan.has_panel and not self._viewers:
                        page = plan.panel_page
                        if not await self._start_viewer(page, with_world=with_world):
                            break
                        self._windows[plan.process_name] = page
                    if plan.opens_gazebo_window and not self._viewers.shows_world:
                        window = plan.gazebo_window
                        if not await self._start_viewer(window):
                            break
                        self._windows[plan.process_name] = window
                    self._start_node(plan)
                    await asyncio.sleep(0)
        if not self._is_closing:
            self.join_network_soon()

    def show_findings(self, findings: list[Diagnostic]) -> None:
        """Show the current findings about description files in the viewers."""
        self._model_findings = findings
        self._show_findings()

    def stop_matching(self, matcher: Callable[[Any], bool]) -> None:
        """End the nodes and viewers with a matching owner, as a signal would end their processes.

        Args:
            matcher: returns whether a node with a given owner is to end.
        """
        for plan, node in tuple(self._running.values()):
            if matcher(plan.owner):
                self._stop_node(plan, node)
        for plan in self._viewers.plans():
            if matcher(plan.owner):
                self._session.spawn(self._stop_viewer(plan, self._viewers.pop_viewer(plan)))

    def close_nodes(self) -> None:
        """End all nodes, and start to end the viewers."""
        self._is_closing = True
        self._closed.set()
        self.discard_planned()
        self.stop_matching(lambda _: True)

    async def close(self) -> None:
        """End all nodes and viewers."""
        self.close_nodes()
        for plan in self._viewers.plans():
            await self._stop_viewer(plan, self._viewers.pop_viewer(plan))
        await self._viewers.close()
        if self._network is not None:
            self._network.close()
        if self._shared_names is not None:
            self._shared_names.close()
        if self._graph is not None:
            await self._graph.close()

    def _open_shared_graph(self, network: Network) -> Graph:
        """Return a new graph that joins the network, with a monitor of shared node names."""
        from linkwright.graph import Graph
        from linkwright.hosting.network import SharedNames

        self._shared_names = SharedNames(network, self._session.log, self._show_findings)
        graph = Graph(on_log=self._on_log, on_shared_names=self._shared_names.set_names)
        network.set_graph(graph)
        return graph

    # --- nodes ----------------------------------------------------------------------------------------------

    def _start_node(self, plan: HostedPlan) -> None:
        from linkwright.nodes.options import FinishingNode, LoadingNode

        session = self._session
        session.log.write_info(plan.process_name, "started in the launcher's process")
        try:
            with self._attribute_records(plan.process_name), self._hide_fatal_records():
                node = self._create_node(plan)
        except LinkwrightError as error:
            self._handle_start_failure(plan, error)
            return
        self._running[plan.process_name] = plan, node
        self._register(plan.process_name, node, plan.parameters)
        if isinstance(node, LoadingNode):
            node.loading = lambda: self._attribute_records(plan.process_name)
            node.on_loaded.append(
                lambda loaded, node_options: self._register(plan.process_name, loaded, node_options.parameters)
            )
        session.report_node_start(plan)
        if isinstance(node, FinishingNode):
            node.finished.add_done_callback(lambda future: self._handle_finish(plan, node, future))

    def _create_node(self, plan: HostedPlan) -> RunningNode:
        options = plan.node_options(self._session.descriptions.library)
        if plan.panel_program is not None:
            from linkwright.hosting.panel_node import PanelNode

            node = PanelNode(self.graph, plan, options)
            self._session.log.write_diagnostics(node.findings)
            return node
        from linkwright.nodes import EXECUTABLES

        return EXECUTABLES[(plan.package, plan.executable)](self.graph, options)

    def _register(self, process_name: str, node: RunningNode, parameters: Mapping[str, Any]) -> None:
        from linkwright.nodes.options import NodeWithFiles

        self._process_of_logger[node.node.get_logger().name] = process_name
        self._bind_descriptions(process_name, node, parameters)
        if isinstance(node, NodeWithFiles):
            node.watch_files(WatchedFiles(self._session.reload, self._session.spawn, lambda: self.launcher_node))
        self._viewers.attach_panel(node)

    def _handle_start_failure(self, plan: HostedPlan, error: LinkwrightError) -> None:
        """Report why a node could not start.

        If the description file of the node is not valid, the node is started when the file is fixed.
        """
        session = self._session
        description = self._find_description(plan) if plan.waits_for_fix else None
        if description is None or session.is_ending:
            session.fail(plan)
            session.log.write_diagnostics(error.diagnostics)
            session.log.write_error(plan.process_name, "node has not started")
            session.report_node_end(plan, 1)
            return
        name, call = description
        session.fail(call)

        def start_again(text: str) -> None:
            session.reload.unbind(call, start_again)
            session.clear_failure(call)
            plan.parameters[name] = text
            self._start_node(plan)

        session.reload.bind(call, start_again)
        session.reload.report(call, error.diagnostics)

    def _bind_descriptions(self, process_name: str, node: RunningNode, parameters: Mapping[str, Any]) -> None:
        """Pass each new text of a node's descriptions to the node.

        Findings about the current texts are shown.
        """
        from linkwright.nodes.options import NodeWithDescription

        session = self._session
        for name, value in parameters.items():
            call = session.descriptions.find_call(value) if isinstance(value, str) else None
            if call is not None:
                session.reload.bind(call, partial(self._set_parameter, process_name, node, name))
            if isinstance(node, NodeWithDescription) and name == node.description_parameter:
                read_description = session.descriptions.library.read(value)
                warnings = session.descriptions.get_warnings(call) if call else ()
                session.reload.report(call or process_name, (*warnings, *read_description.diagnostics))

    def _set_parameter(self, process_name: str, node: RunningNode, name: str, text: str) -> None:
        from linkwright.graph import Parameter

        if node.node.handle.is_destroyed:
            return
        with self._attribute_records(process_name):
            result = node.node.set_parameters([Parameter(name, value=text)])[0]
        if not result.successful:
            raise LinkwrightError(
                Diagnostic(
                    "LAUNCH143",
                    phrase(
                        "'{process_name}' rejects the robot description: {reason}",
                        process_name=process_name,
                        reason=foreign(result.reason),
                    ),
                )
            )

    def _find_description(self, plan: HostedPlan) -> tuple[str, XacroCall] | None:
        for name, value in plan.parameters.items():
            call = self._session.descriptions.find_call(value) if isinstance(value, str) else None
            if call is not None:
                return name, call
        return None

    def _stop_node(self, plan: HostedPlan, node: RunningNode, status: int = 0) -> None:
        del self._running[plan.process_name]
        node.close()
        self._report_end(plan, status)

    def _handle_finish(self, plan: HostedPlan, node: RunningNode, future: asyncio.Future[int]) -> None:
        """Close a node that has finished, and restart it if its plan requests a respawn."""
        if plan.process_name not in self._running or future.cancelled():
            return
        self._stop_node(plan, node, future.result())
        if plan.respawns and not self._is_closing:
            plan.respawns -= 1
            self._session.spawn(self._restart(plan))

    async def _restart(self, plan: HostedPlan) -> None:
        with suppress(asyncio.TimeoutError):
            await asyncio.wait_for(self._closed.wait(), plan.respawn_delay)
        self.schedule_node(plan)
        await self.start_planned()

    def _show_findings(self) -> None:
        shared_name_findings = [] if self._shared_names is None else self._shared_names.findings
        self._viewers.show_findings([*shared_name_findings, *self._model_findings])

    # --- viewers --------------------------------------------------------------------------------------------

    async def _start_viewer(self, plan: HostedPlan, *, with_world: bool = False) -> bool:
        """Start a viewer, and return whether it started.

        If not, log the reason and end the launch.
        """
        session = self._session
        nodes = [running for _, running in self._running.values()]
        try:
            with self._attribute_records(plan.process_name):
                await self._viewers.start(plan, self.graph, nodes, with_world=with_world)
        except LinkwrightError as error:
            session.fail(plan)
            session.log.write_diagnostics(error.diagnostics)
            if plan.owner is not None:
                session.report_node_end(plan, 1)
            session.shut_down("the viewer has not started")
            return False
        logger = ".".join([*plan.namespace.strip("/").split("/"), plan.node_name or plan.executable]).lstrip(".")
        self._process_of_logger[logger] = plan.process_name
        if plan.owner is not None:
            session.report_node_start(plan)
        return True

    async def _stop_viewer(self, plan: HostedPlan, viewer: Viewer) -> None:
        await self._viewers.stop(plan, viewer)
        self._report_end(plan)
        if not self._viewers:
            for panel_plan, node in tuple(self._running.values()):
                if panel_plan.panel_program is not None:
                    self._stop_node(panel_plan, node)

    # --- both -----------------------------------------------------------------------------------------------

    def _report_end(self, plan: HostedPlan, status: int = 0) -> None:
        if status == 0:
            self._session.log.write_info(plan.process_name, "has finished cleanly")
        else:
            self._session.log.write_error(plan.process_name, f"has ended with exit code {status}")
        if plan.owner is not None:
            self._session.report_node_end(plan, status)
        window = self._windows.pop(plan.process_name, None)
        if window is None:
            return
        panel_plan = next((other for other, _ in self._running.values() if other.has_panel), None)
        if panel_plan is not None:
            self._windows[panel_plan.process_name] = window
        else:
            self._session.spawn(self._stop_viewer(window, self._viewers.pop_viewer(window)))

    def _on_log(self, record: LogRecord) -> None:
        process = self._find_process(record.node)
        if self._delayed_records is not None and record.level.name == "FATAL":
            self._delayed_records.append((process, record))
            return
        self._session.log.write_node_record(process, record, self._destinations.get(process, _SCREEN_DESTINATIONS))

    @contextmanager
    def _hide_fatal_records(self) -> Iterator[None]:
        """Keep the fatal records of a node that fails to start off the screen.

        Use in a ``with`` block.

        The findings report the same errors, with their locations.
        """
        self._delayed_records, is_off_screen = [], False
        try:
            yield
        except LinkwrightError:
            is_off_screen = True
            raise
        finally:
            records, self._delayed_records = self._delayed_records, None
            for process, record in records:
                destinations = self._destinations.get(process, _SCREEN_DESTINATIONS)
                self._session.log.write_node_record(
                    process, record, destinations - {SCREEN} if is_off_screen else destinations
                )

    @contextmanager
    def _attribute_records(self, process_name: str) -> Iterator[None]:
        """Attribute the records of unknown loggers to a process.

        Use in a ``with`` block.
        """
        previous_process, self._current_process = self._current_process, process_name
        try:
            yield
        finally:
            self._current_process = previous_process

    def _find_process(self, logger: str) -> str:
        """Return the name of a logger's process.

        The process is found by the name of the logger, of its ancestors, or of the node that created it.
        """
        creators = {} if self._graph is None else dict(self._graph.creators)
        while logger:
            if logger in self._process_of_logger:
                return self._process_of_logger[logger]
            logger = creators.pop(logger, "") or logger.rpartition(".")[0]
        return self._current_process
