"""Nodes that replace programs of other packages, as started from a command line.

Entry points of the group ``linkwright.replaced_programs`` provide them: each has the name of a program, as found in
``PATH``, and points to a `CommandParser`. A launch file that starts such a program starts the node instead if the
program is not installed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class NodeCommand:
    """A node that replaces a program of a command line.

    Attributes:
        package: the node's package.
        executable: the node's executable in that package.
        parameters: the parameters of the node.
        ros_arguments: further arguments, which begin with ``--ros-args``.
    """

    package: str
    executable: str
    parameters: Mapping[str, Any] = field(default_factory=dict)
    ros_arguments: Sequence[str] = ()


CommandParser = Callable[[Sequence[str]], NodeCommand | None]
"""Returns the node for the words of a command line, program first; None if it does not replace that command."""
