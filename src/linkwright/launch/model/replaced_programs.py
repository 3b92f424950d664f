"""Programs that are replaced by Linkwright's nodes if they are not installed.

Launch files start such programs as processes. The replacements are entry points in the group
``linkwright.replaced_programs`` with the names of the programs. Each entry point refers to a `CommandParser`.
"""

from __future__ import annotations

import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path, PurePath
from typing import TYPE_CHECKING

from linkwright.diagnostics import phrase
from linkwright.diagnostics.extension_errors import load_extension
from linkwright.loading.extensions import EntryPoint, extensions
from linkwright.process.own_programs import is_own_program

if TYPE_CHECKING:
    from linkwright.nodes.node_command import CommandParser, NodeCommand

_INTERPRETERS = ("ruby",)
"""Interpreters that may precede a program in a command, because the program is a script."""


def load_replaced_programs() -> Mapping[str, EntryPoint]:
    """Return the entry points of command-line parsers by the name of the replaced program."""
    return extensions("linkwright.replaced_programs")


def find_replacing_node(words: Sequence[str], environment: Mapping[str, str]) -> NodeCommand | None:
    """Return the node that replaces the program of a command.

    Args:
        words: the program and its arguments.
        environment: the environment variables; programs are searched for on their ``PATH``.

    Returns:
        The node, or None if the program is installed or has no replacement.

    Raises:
        LinkwrightError: NODE002, the package that provides the node cannot be imported.
    """
    if words and PurePath(words[0]).name in _INTERPRETERS:
        words = words[1:]
    entry_point = load_replaced_programs().get(PurePath(words[0]).name) if words else None
    if entry_point is None or _is_installed(words[0], environment):
        return None
    message = phrase("the node that replaces '{program}' cannot be imported", program=entry_point.name)
    parse_command: CommandParser = load_extension(entry_point, "NODE002", message)
    return parse_command(words)


def _is_installed(program: str, environment: Mapping[str, str]) -> bool:
    """Return whether a program is installed; Linkwright's own program of this name does not count."""
    path = shutil.which(program, path=environment.get("PATH"))
    return path is not None and not is_own_program(Path(path))
