"""The view of two descriptions in one scene.

The old description is translucent.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from linkwright.hosting.launch_log import LaunchLog
from linkwright.hosting.plans import VIEWER, HostOptions
from linkwright.hosting.reload import LiveReload
from linkwright.hosting.signals import SignalWatch, run_to_end
from linkwright.hosting.view import ModelView
from linkwright.hosting.xacro_calls import DescriptionError, Descriptions, XacroCall

if TYPE_CHECKING:
    from linkwright.descriptions import Description, DescriptionLibrary
    from linkwright.descriptions.pairs import Model, Pair
    from linkwright.diagnostics import Diagnostic
    from linkwright.packages import PackageFinder
    from linkwright.rviz import RvizConfig
    from linkwright.viewer import Viewer


def run_compared_view(pair: Pair, options: HostOptions, *, foxglove: int | None = None) -> int:
    """Show two descriptions in one scene, with their differences, until the user ends the view.

    Args:
        pair: the two descriptions, which the caller closes.
        options: the options of nodes and viewers.
        foxglove: the port to which Foxglove and Lichtblick can connect; None to open no port.

    Returns:
        The exit status, see `linkwright.hosting.signals.run_to_end`.

    Raises:
        LinkwrightError: the old description comes from a commit, and cannot be read.
    """
    options = replace(options, title=f"{pair.old.title} → {pair.new.title}")
    log = LaunchLog()
    if pair.old.commit is not None:
        pair.old.read()  # The user cannot fix a version in a commit while the view is shown.

    def run(signals: SignalWatch) -> bool:
        async def run_on_loop() -> bool:
            signals.session = view = ComparedView(pair, options, log)
            return await view.run(foxglove)

        return signals.run(run_on_loop)

    return run_to_end(run, pair.new.finder, log)


class ComparedView(ModelView):
    """The view of two descriptions on the running event loop.

    Both descriptions are reloaded when their files change.

    Args:
        pair: the two descriptions.
        options: the options of nodes and viewers.
        log: the log of the run.
    """

    def __init__(self, pair: Pair, options: HostOptions, log: LaunchLog) -> None:
        super().__init__(_to_xacro_call(pair.new), pair.new.finder, options, log)
        self._pair = pair
        self._old_call = _to_xacro_call(pair.old)
        self._old = _OldDescriptions(pair.old.finder, self.descriptions.library)
        self.reload = LiveReload(self.descriptions, self._show_findings, log)
        self._old_reload = LiveReload(self._old, self._show_findings, log)

    def _plan_description(self) -> bool:
        if self._pair.old.path.is_file():
            return super()._plan_description()
        self._read_old()  # logs the error
        self.shut_down("there is no model")
        return False

    def _plan_other_nodes(self) -> None:
        self._plan_node("joint_state_publisher_gui", "joint_state_publisher_gui")
        self._plan_node(*VIEWER, name="viewer", viewer_config=self._create_viewer_config, viewer_started=self._attach)

    def _create_viewer_config(self) -> RvizConfig:
        from linkwright.panels.comparison.feature import add_old_robot

        config = super()._create_viewer_config()
        add_old_robot(config, self._pair.old.title)
        return config

    def _attach(self, viewer: Viewer) -> None:
        node = self.host.graph.create_node(
            "old_robot_state_publisher", start_parameter_services=False, stays_inside=True
        )
        publish = viewer.attach_comparison(self._pair, node)

        def publish_old(text: str) -> None:
            self.clear_failure(self._old_call)
            publish(text)

        text = self._read_old()
        if text is not None:
            publish_old(text)
        if self._pair.old.commit is None:
            self._old_reload.bind(self._old_call, publish_old)
            self._old_reload.start()

    def _read_old(self) -> str | None:
        """Return the text of the old description, or report the errors and return None."""
        try:
            text = self._old.expand(self._old_call)
        except DescriptionError as error:
            self.fail(self._old_call)
            self._old_reload.report(self._old_call, error.diagnostics)
            return None
        self._old_reload.report(self._old_call, self._old.get_warnings(self._old_call))
        return text

    def _show_findings(self, _: list[Diagnostic]) -> None:
        self.host.show_findings([*self.reload.findings(), *self._old_reload.findings()])

    async def _close(self) -> None:
        self._old_reload.close()
        await super()._close()


class _OldDescriptions(Descriptions):
    """Descriptions whose texts differ from the new file's texts, even if both files are equal."""

    def __init__(self, finder: PackageFinder, library: DescriptionLibrary) -> None:
        super().__init__(finder, reads_unsaved=True)
        self._library = library

    def store(self, call: XacroCall, description: Description, text: str | None = None) -> str:
        """Store a description, and return the text that identifies it."""
        from linkwright.descriptions.pairs import make_old_description_key

        return super().store(call, description, make_old_description_key(description) if text is None else text)


def _to_xacro_call(model: Model) -> XacroCall:
    return XacroCall(model.path, tuple(model.values.items()))
