"""Runs a launch from the command line until it ends."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.hosting.last_minutes import DEFAULT_HISTORY
from linkwright.hosting.launch_log import LaunchLog
from linkwright.hosting.signals import SignalWatch, own_environment, run_to_end
from linkwright.hosting.xacro_calls import Descriptions, use_descriptions
from linkwright.launch.arguments import check_arguments, format_arguments
from linkwright.launch.engine.omissions import add_no_skip_note
from linkwright.launch.engine.session import LaunchSession
from linkwright.launch.engine.supervisor import SessionOptions
from linkwright.launch.frontend.launch_file import load_launch_file
from linkwright.launch.model.action import Action
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.target import LaunchTarget
from linkwright.packages import PackageFinder


@dataclass(frozen=True)
class LaunchOptions:
    """The options of a launch.

    Attributes:
        host: the address to which the viewer's server binds.
        port: the port of the viewer's server; None for the default or the next free port.
        open_browser: whether to open the page in the user's browser.
        isolate: whether Linkwright's own nodes run in separate processes.
        debug: whether to log details.
        noninteractive: whether there is no terminal, so that Ctrl-C does not reach the processes directly.
        prefix: a prefix for the command lines of processes.
        prefix_filter: a regular expression for the names of the programs that get the prefix.
        foxglove: the port to which Foxglove and Lichtblick can connect; None to open no port.
        skip_missing: whether to skip parts whose package, program or file is missing.
        command_to_skip_missing: the command that launches with `skip_missing`, for the hint about missing parts.
        network: whether the nodes of this process join the ROS 2 network, so that other programs can discover them.
        history: the memory in bytes for the viewer's history of the last minutes; 0 for no history.
    """

    host: str = "127.0.0.1"
    port: int | None = None
    open_browser: bool = True
    isolate: bool = False
    debug: bool = False
    noninteractive: bool = False
    prefix: str | None = None
    prefix_filter: str | None = None
    foxglove: int | None = None
    skip_missing: bool = False
    command_to_skip_missing: str | None = None
    network: bool = True
    history: int = DEFAULT_HISTORY

    @property
    def configurations(self) -> dict[str, str]:
        """The launch configurations that these options set."""
        given = {"launch-prefix": self.prefix, "launch-prefix-filter": self.prefix_filter}
        return {name: value for name, value in given.items() if value is not None}

    def for_session(self, title: str) -> SessionOptions:
        """Return the options of the launch session."""
        return SessionOptions(
            self.host,
            self.port,
            self.open_browser,
            title,
            isolate=self.isolate,
            skip_missing=self.skip_missing,
            command_to_skip_missing=None if self.skip_missing else self.command_to_skip_missing,
            network=self.network,
            history=self.history,
        )


def run_launch(
    target: LaunchTarget, arguments: Mapping[str, str] | None = None, options: LaunchOptions | None = None
) -> int:
    """Run a launch file until all its processes and nodes have ended or the user ends it.

    The modules that launch files import must be available: see `linkwright.standins.activate`.

    Args:
        target: the launch file.
        arguments: name -> value of the launch arguments.
        options: the options of the launch.

    Returns:
        The exit status: 0, 1 if something in the launch failed, or 128 plus the signal's number after a signal.

    Raises:
        LinkwrightError: the errors in the target, the launch file or the arguments.
    """
    given = dict(arguments or {})
    finder = target.finder()
    options = options or LaunchOptions()

    def load(log: LaunchLog) -> tuple[LaunchDescription, dict[str, Any]]:
        path = target.resolve(finder)
        try:
            description = load_launch_file(path)
        except LinkwrightError as error:
            if options.skip_missing:
                add_no_skip_note(error)
            raise
        log.diagnostics(check_arguments(description, given))
        return description, {
            "current_launch_file_path": str(path),
            "current_launch_file_directory": str(path.parent),
        }

    title = f"{target.package} {target.file}" if target.package else Path(target.file).name
    return run_description(load, given, finder, options, title)


def show_arguments(target: LaunchTarget) -> str:
    """Return the text of ``--show-args`` for a launch file.

    Raises:
        LinkwrightError: the errors in the target or the launch file.
    """
    return _read(target, format_arguments)


def print_description(target: LaunchTarget) -> str:
    """Return the text of ``--print`` for a launch file: the tree of its entities.

    Raises:
        LinkwrightError: the errors in the target or the launch file.
    """
    from linkwright.launch.model.introspector import format_launch_description

    return _read(target, format_launch_description)


def _read(target: LaunchTarget, describe: Callable[[LaunchDescription], str]) -> str:
    """Read a launch file without launching it, and return a text about its description.

    The function `describe` returns the text.
    """
    finder = target.finder()
    with own_environment(finder):
        return describe(load_launch_file(target.resolve(finder)))


def run_description(
    load: Callable[[LaunchLog], tuple[LaunchDescription, dict[str, Any]]],
    configurations: Mapping[str, str],
    finder: PackageFinder,
    options: LaunchOptions,
    title: str,
) -> int:
    """Run a launch description until the launch ends.

    Args:
        load: returns the description and the initial locals of the context.
        configurations: name -> value of the launch configurations.
        finder: the package finder.
        options: the options of the launch.
        title: the title of the launch.

    Returns:
        The exit status, see `run_launch`.

    Raises:
        LinkwrightError: the error of `load`.
    """
    log = LaunchLog(debug=options.debug)

    def run(signals: SignalWatch) -> bool:
        with use_descriptions(Descriptions(finder)):
            description, values = load(log)
            if options.foxglove is not None:
                description.add_action(_foxglove_bridge_action(options.foxglove))
            session = partial(LaunchSession, finder, options.for_session(title), log)
            given = {**options.configurations, **configurations}
            quiet = options.noninteractive
            return signals.run(lambda: _run(description, values, given, session, signals, noninteractive=quiet))

    return run_to_end(run, finder, log)


async def _run(
    description: LaunchDescription,
    values: dict[str, Any],
    configurations: Mapping[str, str],
    make_session: Callable[[LaunchContext], LaunchSession],
    signals: SignalWatch,
    *,
    noninteractive: bool,
) -> bool:
    argv = [f"{name}:={value}" for name, value in configurations.items()]
    session = make_session(LaunchContext(argv=argv, noninteractive=noninteractive))
    session.context.launch_configurations.update(configurations)
    signals.session = session
    return await session.run(description, values)


def _foxglove_bridge_action(port: int) -> Action:
    """Return the action that starts the node to which Foxglove and Lichtblick connect."""
    from linkwright.launch.ros import Node

    package = executable = "foxglove_bridge"
    return Node(package=package, executable=executable, parameters=[{"port": port}])
