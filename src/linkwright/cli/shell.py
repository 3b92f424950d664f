"""``linkwright shell``: a shell with the commands of ROS 2."""

from __future__ import annotations

import argparse
import sys


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``shell``."""
    parser.usage = "linkwright shell [-h] [-- COMMAND ...]"
    parser.add_argument(
        "command",
        metavar="COMMAND",
        nargs=argparse.REMAINDER,
        help="a command to run in the shell instead, with its arguments; its exit status is returned",
    )


def run(arguments: argparse.Namespace) -> int:
    """Run a shell, or a command in a shell, and return its exit status."""
    from linkwright.cli.completion.scripts import startup_script
    from linkwright.shell import run_shell
    from linkwright.shell.instead import HINTS
    from linkwright.shell.session import MARK_VARIABLE

    command = arguments.command
    return run_shell(
        command[1:] if command[:1] == ["--"] else command,
        additions=lambda kind: startup_script(kind, sys.executable, MARK_VARIABLE, list(HINTS)),
    )
