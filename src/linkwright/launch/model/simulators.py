"""Programs of Gazebo that launch files start as processes, which nodes of Linkwright replace."""

from __future__ import annotations

import shutil
from collections.abc import Mapping, Sequence
from pathlib import PurePath
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.simulation.nodes.command_line import SimulatorCommand

PROGRAMS = frozenset({"gazebo", "gzserver", "gzclient", "gz", "ign"})
"""The programs of Gazebo, for a quick check that excludes most commands."""
_RUBY = "ruby"
"""The interpreter of the gz commands, with which some launch files run them."""


def simulator_of(words: Sequence[str], environment: Mapping[str, str]) -> SimulatorCommand | None:
    """Return the node that replaces a command; None if it is not Gazebo's, or Gazebo is installed.

    Args:
        words: the words of the command line.
        environment: the environment whose ``PATH`` is searched.
    """
    if words and PurePath(words[0]).name == _RUBY:
        words = words[1:]
    if not words or PurePath(words[0]).name not in PROGRAMS or shutil.which(words[0], path=environment.get("PATH")):
        return None
    from linkwright.simulation.nodes.command_line import simulator_command

    return simulator_command(words)
