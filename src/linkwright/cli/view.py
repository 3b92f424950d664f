"""``linkwright view``: show a model with joint sliders in the browser, or compare two."""

from __future__ import annotations

import argparse
import re
import sys
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.model_arguments import add_second_model, names_file, open_requested_pair
from linkwright.hosting.history_size import DEFAULT_HISTORY
from linkwright.process.assignments import parse_assignments

if TYPE_CHECKING:
    from linkwright.hosting.plans import HostOptions


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``view``."""
    parser.add_argument(
        "file",
        metavar="FILE",
        help="the URDF or xacro file, or a recording: its .mcap or .db3 files, or its folder",
    )
    add_second_model(parser)
    parser.add_argument(
        "-d", "--display-config", metavar="RVIZ", help="the .rviz file to open instead of the default displays"
    )
    parser.add_argument(
        "--join",
        action="store_true",
        help="join the ROS 2 network (ROS_DOMAIN_ID), so that other programs see the nodes",
    )
    parser.add_argument(
        "--editor",
        action="store_true",
        help="follow a text editor, which sends its texts to standard input; for the language server",
    )
    add_viewer_options(parser)


def add_viewer_options(parser: argparse.ArgumentParser, *, offers_terminal: bool = True) -> None:
    """Declare the options of the page, which several commands share.

    Args:
        parser: the command's parser.
        offers_terminal: whether to declare --terminal; False for commands that always have a terminal.
    """
    group = parser.add_argument_group(title="page in the browser")
    group.add_argument("--no-open", action="store_true", help="do not open the page in the browser")
    group.add_argument("--host", default="127.0.0.1", help="address to serve the page at (default: %(default)s)")
    group.add_argument(
        "--port", type=parse_port, help="port to serve the page at (default: 7448, or the next free one)"
    )
    group.add_argument(
        "--foxglove",
        metavar="PORT",
        type=parse_port,
        help="let Foxglove and Lichtblick connect to this port of this machine",
    )
    group.add_argument(
        "--history",
        metavar="SIZE",
        type=parse_size,
        default=DEFAULT_HISTORY,
        help="memory for the messages of the last minutes, which the page can replay, such as 1GB; 0 "
        "disables replay (default: 256MB)",
    )
    parser.set_defaults(needs_terminal=not offers_terminal)
    if offers_terminal:
        group.add_argument(
            "--terminal",
            action="store_true",
            help="let pages of this machine run your shell, in the panel Terminal; shells start in the current folder",
        )


def find_terminal_folder(arguments: argparse.Namespace) -> Path | None:
    """Return the folder for terminals in the page, or None if the page has none."""
    return Path.cwd() if arguments.terminal else None


_BYTES_BY_UNIT = {"": 1, "B": 1, "KB": 10**3, "MB": 10**6, "GB": 10**9}


def parse_size(text: str) -> int:
    """Parse a size such as ``256MB``, and return the number of bytes.

    Raises:
        argparse.ArgumentTypeError: the text is not a size.
    """
    match = re.fullmatch(r"([0-9]{1,9}(?:\.[0-9]{1,3})?) ?([KMG]?B)?", text, re.ASCII | re.IGNORECASE)
    if match is None:
        raise argparse.ArgumentTypeError(f"'{text}' is not a size; give one such as 256MB, or 0")
    return round(float(match[1]) * _BYTES_BY_UNIT[(match[2] or "").upper()])


def parse_port(text: str) -> int:
    """Parse a TCP port.

    Raises:
        argparse.ArgumentTypeError: the text is not a TCP port.
    """
    if text.isascii() and text.isdigit() and 0 < int(text) < 65536:
        return int(text)
    raise argparse.ArgumentTypeError(f"'{text}' is not a port; give a number from 1 to 65535")


def run(arguments: argparse.Namespace) -> int:
    """Show a model, or the differences of two models, until the user interrupts the command."""
    from linkwright.bag import is_recording
    from linkwright.hosting.plans import HostOptions

    rviz = None if arguments.display_config is None else _check_config(Path(arguments.display_config))
    options = HostOptions(
        arguments.host,
        arguments.port,
        not arguments.no_open,
        network=arguments.join,
        history=arguments.history,
        rviz=rviz,
        follows_editor=arguments.editor,
        terminal=find_terminal_folder(arguments),
    )
    if is_recording(Path(arguments.file)):
        return _view_recordings(arguments, options)
    bag = next((word for word in arguments.words if names_file(word) and is_recording(Path(word))), None)
    if bag is not None:
        return _report_misuse(f"'{bag}' is a recording, so show it without other files: linkwright view {bag}")
    if arguments.against or any(map(names_file, arguments.words)):
        if rviz is not None:
            return _report_misuse("omit -d: a comparison of two descriptions has its own displays")
        return _view_comparison(arguments, options)
    values = parse_assignments(arguments.words)
    from linkwright.hosting.view import run_view

    return run_view(arguments.file, values, options, foxglove=arguments.foxglove)


def _view_recordings(arguments: argparse.Namespace, options: HostOptions) -> int:
    from linkwright.bag import is_recording
    from linkwright.hosting.bag_view import run_bag_view

    files = [Path(arguments.file)]
    files += [Path(word) for word in arguments.words if names_file(word) and is_recording(Path(word))]
    other_arguments = [word for word in arguments.words if Path(word) not in files[1:]]
    extra_arguments = [*other_arguments, *([f"--against {arguments.against}"] if arguments.against else [])]
    if extra_arguments:
        return _report_misuse(
            f"'{arguments.file}' is a recording, so show it by itself: omit {', '.join(extra_arguments)}"
        )
    folder = next((file for file in files if len(files) > 1 and file.is_dir()), None)
    if folder is not None:
        return _report_misuse(f"several files are shown as one recording, and '{folder}' is a folder: name its files")
    return run_bag_view(files, options, foxglove=arguments.foxglove)


def _check_config(rviz: Path) -> Path:
    """Return the absolute path of a .rviz file after checking that it can be read.

    Raises:
        LinkwrightError: the file cannot be read; see `linkwright.rviz.RvizConfig.load`.
    """
    from linkwright.rviz import RvizConfig

    RvizConfig.load(rviz)
    return rviz.absolute()


def _report_misuse(message: str) -> int:
    print(f"linkwright view: {message}", file=sys.stderr)
    return 2


def _view_comparison(arguments: argparse.Namespace, options: HostOptions) -> int:
    from linkwright.hosting.compared import run_compared_view

    with ExitStack() as stack:
        pair = open_requested_pair(arguments, stack)
        if pair is None:
            return _report_misuse("pass one file, two to compare, or one and --against COMMIT")
        return run_compared_view(pair, options, foxglove=arguments.foxglove)
