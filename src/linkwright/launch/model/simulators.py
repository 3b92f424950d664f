"""Programs of Gazebo that launch files start as processes, and that are nodes here."""

from __future__ import annotations

import shutil
from collections.abc import Mapping, Sequence
from pathlib import PurePath
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.nodes.gazebo.command_line import SimulatorCommand

PROGRAMS = frozenset({"gazebo", "gzserver", "gzclient", "gz", "ign"})
"""The programs of Gazebo; most commands are none of these, and are told from them without further ado."""
_RUBY = "ruby"
"""What the commands of gz are written in, and some launch files run them with."""


def simulator_of(words: Sequence[str], environment: Mapping[str, str]) -> SimulatorCommand | None:
    """The node that stands in for a command; None where it is none of Gazebo's, or that is installed.

    Args:
        words: of the command line.
        environment: in which ``PATH`` is looked through.
    """
    if words and PurePath(words[0]).name == _RUBY:
        words = words[1:]
    if not words or PurePath(words[0]).name not in PROGRAMS or shutil.which(words[0], path=environment.get("PATH")):
        return None
    from linkwright.nodes.gazebo.command_line import simulator_command

    return simulator_command(words)
