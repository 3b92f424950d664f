"""Reading the description that a command is given."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from linkwright.cli.assignments import parse_assignments
from linkwright.diagnostics import Diagnostic

if TYPE_CHECKING:
    from linkwright.urdf import Robot


def read_description(path: str, words: Sequence[str]) -> tuple[Robot | None, tuple[Diagnostic, ...]]:
    """Expand and read a URDF or xacro file with ``name:=value`` words; all findings, and the robot if there is one.

    Raises:
        LinkwrightError: when it cannot be expanded.
    """
    from linkwright.urdf import read
    from linkwright.xacro import expand

    expansion = expand(path, parse_assignments(words))
    reading = read(expansion.document)
    return reading.robot, (*expansion.diagnostics, *reading.diagnostics)
