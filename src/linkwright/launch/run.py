"""Runs a launch from the command line until it ends."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.hosting.history_size import DEFAULT_HISTORY
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
    """The options of a launch from the command line.

    Attributes:
        host: the address on which the server of the viewer listens.
        port: the port of the server; None for the default port, or the next one that is free.
        open_browser: whether to open the page in the user's browser.
        isolate: whether Linkwright's own nodes run in separate processes.
        debug: whether to log details.
        noninteractive: whether there is no terminal, so that Ctrl-C does not reach the processes directly.
        prefix: a command to insert before the command lines of processes; None for no prefix.
        prefix_filter: a regular expression for the names of the programs that get the prefix; None for all programs.
        foxglove: the port to which Foxglove and Lichtblick can connect; None to open no port.
        skip_missing: whether to skip the parts of the launch whose package, program or file is missing.
        command_to_skip_missing: the command that repeats the launch with `skip_missing`, for a hint; None for no hint.
        network: whether the nodes of the launcher's process join the ROS 2 network, where other programs discover
            them.
        history: the memory in bytes for the last minutes in the viewer; 0 to store none.
        terminal: the folder in which pages of this machine can run shells; None to let no page run one.
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
    terminal: Path | None = None

    @property
    def configurations(self) -> dict[str, str]:
        """The launch configurations that these options set."""
        values = {"launch-prefix": self.prefix, "launch-prefix-filter": self.prefix_filter}
        return {name: value for name, value in values.items() if value is not None}

    def for_session(self, title: str) -> SessionOptions:
        """Return the corresponding options of the launch session, with the title of the launch."""
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
            terminal=self.terminal,
        )


def run_launch(
    target: LaunchTarget, arguments: Mapping[str, str] | None = None, options: LaunchOptions | None = None
) -> int:
    """Run a launch file until all its processes and nodes have ended or the user ends it.

    The modules that launch files import must be available, see `linkwright.standins.activate`.

    Args:
        target: the launch file.
        arguments: maps the names of launch arguments to their values; None for no arguments.
        options: the options of the launch; None for the defaults.

    Returns:
        The exit status: 0 if the launch succeeded, 1 if something failed, or 128 plus the number of a received signal.

    Raises:
        LinkwrightError: the target, the launch file or the arguments have errors.
    """
    argument_values = dict(arguments or {})
    finder = target.create_finder()
    options = options or LaunchOptions()

    def load(log: LaunchLog) -> tuple[LaunchDescription, dict[str, Any]]:
        path = target.resolve(finder)
        try:
            description = load_launch_file(path)
        except LinkwrightError as error:
            if options.skip_missing:
                add_no_skip_note(error)
            raise
        log.write_diagnostics(check_arguments(description, argument_values))
        return description, {
            "current_launch_file_path": str(path),
            "current_launch_file_directory": str(path.parent),
        }

    title = f"{target.package} {target.file}" if target.package else Path(target.file).name
    return run_description(load, argument_values, finder, options, title)


def show_arguments(target: LaunchTarget) -> str:
    """Return the text that ``--show-args`` prints for a launch file.

    Raises:
        LinkwrightError: the errors in the target or the launch file.
    """
    return _describe_target(target, format_arguments)


def print_description(target: LaunchTarget) -> str:
    """Return the tree of entities that ``--print`` prints for a launch file.

    Raises:
        LinkwrightError: the errors in the target or the launch file.
    """
    from linkwright.launch.model.introspector import format_launch_description

    return _describe_target(target, format_launch_description)


def _describe_target(target: LaunchTarget, describe: Callable[[LaunchDescription], str]) -> str:
    """Read a launch file, and return the text that `describe` returns for it.

    The file is not launched.
    """
    finder = target.create_finder()
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
        load: returns the launch description, and the initial locals of the launch context.
        configurations: maps the names of launch configurations to their values.
        finder: the finder of ROS packages.
        options: the options of the launch.
        title: the title of the launch in the viewer.

    Returns:
        The exit status, see `run_launch`.

    Raises:
        LinkwrightError: `load` raised the error.
    """
    log = LaunchLog(debug=options.debug)

    def run(signals: SignalWatch) -> bool:
        with use_descriptions(Descriptions(finder)):
            description, initial_locals = load(log)
            if options.foxglove is not None:
                description.add_action(_create_foxglove_bridge_action(options.foxglove))
            session = partial(LaunchSession, finder, options.for_session(title), log)
            all_configurations = {**options.configurations, **configurations}
            quiet = options.noninteractive
            return signals.run(
                lambda: _run(description, initial_locals, all_configurations, session, signals, noninteractive=quiet)
            )

    return run_to_end(run, finder, log)


async def _run(
    description: LaunchDescription,
    initial_locals: dict[str, Any],
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
    return await session.run(description, initial_locals)


def _create_foxglove_bridge_action(port: int) -> Action:
    """Return the action that starts the node for connections from Foxglove and Lichtblick."""
    from linkwright.launch.ros import Node

    package = executable = "foxglove_bridge"
    return Node(package=package, executable=executable, parameters=[{"port": port}])
