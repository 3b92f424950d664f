"""The view of one model file with sliders for its joints, which needs no launch file."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Callable, Coroutine, Mapping
from dataclasses import replace
from functools import partial
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import LinkwrightError
from linkwright.hosting.argument_form import argument_form
from linkwright.hosting.launch_log import LaunchLog, output_destinations
from linkwright.hosting.node_host import NodeHost
from linkwright.hosting.plans import VIEWER, HostedPlan, HostOptions
from linkwright.hosting.reload import LiveReload
from linkwright.hosting.signals import SignalWatch, run_to_end
from linkwright.hosting.xacro_calls import DescriptionError, Descriptions, XacroCall
from linkwright.packages import PackageFinder

if TYPE_CHECKING:
    from linkwright.bag import BagWriter, Recorder
    from linkwright.page.protocol.description import ArgumentForm
    from linkwright.rviz import RvizConfig
    from linkwright.viewer import Viewer

_PUBLISH_FREQUENCY = 60.0
"""Hz; at robot_state_publisher's default of 20 a dragged slider lags visibly."""
_FIRST_LINK = re.compile(r"""<link\s[^>]*?\bname\s*=\s*["']([^"'$]+)["']""")


def run_view(
    model_path: str | Path,
    arguments: Mapping[str, str] | None = None,
    options: HostOptions | None = None,
    *,
    foxglove: int | None = None,
) -> int:
    """Show a URDF or xacro file, with sliders for its joints, until the user ends the view.

    Args:
        model_path: the file.
        arguments: name -> value of the xacro arguments.
        options: the options of nodes and viewers; by default no other program discovers the nodes.
        foxglove: a port for Foxglove and Lichtblick to connect to; None for none.

    Returns:
        The exit status, see `linkwright.hosting.signals.run_to_end`.
    """
    path = Path(model_path).absolute()
    call = XacroCall(path, tuple((arguments or {}).items()))
    finder = PackageFinder(start=[path.parent, Path.cwd()])
    options = replace(options or HostOptions(network=False), title=path.name)
    log = LaunchLog()

    def run(signals: SignalWatch) -> bool:
        async def show() -> bool:
            signals.session = view = ModelView(call, finder, options, log)
            return await view.run(foxglove)

        return signals.run(show)

    return run_to_end(run, finder, log)


class ModelView:
    """The view of one model on the running event loop: robot_state_publisher, sliders and the viewer.

    Args:
        call: the model file and its arguments.
        finder: finds packages.
        options: the options of nodes and viewers.
        log: the log of the run.
        descriptions: reads models; by default robots.

    Attributes:
        ending: whether the view is about to end.
        visiting: whether the model is being expanded, which blocks the event loop.
        has_processes: always false.
    """

    has_processes = False

    def __init__(
        self,
        call: XacroCall,
        finder: PackageFinder,
        options: HostOptions,
        log: LaunchLog,
        descriptions: Descriptions | None = None,
    ) -> None:
        self.finder = finder
        self.options = options
        self.log = log
        self.descriptions = descriptions or Descriptions(finder)
        self.loop: asyncio.AbstractEventLoop | None = None
        self.ending = False
        self.visiting = False
        self._call = call
        self._text: str | None = None
        self._viewer: Viewer | None = None
        self._form: ArgumentForm | None = None
        self._failures: set[object] = set()
        self._tasks: set[asyncio.Task[Any]] = set()
        self._is_over = asyncio.Event()
        self._has_begun = False
        self._crash: BaseException | None = None
        self._recorder: Recorder | None = None
        self._numbers = count(1)
        self.host = NodeHost(self)
        self.reload = LiveReload(self.descriptions, self.host.show_findings, log)

    async def run(self, foxglove: int | None, writer: BagWriter | None = None) -> bool:
        """Show the model until the user ends the view, or a viewer cannot start.

        Return whether everything succeeded.

        Args:
            foxglove: a port for Foxglove and Lichtblick to connect to; None for none.
            writer: records all topics, with the times of ``/clock``; None for no recording.
        """
        self.loop = asyncio.get_running_loop()
        try:
            if writer is not None:
                self._recorder = self._recording(writer)
            if self._publish():
                self._plan_others()
                if foxglove is not None:
                    self._plan("foxglove_bridge", "foxglove_bridge", {"port": foxglove})
                await self.host.serve_pages()
                if not self._is_over.is_set():
                    await self.host.start_planned()
                    self.reload.start()
            await self._is_over.wait()
            self._end_recording()  # The recording must end before the rest, which takes time.
            self.ending = True
            self.reload.close()
            self.host.close_nodes()
            while self._tasks:
                await asyncio.wait(self._tasks)
        finally:
            self._end_recording()
            await self._close()
        if self._crash is not None:
            raise self._crash
        return not self._failures

    def _recording(self, writer: BagWriter) -> Recorder:
        """Return a recorder.

        If the disk is full, the error is logged and the recording ends. The view continues, and its exit status is 1.
        """
        from linkwright.bag import Recorder, TopicSelection

        def guarded(callback: Callable[..., object]) -> Callable[..., object]:
            def call(*arguments: Any) -> None:
                if self._is_over.is_set() or writer in self._failures:
                    return
                try:
                    callback(*arguments)
                except LinkwrightError as error:
                    self.log.diagnostics(error.diagnostics)
                    self.fail(writer)
                    asyncio.get_running_loop().call_soon(self._end_recording)
                    asyncio.get_running_loop().call_soon(node.destroy_node)

            return call

        node = self.host.graph.create_node(
            "rosbag2_recorder", parameters={"use_sim_time": True}, start_parameter_services=False
        )
        return Recorder(node, TopicSelection(everything=True, every_service=True), writer, guarded=guarded)

    def _end_recording(self) -> None:
        recorder, self._recorder = self._recorder, None
        if recorder is not None:
            try:
                recorder.close()
            except LinkwrightError as error:
                self.log.diagnostics(error.diagnostics)
                self.fail(recorder)

    # --- what is shown ----------------------------------------------------------------------------------------

    def _publish(self) -> bool:
        """Plan the publication of the model, now or as soon as its file is valid.

        Return whether the view continues.
        """
        self.visiting = True
        try:
            self._text = self.descriptions.expand(self._call)
            self.reload.report(self._call, self.descriptions.warnings_of(self._call))
        except DescriptionError as error:
            self.fail(self._call)
            if not error.missing:
                self.reload.bind(self._call, self._publish_repaired)
                self.reload.report(self._call, error.diagnostics)
                self.spawn(self._request_arguments(self._call, error))
                return True
            self.log.diagnostics(error.diagnostics)
            self.shut_down("there is no model")
            return False
        except KeyboardInterrupt:
            self.interrupt("user interrupted with ctrl-c (SIGINT)")
            return False
        finally:
            self.visiting = False
        parameters = {"robot_description": self._text, "publish_frequency": _PUBLISH_FREQUENCY}
        self._plan("robot_state_publisher", "robot_state_publisher", parameters)
        return True

    def _plan_others(self) -> None:
        """Plan the other nodes: the sliders and the viewer."""
        self._plan("joint_state_publisher_gui", "joint_state_publisher_gui")
        self._plan(*VIEWER, name="viewer", viewer_config=self._viewer_config, viewer_started=self._set_viewer)

    def _set_viewer(self, viewer: Viewer) -> None:
        self._viewer = viewer
        self._show_form()

    def _publish_repaired(self, _: str) -> None:
        self._publish_again(self._call)

    def _publish_again(self, call: XacroCall) -> None:
        """Publish a model whose file was not valid before, or the same model with other arguments."""
        broken, self._call, self._form = self._call, call, None
        self.reload.unbind(broken, self._publish_repaired)
        self.reload.show(broken, ())
        self.clear_failure(broken)
        self._show_form()
        self._publish()
        self._set_fixed_frame()
        self.spawn(self.host.start_planned())

    async def _request_arguments(self, call: XacroCall, error: DescriptionError) -> None:
        """Show pages a form for arguments if the error is that arguments have no value."""
        form = await asyncio.to_thread(argument_form, call, self.finder, error.diagnostics)
        if form is not None and call is self._call and self._text is None:
            self._form = form
            self._show_form()

    def _show_form(self) -> None:
        from linkwright.page.protocol.description import NOTHING_ASKED
        from linkwright.panels.description import ArgumentsFeature

        if self._viewer is not None:
            feature = self._viewer.add_feature(ArgumentsFeature)
            feature.ask(self._form or NOTHING_ASKED, self._set_arguments)

    def _set_arguments(self, values: dict[str, str]) -> None:
        self._publish_again(XacroCall(self._call.path, tuple(values.items())))

    def _set_fixed_frame(self) -> None:
        """Set the Fixed Frame to the root link of the model, unless it is a link of the model already."""
        robot = None if self._text is None else self.descriptions.library.read(self._text).robot
        manager = None if self._viewer is None else self._viewer.managers.shared
        if robot is not None and manager is not None and manager.fixed_frame not in robot.links:
            manager.set_fixed_frame(robot.root)

    def _plan(
        self,
        package: str,
        executable: str,
        parameters: dict[str, Any] | None = None,
        *,
        name: str | None = None,
        viewer_config: Callable[[], RvizConfig] | None = None,
        viewer_started: Callable[[Viewer], object] | None = None,
        output: str = "log",
        waits: bool = True,
    ) -> None:
        rviz = self.options.rviz
        if viewer_config is not None and rviz is not None:
            viewer_config = partial(_config_of, rviz)
        plan = HostedPlan(
            self,
            f"{name or executable}-{next(self._numbers)}",
            package,
            executable,
            name,
            "/",
            parameters or {},
            viewer_config=viewer_config,
            viewer_started=viewer_started,
            destinations=output_destinations(output),
            waits=waits,
        )
        self.host.plan(plan)

    def _viewer_config(self) -> RvizConfig:
        """Return a configuration with Grid, RobotModel and TF, whose Fixed Frame is the root link.

        TF is enabled only if the model has no visuals.
        """
        from linkwright.rviz import RvizConfig, has_visuals, size_of

        library = self.descriptions.library
        robot = None if self._text is None else library.read(self._text).robot
        frame = robot.root if robot is not None else _first_link(self._call.path)
        size = size_of(robot) if robot is not None else None
        finder = library.packages(self._text or "") or self.finder
        frames = robot is not None and not has_visuals(robot, finder)
        return RvizConfig.for_model(frame, size=size, frames=frames, name=str(self._call.path))

    # --- interface for nodes and signals ------------------------------------------------------------------------

    def fail(self, what: object) -> None:
        """Record a failure of `what`: the exit status is 1 unless the failure is cleared."""
        self._failures.add(what)

    def clear_failure(self, what: object) -> None:
        """Clear the recorded failure of `what`, because it was fixed."""
        self._failures.discard(what)

    def spawn(self, work: Coroutine[Any, Any, None]) -> None:
        """Run a coroutine in the background; the view waits for it before it closes."""
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._done)

    def _done(self, task: asyncio.Task[Any]) -> None:
        self._tasks.discard(task)
        if not task.cancelled() and task.exception() is not None:
            self._crash = task.exception()
            self._is_over.set()

    def node_started(self, plan: HostedPlan) -> None:
        """Log the first lines of the log when the first node has started.

        If an error prevents all nodes from starting, only that error is printed.
        """
        if not self._has_begun:
            self._has_begun = True
            self.log.begin()

    def node_ended(self, plan: HostedPlan, status: int) -> None:
        """Do nothing, because this view continues without its nodes."""

    def interrupt(self, reason: str) -> None:
        """End the view at the user's request."""
        self.log.warning_line("launch", reason)
        self._is_over.set()

    def shut_down(self, reason: str) -> None:
        """End the view; planned nodes are not started any more."""
        self.host.forget_planned()
        self._is_over.set()

    def seconds_to_end(self) -> float:
        """Return 0, because there are no processes."""
        return 0.0

    def kill_all(self) -> None:
        """Do nothing, because there are no processes."""

    async def _close(self) -> None:
        self.reload.close()
        for task in tuple(self._tasks):
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        await self.host.close()
        self.log.close()


def _config_of(rviz: Path) -> RvizConfig:
    from linkwright.rviz import RvizConfig

    return RvizConfig.load(rviz)


def _first_link(path: Path) -> str:
    """Return the first link in the text of an invalid model, usually the root."""
    try:
        found = _FIRST_LINK.search(path.read_text(encoding="utf-8", errors="replace"))
    except OSError:
        found = None
    return found.group(1) if found else "base_link"
