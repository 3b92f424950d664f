"""The small programs that Linkwright writes for launch files and shells, such as ``ros2`` and ``gz``."""

from __future__ import annotations

from pathlib import Path

PROGRAMS_MODULE = "linkwright.cli.tools"
"""The module that runs the programs; each program's file names it."""

_MAX_SIZE = 4096


def is_own_program(path: Path) -> bool:
    """Return whether Linkwright wrote a program, in contrast to an installed program of the same name."""
    try:
        with path.open("rb") as file:
            return PROGRAMS_MODULE.encode() in file.read(_MAX_SIZE)
    except OSError:
        return False
