"""A view of one robot description with sliders for its joints, without a launch file."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Callable, Coroutine, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import LinkwrightError
from linkwright.hosting.argument_form import create_argument_form
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

_PUBLISH_FREQUENCY_HZ = 60.0
"""The rate in Hz. At the default of robot_state_publisher, 20 Hz, a dragged slider lags visibly."""
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
        model_path: the path of the URDF or xacro file.
        arguments: maps the names of xacro arguments to their values; None for no arguments.
        options: the options of nodes and viewers; None for defaults with which other programs do not discover the
            nodes.
        foxglove: the port to which Foxglove and Lichtblick can connect; None to open no port.

    Returns:
        The exit status, see `linkwright.hosting.signals.run_to_end`.
    """
    path = Path(model_path).absolute()
    call = XacroCall(path, tuple((arguments or {}).items()))
    finder = PackageFinder(start=[path.parent, Path.cwd()])
    options = replace(options or HostOptions(network=False), title=path.name)
    log = LaunchLog()

    def run(signals: SignalWatch) -> bool:
        async def run_on_loop() -> bool:
            signals.session = view = ModelView(call, finder, options, log)
            return await view.run(foxglove)

        return signals.run(run_on_loop)

    return run_to_end(run, finder, log)


class ModelView:
    """The view of one description on the running event loop.

    Its nodes are robot_state_publisher, the sliders and the viewer.

    Args:
        call: the description file and its arguments.
        finder: the finder of ROS packages.
        options: the options of nodes and viewers.
        log: the log of the run.
        descriptions: reads and stores the description; None for robot descriptions.

    Attributes:
        is_ending: whether the view is ending.
        is_blocking: whether the description is being expanded, which blocks the event loop.
        has_processes: always False.
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
        self.descriptions = descriptions or Descriptions(finder, reads_unsaved=True)
        self.loop: asyncio.AbstractEventLoop | None = None
        self.is_ending = False
        self.is_blocking = False
        self._call = call
        self._text: str | None = None
        self._viewer: Viewer | None = None
        self._form: ArgumentForm | None = None
        self._failures: set[object] = set()
        self._tasks: set[asyncio.Task[Any]] = set()
        self._end_event = asyncio.Event()
        self._has_logged_start = False
        self._exception: BaseException | None = None
        self._recorder: Recorder | None = None
        self._process_numbers = count(1)
        self.host = NodeHost(self)
        self.reload = LiveReload(self.descriptions, self.host.show_findings, log)

    async def run(self, foxglove: int | None, writer: BagWriter | None = None) -> bool:
        """Show the description until the user ends the view, or a viewer cannot start.

        Return whether there were no failures.

        Args:
            foxglove: the port to which Foxglove and Lichtblick can connect; None to open no port.
            writer: writes a recording of all topics, with the times of ``/clock``; None for no recording.
        """
        self.loop = asyncio.get_running_loop()
        try:
            if writer is not None:
                self._recorder = self._create_recorder(writer)
            if self._plan_description():
                self._plan_other_nodes()
                if foxglove is not None:
                    self._plan_node("foxglove_bridge", "foxglove_bridge", {"port": foxglove})
                await self.host.serve_pages()
                if not self._end_event.is_set():
                    await self.host.start_planned()
                    self.reload.start()
            await self._end_event.wait()
            self._end_recording()  # The recording must end before the nodes are closed, which takes time.
            self.is_ending = True
            self.reload.close()
            self.host.close_nodes()
            while self._tasks:
                await asyncio.wait(self._tasks)
        finally:
            self._end_recording()
            await self._close()
        if self._exception is not None:
            raise self._exception
        return not self._failures

    def _create_recorder(self, writer: BagWriter) -> Recorder:
        """Return a recorder of all topics and services.

        If writing fails, for example because the disk is full, the error is logged, and only the recording ends.
        """
        from linkwright.bag import Recorder, TopicSelection

        def guard(callback: Callable[..., object]) -> Callable[..., object]:
            def guarded_callback(*arguments: Any) -> None:
                if self._end_event.is_set() or writer in self._failures:
                    return
                try:
                    callback(*arguments)
                except LinkwrightError as error:
                    self.log.write_diagnostics(error.diagnostics)
                    self.fail(writer)
                    asyncio.get_running_loop().call_soon(self._end_recording)
                    asyncio.get_running_loop().call_soon(node.destroy_node)

            return guarded_callback

        node = self.host.graph.create_node(
            "rosbag2_recorder", parameters={"use_sim_time": True}, start_parameter_services=False
        )
        return Recorder(node, TopicSelection(all_topics=True, all_services=True), writer, wrap_callback=guard)

    def _end_recording(self) -> None:
        recorder, self._recorder = self._recorder, None
        if recorder is not None:
            try:
                recorder.close()
            except LinkwrightError as error:
                self.log.write_diagnostics(error.diagnostics)
                self.fail(recorder)

    # --- the description --------------------------------------------------------------------------------------

    def _plan_description(self) -> bool:
        """Plan the publication of the description.

        If its file is invalid, the description is published when the file has been fixed.

        Return whether the view can continue.
        """
        self.is_blocking = True
        try:
            self._text = self.descriptions.expand(self._call)
            self.reload.report(self._call, self.descriptions.get_warnings(self._call))
        except DescriptionError as error:
            self.fail(self._call)
            if not error.is_missing:
                self.reload.bind(self._call, self._plan_fixed_description)
                self.reload.report(self._call, error.diagnostics)
                self.spawn(self._request_arguments(self._call, error))
                return True
            self.log.write_diagnostics(error.diagnostics)
            self.shut_down("there is no model")
            return False
        except KeyboardInterrupt:
            self.interrupt("user interrupted with ctrl-c (SIGINT)")
            return False
        finally:
            self.is_blocking = False
        parameters = {"robot_description": self._text, "publish_frequency": _PUBLISH_FREQUENCY_HZ}
        self._plan_node("robot_state_publisher", "robot_state_publisher", parameters, owner=self._call)
        return True

    def _plan_other_nodes(self) -> None:
        """Plan the remaining nodes: the sliders and the viewer."""
        self._plan_node("joint_state_publisher_gui", "joint_state_publisher_gui")
        self._plan_node(
            *VIEWER, name="viewer", viewer_config=self._create_viewer_config, viewer_started=self._set_viewer
        )

    def _set_viewer(self, viewer: Viewer) -> None:
        self._viewer = viewer
        self._show_form()
        if self.options.follows_editor:
            from linkwright.hosting.text_editor import TextEditorConnection

            TextEditorConnection(viewer, partial(self.shut_down, "the text editor has ended"))

    def _plan_fixed_description(self, _: str) -> None:
        self._replace_description(self._call)

    def _replace_description(self, call: XacroCall) -> None:
        """Publish another description in place of the current one.

        Its file has been fixed, its arguments have changed, or it is another file.
        """
        previous_call, self._call, self._form, self._text = self._call, call, None, None
        self.host.stop_matching(lambda owner: owner is previous_call)
        self.reload.forget(previous_call)
        self.clear_failure(previous_call)
        self._show_form()
        self._plan_description()
        self._set_fixed_frame()
        self.spawn(self.host.start_planned())

    async def _request_arguments(self, call: XacroCall, error: DescriptionError) -> None:
        """Show a form in the pages if the error can be fixed by values of arguments."""
        form = await asyncio.to_thread(create_argument_form, call, self.finder, error.diagnostics)
        if form is not None and call is self._call and self._text is None:
            self._form = form
            self._show_form()

    def _show_form(self) -> None:
        from linkwright.page.protocol.description import NO_ARGUMENT_FORM
        from linkwright.panels.description import ArgumentsFeature

        if self._viewer is not None:
            feature = self._viewer.add_feature(ArgumentsFeature)
            feature.show_form(self._form or NO_ARGUMENT_FORM, self._set_arguments)

    def _set_arguments(self, values: dict[str, str]) -> None:
        self._replace_description(XacroCall(self._call.path, tuple(values.items())))

    def _set_fixed_frame(self) -> None:
        """Set the Fixed Frame to the root link, unless the current frame is a link of the robot."""
        robot = None if self._text is None else self.descriptions.library.read(self._text).robot
        manager = None if self._viewer is None else self._viewer.managers.shared
        if robot is not None and manager is not None and manager.fixed_frame not in robot.links:
            manager.set_fixed_frame(robot.root)

    def _plan_node(
        self,
        package: str,
        executable: str,
        parameters: dict[str, Any] | None = None,
        *,
        name: str | None = None,
        viewer_config: Callable[[], RvizConfig] | None = None,
        viewer_started: Callable[[Viewer], object] | None = None,
        output: str = "log",
        waits_for_fix: bool = True,
        owner: object = None,
        arguments: Sequence[str] = (),
    ) -> None:
        config_path = self.options.rviz
        if viewer_config is not None and config_path is not None:
            viewer_config = partial(_load_config, config_path)
        plan = HostedPlan(
            owner or self,
            f"{name or executable}-{next(self._process_numbers)}",
            package,
            executable,
            name,
            "/",
            parameters or {},
            arguments=list(arguments),
            viewer_config=viewer_config,
            viewer_started=viewer_started,
            destinations=output_destinations(output),
            waits_for_fix=waits_for_fix,
        )
        self.host.schedule_node(plan)

    @property
    def _config_name(self) -> str:
        """The name under which unsaved edits of the viewer's configuration are stored."""
        return str(self._call.path)

    def _create_viewer_config(self) -> RvizConfig:
        """Return a configuration with the displays Grid, RobotModel and TF.

        The Fixed Frame is the root link.

        TF is enabled only if the robot has no visuals.
        """
        from linkwright.rviz import RvizConfig, estimate_size, has_visuals

        library = self.descriptions.library
        robot = None if self._text is None else library.read(self._text).robot
        frame = robot.root if robot is not None else _find_first_link(self._call.path)
        size = estimate_size(robot) if robot is not None else None
        finder = library.packages(self._text or "") or self.finder
        shows_frames = robot is not None and not has_visuals(robot, finder)
        return RvizConfig.for_model(frame, size=size, frames=shows_frames, name=self._config_name)

    # --- interface for nodes and signals ------------------------------------------------------------------------

    def fail(self, failure: object) -> None:
        """Record a failure, which sets the exit status to 1 unless it is cleared."""
        self._failures.add(failure)

    def clear_failure(self, failure: object) -> None:
        """Clear a failure whose cause has been fixed."""
        self._failures.discard(failure)

    def postpones(self, plan: HostedPlan) -> bool:
        """Return False, because a view has no processes for which a node would have to wait."""
        return False

    def spawn(self, coroutine: Coroutine[Any, Any, None]) -> None:
        """Run a coroutine in the background.

        The view does not close before it has finished.
        """
        task = asyncio.get_running_loop().create_task(coroutine)
        self._tasks.add(task)
        task.add_done_callback(self._handle_task_end)

    def _handle_task_end(self, task: asyncio.Task[Any]) -> None:
        self._tasks.discard(task)
        if not task.cancelled() and task.exception() is not None:
            self._exception = task.exception()
            self._end_event.set()

    def report_node_start(self, plan: HostedPlan) -> None:
        """Log the first lines of the log when the first node starts.

        If an error keeps all nodes from starting, only that error is printed.
        """
        if not self._has_logged_start:
            self._has_logged_start = True
            self.log.begin()

    def report_node_end(self, plan: HostedPlan, status: int) -> None:
        """Do nothing, because the view continues without its nodes."""

    def interrupt(self, reason: str) -> None:
        """End the view because the user interrupted it."""
        self.log.write_warning("launch", reason)
        self._end_event.set()

    def shut_down(self, reason: str) -> None:
        """End the view, without starting the nodes that are still planned."""
        self.host.discard_planned()
        self._end_event.set()

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


def _load_config(rviz: Path) -> RvizConfig:
    from linkwright.rviz import RvizConfig

    return RvizConfig.load(rviz)


def _find_first_link(path: Path) -> str:
    """Return the first link in the text of an invalid description, which is usually the root.

    If there is none, return ``base_link``.
    """
    try:
        match = _FIRST_LINK.search(path.read_text(encoding="utf-8", errors="replace"))
    except OSError:
        match = None
    return match.group(1) if match else "base_link"
