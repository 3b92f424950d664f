"""Nodes that run in the launcher's own process, and the viewer that stands in for RViz."""

from __future__ import annotations

import asyncio
import os
import sys
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.launch import events
from linkwright.launch.engine.hosted_plan import HostedPlan
from linkwright.launch.engine.viewer_arguments import read_viewer_config

if TYPE_CHECKING:
    from linkwright.graph import Graph, LogRecord
    from linkwright.launch.actions.execute import ExecuteProcess
    from linkwright.launch.engine.descriptions import XacroCall
    from linkwright.launch.engine.session import LaunchSession
    from linkwright.nodes import RunningNode
    from linkwright.viewer import Viewer

_DESCRIPTION = "robot_description"
_CLOSE_SECONDS = 0.8


class NodeHost:
    """Starts, holds and ends the nodes of this process.

    The viewer is started before the nodes that were asked for together with it, so that its page answers as
    early as can be.
    """

    def __init__(self, session: LaunchSession) -> None:
        self._session = session
        self._planned: list[HostedPlan] = []
        self._running: dict[str, tuple[HostedPlan, RunningNode]] = {}
        self._viewers: dict[str, tuple[HostedPlan, Viewer]] = {}
        self._findings: list[Diagnostic] = []
        self._graph: Graph | None = None
        self._process_of_logger: dict[str, str] = {}
        self._speaking = "launch"
        self._starting = asyncio.Lock()
        self._closing = False

    @property
    def is_busy(self) -> bool:
        """Whether anything runs here or is about to."""
        return bool(self._planned or self._running or self._viewers or self._starting.locked())

    @property
    def has_viewer(self) -> bool:
        """Whether a viewer runs."""
        return bool(self._viewers)

    def plan(self, plan: HostedPlan) -> None:
        """Have a node started as soon as the launcher comes to it."""
        self._planned.append(plan)

    def forget_planned(self) -> None:
        """Start nothing of what was planned."""
        self._planned.clear()

    async def start_planned(self) -> None:
        """Start what was planned, viewers first."""
        async with self._starting:
            while self._planned and not self._closing:
                plan = next((each for each in self._planned if each.is_viewer), self._planned[0])
                self._planned.remove(plan)
                if plan.is_viewer:
                    await self._start_viewer(plan)
                else:
                    self._start_node(plan)

    def show_findings(self, findings: list[Diagnostic]) -> None:
        """Show in the viewers what is wrong with the model files now."""
        self._findings = findings
        for _, viewer in self._viewers.values():
            viewer.show_diagnostics(findings)

    def stop_matching(self, matcher: Callable[[ExecuteProcess], bool]) -> None:
        """End the nodes whose actions a matcher accepts, as a signal would end their processes."""
        for plan, running in tuple(self._running.values()):
            if matcher(plan.action):
                self._stop_node(plan, running)
        for plan, viewer in tuple(self._viewers.values()):
            if matcher(plan.action):
                del self._viewers[plan.process_name]
                self._session.spawn(self._stop_viewer(plan, viewer))

    def close_nodes(self) -> None:
        """End all nodes, and begin to end the viewers."""
        self._closing = True
        self.forget_planned()
        self.stop_matching(lambda _: True)

    async def close(self) -> None:
        """End everything."""
        self.close_nodes()
        for plan, viewer in tuple(self._viewers.values()):
            await self._stop_viewer(plan, viewer)
        if self._graph is not None:
            await self._graph.close()

    # --- nodes ----------------------------------------------------------------------------------------------

    def _start_node(self, plan: HostedPlan) -> None:
        from linkwright.nodes import EXECUTABLES, NodeOptions

        session = self._session
        self._speaking = plan.process_name
        session.log.say(plan.process_name, "started in the launcher's process")
        try:
            running = EXECUTABLES[(plan.package, plan.executable)](
                self._the_graph(),
                NodeOptions(
                    name=plan.node_name,
                    namespace=plan.namespace,
                    parameters=plan.parameters,
                    remappings=plan.remappings,
                    arguments=plan.arguments,
                    library=session.descriptions.library,
                ),
            )
        except LinkwrightError as error:
            self._not_started(plan, error)
            return
        finally:
            self._speaking = "launch"
        self._running[plan.process_name] = plan, running
        self._process_of_logger[running.node.get_logger().name] = plan.process_name
        self._bind_descriptions(plan, running)
        for _, viewer in self._viewers.values():
            _attach_panel(viewer, running)
        self._started(plan)

    def _not_started(self, plan: HostedPlan, error: LinkwrightError) -> None:
        """Tell why; a node whose model file is wrong is started as soon as that is repaired."""
        session = self._session
        found = self._description_of(plan)
        if found is None or session.ending:
            session.fail(plan)
            session.log.diagnostics(error.diagnostics)
            session.log.complain(plan.process_name, "node has not started")
            session.emit(events.ProcessExited(action=plan.action, returncode=1, **plan.details))
            return
        name, call = found
        session.fail(call)

        def again(text: str) -> None:
            session.reload.unbind(call, again)
            session.mend(call)
            plan.parameters[name] = text
            self._start_node(plan)

        session.reload.bind(call, again)
        session.reload.report(call, error.diagnostics)

    def _bind_descriptions(self, plan: HostedPlan, running: RunningNode) -> None:
        """Give the node every new text of its descriptions, and show what is remarkable about the first."""
        session = self._session
        for name, value in plan.parameters.items():
            call = session.descriptions.call_of(value) if isinstance(value, str) else None
            if call is not None:
                session.reload.bind(call, lambda text, name=name: self._set(plan, running, name, text))  # type: ignore[misc]
            if name == _DESCRIPTION and plan.package == "robot_state_publisher":
                reading = session.descriptions.library.read(value)
                warnings = session.descriptions.warnings_of(call) if call else ()
                session.reload.report(call or plan.process_name, (*warnings, *reading.diagnostics))

    def _set(self, plan: HostedPlan, running: RunningNode, name: str, text: str) -> None:
        from linkwright.graph import Parameter

        if plan.process_name not in self._running:
            return
        self._speaking = plan.process_name
        try:
            result = running.node.set_parameters([Parameter(name, value=text)])[0]
        finally:
            self._speaking = "launch"
        if not result.successful:
            raise LinkwrightError(Diagnostic("LAUNCH143", f"'{plan.process_name}' refuses the model: {result.reason}"))

    def _description_of(self, plan: HostedPlan) -> tuple[str, XacroCall] | None:
        for name, value in plan.parameters.items():
            call = self._session.descriptions.call_of(value) if isinstance(value, str) else None
            if call is not None:
                return name, call
        return None

    def _stop_node(self, plan: HostedPlan, running: RunningNode) -> None:
        del self._running[plan.process_name]
        running.close()
        self._ended(plan)

    # --- viewers --------------------------------------------------------------------------------------------

    async def _start_viewer(self, plan: HostedPlan) -> None:
        from linkwright.viewer import Viewer

        session = self._session
        self._speaking = plan.process_name
        node_name = plan.node_name or plan.executable
        try:
            if plan.viewer_config is not None:
                config, findings = plan.viewer_config(), list[Diagnostic]()
            else:
                config, findings = read_viewer_config(plan.arguments)
            session.log.diagnostics(findings)
            viewer = Viewer(
                self._the_graph(),
                library=session.descriptions.library,
                finder=session.finder,
                config=config,
                host=session.options.host,
                port=session.options.port,
                title=session.options.title,
                name=node_name,
                namespace=plan.namespace,
                remappings=plan.remappings,
            )
            await viewer.start()
        except LinkwrightError as error:
            session.fail(plan)
            session.log.diagnostics(error.diagnostics)
            session.emit(events.ProcessExited(action=plan.action, returncode=1, **plan.details))
            session.emit(events.Shutdown(reason="the viewer has not started"))
            return
        finally:
            self._speaking = "launch"
        self._viewers[plan.process_name] = plan, viewer
        self._process_of_logger[".".join([*plan.namespace.strip("/").split("/"), node_name]).lstrip(".")] = (
            plan.process_name
        )
        session.log.announce(f"Viewer: {viewer.url}")
        if session.options.open_browser:
            _open_in_browser(viewer.url)
        session.log.say(
            plan.process_name, "started in the launcher's process: the viewer in the browser stands in for RViz"
        )
        viewer.show_diagnostics([*self._findings, *findings])
        for _, running in self._running.values():
            _attach_panel(viewer, running)
        self._started(plan)

    async def _stop_viewer(self, plan: HostedPlan, viewer: Viewer) -> None:
        self._viewers.pop(plan.process_name, None)
        try:
            await asyncio.wait_for(viewer.close(), _CLOSE_SECONDS)
        except asyncio.TimeoutError:
            self._session.log.caution(plan.process_name, "a browser did not let go of its connection in time")
        self._ended(plan)

    # --- both -----------------------------------------------------------------------------------------------

    def _started(self, plan: HostedPlan) -> None:
        plan.action.process_details = plan.details
        self._session.emit(events.ProcessStarted(action=plan.action, **plan.details))

    def _ended(self, plan: HostedPlan) -> None:
        self._session.log.say(plan.process_name, "has finished cleanly")
        self._session.emit(events.ProcessExited(action=plan.action, returncode=0, **plan.details))

    def _the_graph(self) -> Graph:
        if self._graph is None:
            from linkwright.graph import Graph

            self._graph = Graph(on_log=self._on_log)
        return self._graph

    def _on_log(self, record: LogRecord) -> None:
        process = self._process_of_logger.get(record.node, self._speaking)
        self._session.log.node_record(process, record)


def _attach_panel(viewer: Viewer, running: RunningNode) -> None:
    panel = getattr(running, "panel", None)
    if panel is not None:
        viewer.attach_joint_panel(panel)


def _open_in_browser(url: str) -> None:
    """Open the page; in a thread, because some browsers take their time to answer.

    Not where there is no display: a browser for the terminal would take ours.
    """
    displays = ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")
    if sys.platform.startswith("linux") and not any(os.environ.get(name) for name in displays):
        return
    import webbrowser

    threading.Thread(target=webbrowser.open, args=(url,), name="linkwright-browser", daemon=True).start()
