"""The classroom, a page with a course, the learner's files and robot, and a terminal."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.hosting.launch_log import LaunchLog
from linkwright.hosting.plans import HostOptions
from linkwright.hosting.signals import SignalWatch, run_to_end
from linkwright.hosting.view import ModelView
from linkwright.hosting.xacro_calls import XacroCall
from linkwright.learning.classroom import Classroom
from linkwright.packages import PackageFinder

if TYPE_CHECKING:
    from linkwright.viewer import Viewer


def run_classroom(classroom: Classroom, options: HostOptions, *, foxglove: int | None = None) -> int:
    """Serve the page with a course until the user ends the program.

    Args:
        classroom: the course in the learner's workspace; the workspace's folder must exist.
        options: the options of nodes and viewers.
        foxglove: the port to which Foxglove and Lichtblick can connect; None to open no port.

    Returns:
        The exit status (see `linkwright.hosting.signals.run_to_end`).
    """
    finder = PackageFinder(start=[classroom.workspace])
    options = replace(options, title=classroom.workspace.name, terminal=classroom.workspace, needs_terminal=True)
    log = LaunchLog()

    def run(signals: SignalWatch) -> bool:
        async def run_on_loop() -> bool:
            signals.session = view = ClassroomView(classroom, finder, options, log)
            return await view.run(foxglove)

        return signals.run(run_on_loop)

    return run_to_end(run, finder, log)


class ClassroomView(ModelView):
    """A view of the robot of the shown step of a course, on the running event loop.

    The robot is shown as soon as its file exists.

    Args:
        classroom: the course in the learner's workspace.
        finder: the finder of ROS packages.
        options: the options of nodes and viewers.
        log: the log of the run.
    """

    def __init__(self, classroom: Classroom, finder: PackageFinder, options: HostOptions, log: LaunchLog) -> None:
        shown = classroom.find_shown_file(classroom.current_step)
        super().__init__(XacroCall(shown or classroom.workspace), finder, options, log)
        self._classroom = classroom
        self._is_shown = False

    def show(self, path: Path | None) -> None:
        """Show a robot's file, unless it is shown already or does not exist yet."""
        if path is None or not path.is_file() or (self._is_shown and path == self._call.path):
            return
        self.finder.clear_cache()
        self._replace_description(XacroCall(path))

    def _plan_description(self) -> bool:
        self._is_shown = self._call.path.is_file()
        return not self._is_shown or super()._plan_description()

    @property
    def _config_name(self) -> str:
        """The name of the view's configuration: the workspace, because the robot's file changes."""
        return str(self._classroom.workspace)

    def _set_viewer(self, viewer: Viewer) -> None:
        from linkwright.learning.page.course_guide import CourseGuide
        from linkwright.learning.page.feature import CourseFeature
        from linkwright.panels.source_editor.feature import SourceEditorFeature
        from linkwright.panels.terminal.feature import TerminalFeature

        super()._set_viewer(viewer)
        viewer.add_feature(SourceEditorFeature).edit_workspace(self._classroom.workspace)
        context = viewer.context
        programs = viewer.add_feature(TerminalFeature).programs
        guide = CourseGuide(self._classroom, context.pages.publish, context.node.get_logger(), self.show, programs)
        viewer.add_feature(CourseFeature).show(guide)
