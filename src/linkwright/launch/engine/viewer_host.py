"""The viewers of a launch, pages that stand in for RViz; the command line of ``rviz2``, as far as they obey it."""

from __future__ import annotations

import asyncio
import os
import sys
import threading
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Severity, did_you_mean, phrase
from linkwright.launch.model.plans import HostedPlan

if TYPE_CHECKING:
    from linkwright.graph import Graph
    from linkwright.launch.engine.supervisor import Supervisor
    from linkwright.nodes import RunningNode
    from linkwright.viewer import RvizConfig, Viewer


_CLOSE_SECONDS = 0.8


class ViewerHost:
    """Starts, holds and ends viewers."""

    def __init__(self, session: Supervisor) -> None:
        self._session = session
        self._viewers: dict[str, tuple[HostedPlan, Viewer]] = {}
        self._findings: list[Diagnostic] = []

    def __bool__(self) -> bool:
        return bool(self._viewers)

    def plans(self) -> Iterator[HostedPlan]:
        """The plans of those that run."""
        return iter([plan for plan, _ in self._viewers.values()])

    def show_findings(self, findings: list[Diagnostic]) -> None:
        """Show what is wrong with the model files now."""
        self._findings = findings
        for _, viewer in self._viewers.values():
            viewer.show_diagnostics(findings)

    def attach_panel(self, running: RunningNode) -> None:
        """Show the sliders of a node, if it has any."""
        for _, viewer in self._viewers.values():
            _attach_panel(viewer, running)

    async def start(self, plan: HostedPlan, graph: Graph, nodes: list[RunningNode]) -> None:
        """Start a viewer, and say where it is.

        Args:
            plan: how.
            graph: what it shows.
            nodes: those that run already.

        Raises:
            LinkwrightError: why it cannot start.
        """
        from linkwright.viewer import Viewer, find_unsaved

        session = self._session
        if plan.viewer_config is not None:
            config, findings = plan.viewer_config(), list[Diagnostic]()
        else:
            config, findings = read_viewer_config(plan.arguments)
        session.log.diagnostics([*findings, *find_unsaved(config)])
        viewer = Viewer(
            graph,
            library=session.descriptions.library,
            finder=session.finder,
            config=config,
            host=session.options.host,
            port=session.options.port,
            title=session.options.title,
            options=plan.node_options(session.descriptions.library),
        )
        await viewer.start()
        self._viewers[plan.process_name] = plan, viewer
        session.log.announce(f"Viewer: {viewer.url}")
        if session.options.open_browser:
            _open_in_browser(viewer.url)
        session.log.say(
            plan.process_name, "started in the launcher's process: the viewer in the browser stands in for RViz"
        )
        viewer.show_diagnostics([*self._findings, *findings])
        for running in nodes:
            _attach_panel(viewer, running)

    def take(self, plan: HostedPlan) -> Viewer:
        """A viewer that is to be ended, which this host then holds no longer."""
        return self._viewers.pop(plan.process_name)[1]

    async def stop(self, plan: HostedPlan, viewer: Viewer) -> None:
        """End a viewer; what was not saved is kept first, before anything can take its time."""
        self._session.log.diagnostics(viewer.keep_unsaved())
        try:
            await asyncio.wait_for(viewer.close(), _CLOSE_SECONDS)
        except asyncio.TimeoutError:
            self._session.log.caution(plan.process_name, "a browser did not let go of its connection in time")


def _attach_panel(viewer: Viewer, running: RunningNode) -> None:
    from linkwright.nodes import NodeWithSliders

    if isinstance(running, NodeWithSliders):
        viewer.attach_joint_panel(running.panel)


def _open_in_browser(url: str) -> None:
    """Open the page; in a thread, because some browsers take their time to answer.

    Not where there is no display: a browser for the terminal would take ours.
    """
    displays = ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")
    if sys.platform.startswith("linux") and not any(os.environ.get(name) for name in displays):
        return
    import webbrowser

    threading.Thread(target=webbrowser.open, args=(url,), name="linkwright-browser", daemon=True).start()


_CONFIG = ("-d", "--display-config")
_FIXED_FRAME = ("-f", "--fixed-frame")
_WITHOUT_MEANING_HERE = {
    "-s": 1,
    "--splash-screen": 1,
    "-l": 0,
    "--ogre-log": 0,
    "--stereo": 0,
    "--fullscreen": 0,
    "--force-x11": 0,
}

USAGE = """\
usage: rviz2 [-d FILE] [-f FRAME] [--ros-args ...]

Shows what RViz would show, in the browser.

  -h, --help                   show this and end
  -d, --display-config FILE    the .rviz file to open
  -f, --fixed-frame FRAME      the Fixed Frame, instead of the file's
  --ros-args ...               names, remappings and parameters of the node

RViz's -s, -l, --stereo, --fullscreen and --force-x11 are taken and have no meaning here.
"""


def asks_for_help(arguments: Sequence[str]) -> bool:
    """Whether the command line asks for `USAGE`."""
    own = list(arguments)
    if "--ros-args" in own:
        own = own[: own.index("--ros-args")]
    return "-h" in own or "--help" in own


def read_viewer_config(arguments: Sequence[str]) -> tuple[RvizConfig, list[Diagnostic]]:
    """The configuration that the arguments ask for, and what is to be said of them.

    As in RViz, a file that cannot be read is told about, and the default configuration takes its place.
    """
    from linkwright.viewer import RvizConfig

    path, fixed_frame, findings = _read(arguments)
    config: RvizConfig | None = None
    if path:
        try:
            config = RvizConfig.load(path)
        except LinkwrightError as error:
            findings += error.diagnostics
    if config is None:
        config = RvizConfig.default()
    if fixed_frame:
        config.options.set(("Fixed Frame",), fixed_frame)
    return config, findings


def _read(arguments: Sequence[str]) -> tuple[str | None, str | None, list[Diagnostic]]:
    path: str | None = None
    fixed_frame: str | None = None
    findings: list[Diagnostic] = []
    waiting = iter(arguments)
    for argument in waiting:
        if argument == "--ros-args":
            for each in waiting:  # names and remappings of a node; the viewer shows what the file says
                if each == "--":
                    break
        elif argument in _CONFIG or argument in _FIXED_FRAME:
            value = next(waiting, None)
            if value is None:
                findings.append(_remark(phrase("argument '{argument}' of rviz2 needs a value", argument=argument)))
            elif argument in _CONFIG:
                path = value
            else:
                fixed_frame = value
        elif argument in _WITHOUT_MEANING_HERE:
            for _ in range(_WITHOUT_MEANING_HERE[argument]):
                next(waiting, None)
        elif argument:
            known = (*_CONFIG, *_FIXED_FRAME, *_WITHOUT_MEANING_HERE)
            findings.append(
                _remark(
                    phrase("argument '{argument}' of rviz2 is unknown", argument=argument),
                    did_you_mean(argument, known),
                )
            )
    return path, fixed_frame, findings


def _remark(message: Phrase, hint: Phrase | None = None) -> Diagnostic:
    return replace(Diagnostic("LAUNCH144", message, hint=hint), severity=Severity.WARNING)
