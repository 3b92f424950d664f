"""Nodes that replace programs of other packages on a command line.

The entry points of the group ``linkwright.replaced_programs`` declare such nodes. Each entry point has the name of a
program in ``PATH``, and refers to a `CommandParser`. If a launch file starts the program and the program is not
installed, the node is started instead.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class NodeCommand:
    """A node that replaces a program on a command line.

    Attributes:
        package: the package of the node.
        executable: the node's executable in that package.
        parameters: the parameters of the node.
        ros_arguments: additional arguments, which begin with ``--ros-args``.
    """

    package: str
    executable: str
    parameters: Mapping[str, Any] = field(default_factory=dict)
    ros_arguments: Sequence[str] = ()


CommandParser = Callable[[Sequence[str]], NodeCommand | None]
"""A function that returns the node that replaces a program, given its command line.

The command line starts with the program. The result is None if the node does not replace it.
"""
