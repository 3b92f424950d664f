"""The view of a recording, in a separate graph and with a timeline in the page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.bag import BagReader, Playback
from linkwright.graph import Node
from linkwright.hosting.launch_log import LaunchLog
from linkwright.hosting.plans import VIEWER, HostOptions
from linkwright.hosting.signals import SignalWatch, run_to_end
from linkwright.hosting.view import ModelView
from linkwright.hosting.xacro_calls import XacroCall
from linkwright.packages import PackageFinder

if TYPE_CHECKING:
    from linkwright.rviz import RvizConfig
    from linkwright.urdf import Robot
    from linkwright.viewer import Viewer


def run_bag_view(files: Sequence[Path], options: HostOptions, *, foxglove: int | None = None) -> int:
    """Show a recording until the user ends the view.

    Args:
        files: the folder of the recording, or its files.
        options: the options of nodes and viewers.
        foxglove: the port to which Foxglove and Lichtblick can connect; None to open no port.

    Returns:
        The exit status, see `linkwright.hosting.signals.run_to_end`.

    Raises:
        LinkwrightError: the recording cannot be read, see `linkwright.bag.BagReader`.
    """
    path, *other_files = (file.absolute() for file in files)
    finder = PackageFinder(start=[path.parent, Path.cwd()])
    options = replace(options, title=path.name, history=0)
    log = LaunchLog()

    def run(signals: SignalWatch) -> bool:
        async def run_on_loop() -> bool:
            signals.session = view = BagView(bag, finder, options, log)
            return await view.run(foxglove)

        return signals.run(run_on_loop)

    with BagReader(path, files=[path, *other_files] if other_files else ()) as bag:
        return run_to_end(run, finder, log)


class BagView(ModelView):
    """The view of a recording on the running event loop, with a player and a viewer.

    Args:
        bag: the recording.
        finder: the finder of the packages of the robots in the recording.
        options: the options of nodes and viewers.
        log: the log of the run.
    """

    def __init__(self, bag: BagReader, finder: PackageFinder, options: HostOptions, log: LaunchLog) -> None:
        super().__init__(XacroCall(bag.path, ()), finder, options, log)
        self._bag = bag

    def _plan_description(self) -> bool:
        """Prepare the topics of the recording, and return whether the view can continue."""
        self.log.write_diagnostics(self._bag.findings)
        from linkwright.viewer.recorded_robot import publish_recording

        self._output = publish_recording(self._bag, self._player, self._robot)
        return True

    @cached_property
    def _robot(self) -> Robot | None:
        from linkwright.viewer.recorded_robot import read_robot

        return read_robot(self._bag, self.descriptions.library)

    @cached_property
    def _player(self) -> Node:
        return self.host.graph.create_node("rosbag2_player", start_parameter_services=False)

    def _plan_other_nodes(self) -> None:
        self._plan_node(
            *VIEWER,
            {"use_sim_time": True},
            name="viewer",
            viewer_config=self._create_viewer_config,
            viewer_started=self._attach,
        )

    def _attach(self, viewer: Viewer) -> None:
        playback = Playback(self._player.handle, self._bag, self._output, viewer.on_playback_error)
        viewer.attach_recording(playback, self._bag)

    def _create_viewer_config(self) -> RvizConfig:
        from linkwright.viewer.recording_config import create_recording_config

        return create_recording_config(self._bag, self._robot)
