"""``linkwright learn open``: show a course in the page, with files, robot and terminal."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from linkwright.cli.view import add_viewer_options
from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, phrase
from linkwright.diagnostics.translation import localized


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``learn open``."""
    parser.add_argument(
        "workspace",
        metavar="FOLDER",
        nargs="?",
        type=Path,
        help="your workspace, which is created if it does not exist (default: the folder with a learn.yaml at or above "
        "the current one, else the current folder if it is empty, else COURSE_ws in it)",
    )
    parser.add_argument("--course", metavar="COURSE", help="a shipped course by its name, or the folder of a course")
    add_viewer_options(parser, offers_terminal=False)


def run(arguments: argparse.Namespace) -> int:
    """Show a course until the user interrupts the command."""
    from linkwright.hosting.plans import HostOptions
    from linkwright.learning.classroom import find_workspace, open_classroom
    from linkwright.learning.page.classroom_view import run_classroom

    workspace = (arguments.workspace or find_workspace(Path.cwd(), arguments.course)).absolute()
    classroom = open_classroom(workspace, arguments.course)
    try:
        workspace.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        message = phrase("cannot create '{path}': {error}", path=display_path(workspace), error=error.strerror or error)
        raise LinkwrightError(Diagnostic("LEARN111", message)) from None
    print(localized(phrase("Workspace: {path}", path=display_path(workspace))), file=sys.stderr)
    options = HostOptions(
        arguments.host, arguments.port, not arguments.no_open, network=False, history=arguments.history
    )
    return run_classroom(classroom, options, foxglove=arguments.foxglove)
